"""A reading of 0 counts as the smallest number, so the answer stays finite."""

import math
import sys


def optimum(EV_pre, B_pre, B_opt=0.18):
    def stops(b):
        m, e = math.frexp(max(b, sys.float_info.min))
        return e + math.log2(m)

    return EV_pre + stops(B_pre) - stops(B_opt)
