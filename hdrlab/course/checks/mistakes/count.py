"""Known mistakes in `count`, the task of hdrlab.capture.planning.count."""

import math

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "count_first_forgotten",
    says="The first photo covers its whole usable range. Divide only the rest by the step.",
)
def first_forgotten(scene, usable, overlap):
    return max(math.ceil(scene / (usable - overlap)), 1)


@mistake(
    "count_overlap_forgotten",
    says="Each further photo covers only usable - overlap new stops. You forgot to subtract the "
    "overlap.",
)
def overlap_forgotten(scene, usable, overlap):
    return max(1 + math.ceil((scene - usable) / usable), 1)


@mistake(
    "count_rounded_down",
    says="The stops after the last whole step need a photo, too. Round up, not down.",
)
def rounded_down(scene, usable, overlap):
    return max(1 + math.floor((scene - usable) / (usable - overlap)), 1)
