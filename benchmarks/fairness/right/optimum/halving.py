"""Stop by stop, and then by halves of a stop, until the reading is right."""


def optimum(EV_pre, B_pre, B_opt=0.18):
    EV, step = EV_pre, 16.0
    while step > 1e-7:
        while B_pre * 2.0 ** (EV_pre - (EV + step)) >= B_opt:
            EV += step
        while B_pre * 2.0 ** (EV_pre - EV) < B_opt:
            EV -= step
        step /= 2
    return EV
