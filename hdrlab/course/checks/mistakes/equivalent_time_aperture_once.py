"""Twice the f-number is a quarter of the light, not a half: the ratio of the f-numbers is squared."""


def equivalent_time(T, F, F_new, *, S=100, S_new=100):
    return T * F_new / F * S / S_new
