"""The ceiling as the negative of a floor division; one photograph is enough is answered first."""


def count(scene, usable, overlap):
    if scene <= usable:
        return 1
    missing, gain = scene - usable, usable - overlap
    return int(1 - (-missing // gain))
