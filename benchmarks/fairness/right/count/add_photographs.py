"""Adds photographs until the scene is covered; one that would add nothing is a ValueError."""


def count(scene, usable, overlap):
    step = usable - overlap
    if step <= 0:
        raise ValueError("neighbours share all that a photograph holds")
    n = 1
    while usable + (n - 1) * step < scene:
        n += 1
    return n
