"""Natural logarithms over ln 2."""

import math


def optimum(EV_pre, B_pre, B_opt=0.18):
    return EV_pre + (math.log(B_pre) - math.log(B_opt)) / math.log(2)
