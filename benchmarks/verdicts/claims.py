"""Which causes an assembly blames, read from its warnings and notes; and when two blame others.

Two assemblies contradict each other if both blame causes, and have none in common. A warning that
appears in only one of them is no contradiction.
"""

from hdrlab.pipeline.assembly import Assembly

# What a sentence says -> the cause that it blames. A sentence may blame several.
PHRASES = {
    "could not be aligned": "alignment",
    "are probably misaligned": "alignment",
    "may be misaligned": "alignment",
    "has a different white balance": "white_balance",
    "the corners get brighter or darker": "corners",
    "vignetting changed with the aperture": "corners",
    "lamps flicker": "flicker",
    "stops in parts of the image, most between": "local",
    "the light changed in parts of the image": "local",
    "the photos contradict their exposure times": "times",
    "exposure times are wrong": "times",
    "the photos contradict the estimated times": "times",
    "one of the three exposure times is wrong": "times",
    "the estimated times differ from the stated ones": "times",
    "the stated times contradict the pixels": "times",
    "the longer exposure is the darker photo": "times",
    "because the other photos contradict it": "times",
    "it alone shows the highlights": "times",
    "something moved": "moved",
    "probably because leaves, water or people moved": "moved",
    "of the image moved": "moved",
    "neither wrong times nor a change": "unexplained",
    "the camera changed its processing, and": "unexplained",
}


def blamed_causes(assembly: Assembly) -> frozenset[str]:
    """Return the causes that the warnings and notes of an assembly name."""
    sentences = (*assembly.warnings, *assembly.notes)
    return frozenset(
        cause for sentence in sentences for phrase, cause in PHRASES.items() if phrase in sentence
    )


def contradict(first: frozenset[str], second: frozenset[str]) -> bool:
    """Return whether both blame causes, and have none in common."""
    return bool(first) and bool(second) and not first & second
