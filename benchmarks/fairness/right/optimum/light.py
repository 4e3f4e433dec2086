"""By the light: the settings let 2^-EV through, and that is changed by the quotient."""

from math import log


def optimum(EV_pre, B_pre, B_opt=0.18):
    light = 2.0**-EV_pre * B_opt / B_pre
    return -log(light, 2)
