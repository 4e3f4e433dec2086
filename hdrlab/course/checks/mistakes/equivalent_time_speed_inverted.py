"""A higher speed needs a shorter time: multiply by the old speed over the new one."""


def equivalent_time(T, F, F_new, *, S=100, S_new=100):
    return T * (F_new / F) ** 2 * S_new / S
