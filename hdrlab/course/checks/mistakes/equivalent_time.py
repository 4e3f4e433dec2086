"""Known mistakes in `equivalent_time`, the task of hdrlab.capture.exposure.equivalent_time."""

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "equivalent_time_aperture_once",
    says="Twice the f-number lets in a quarter of the light, not a half: square the ratio of "
    "the f-numbers.",
)
def aperture_once(T, F, F_new, *, S=100, S_new=100):
    return T * F_new / F * S / S_new


@mistake(
    "equivalent_time_inverted",
    says="A larger f-number lets in less light, so the time must be longer. Your ratio is "
    "inverted.",
)
def inverted(T, F, F_new, *, S=100, S_new=100):
    return T * (F / F_new) ** 2 * S / S_new


@mistake(
    "equivalent_time_speed_inverted",
    says="A higher ISO speed needs a shorter time: multiply by the old speed divided by the "
    "new one.",
)
def speed_inverted(T, F, F_new, *, S=100, S_new=100):
    return T * (F_new / F) ** 2 * S_new / S
