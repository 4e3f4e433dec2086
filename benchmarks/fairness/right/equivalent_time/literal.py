"""The formula as it stands, without any conversion or check."""


def equivalent_time(T, F, F_new, *, S=100, S_new=100):
    return T * (F_new / F) ** 2 * S / S_new
