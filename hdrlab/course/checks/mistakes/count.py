"""Known mistakes in `count`, the task of hdrlab.capture.planning.count."""

import math

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "count_first_forgotten",
    says="The first photograph holds its whole usable range; only what is beyond that is "
    "divided by the step.",
)
def first_forgotten(scene, usable, overlap):
    return max(math.ceil(scene / (usable - overlap)), 1)


@mistake(
    "count_overlap_forgotten",
    says="Each further photograph adds only what it does not share with its neighbour: usable "
    "less overlap.",
)
def overlap_forgotten(scene, usable, overlap):
    return max(1 + math.ceil((scene - usable) / usable), 1)


@mistake(
    "count_rounded_down",
    says="What is left after the last whole step needs a photograph too: round up, not down.",
)
def rounded_down(scene, usable, overlap):
    return max(1 + math.floor((scene - usable) / (usable - overlap)), 1)
