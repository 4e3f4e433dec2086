"""Known mistakes in `equivalent_time`, the task of hdrlab.capture.exposure.equivalent_time."""

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "equivalent_time_aperture_once",
    says="Twice the f-number is a quarter of the light, not a half: the ratio of the f-numbers "
    "is squared.",
)
def aperture_once(T, F, F_new, *, S=100, S_new=100):
    return T * F_new / F * S / S_new


@mistake(
    "equivalent_time_inverted",
    says="A larger f-number lets less light through, so the time must become longer: your "
    "ratio is upside down.",
)
def inverted(T, F, F_new, *, S=100, S_new=100):
    return T * (F / F_new) ** 2 * S / S_new


@mistake(
    "equivalent_time_speed_inverted",
    says="A higher speed needs a shorter time: multiply by the old speed over the new one.",
)
def speed_inverted(T, F, F_new, *, S=100, S_new=100):
    return T * (F_new / F) ** 2 * S_new / S
