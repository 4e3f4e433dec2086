"""The logarithm of the quotient, by math."""

import math


def optimum(EV_pre, B_pre, B_opt=0.18):
    return EV_pre - math.log2(B_opt / B_pre)
