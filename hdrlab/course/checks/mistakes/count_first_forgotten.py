"""The first photograph holds its whole usable range; only what is beyond that is divided by the step."""

import math


def count(scene, usable, overlap):
    return max(math.ceil(scene / (usable - overlap)), 1)
