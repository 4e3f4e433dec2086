"""math.log2 of the quotient."""

import math


def optimum(EV_pre, B_pre, B_opt=0.18):
    return EV_pre + math.log2(B_pre / B_opt)
