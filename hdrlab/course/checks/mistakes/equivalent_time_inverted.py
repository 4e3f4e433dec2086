"""A larger f-number lets less light through, so the time must become longer: your ratio is upside down."""


def equivalent_time(T, F, F_new, *, S=100, S_new=100):
    return T * (F / F_new) ** 2 * S / S_new
