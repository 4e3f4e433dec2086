"""Photograph by photograph."""


def count(scene, usable, overlap):
    n, reach = 1, usable
    while reach < scene:
        n, reach = n + 1, reach + usable - overlap
    return n
