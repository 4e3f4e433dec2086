"""Checks of count(scene, usable, overlap), the number of photos that a scene needs: n; all
arguments in stops.
"""

import math

from hdrlab.course.checks.compare import points, require, same


def draw_inputs(rng):
    """Return scene, usable and overlap in stops."""
    usable = float(rng.uniform(5, 9))
    return float(rng.uniform(12, 24)), usable, float(rng.uniform(1, usable - 1))


def test_a_scene_of_less_than_one_stop_needs_one_photo(subject, rng):
    """What is the smallest possible number of photos?

    Return a whole number.

    One photo covers this scene.
    """
    _, usable, overlap = draw_inputs(rng)
    same(subject.count(0.4, usable, overlap), 1, 0, what="the number of photos for 0.4 stops")


@points(3, needs="test_the_photos_cover_the_whole_scene_without_one_to_spare")
def test_a_scene_that_one_photo_covers_needs_one(subject, rng):
    """How many photos do you need if the scene has no more stops than one photo covers?

    For a scene with few stops, the formula gives less than 1.

    Return at least one photo: max(1, ...).
    """
    _, usable, overlap = draw_inputs(rng)
    for scene in (0.5, usable / 2, usable - 0.01):
        same(
            subject.count(scene, usable, overlap),
            1,
            0,
            what=f"the number of photos for {scene:.2f} stops",
        )


@points(4)
def test_the_photos_cover_the_whole_scene_without_one_to_spare(subject, rng):
    """Draw the ranges of the photos along the range of the scene. How far does each photo reach
    beyond the one before it?

    The first photo covers usable stops, and each further one adds usable - overlap stops.

    n = 1 + ceil((scene - usable) / (usable - overlap)).
    """
    scenes = [draw_inputs(rng) for _ in range(8)]
    # call all of them first: a known mistake is recognized by its answers
    counts = [float(subject.count(*inputs)) for inputs in scenes]
    for (scene, usable, overlap), n in zip(scenes, counts, strict=True):
        reach = usable + (n - 1) * (usable - overlap)
        message = f"{n:g} photos cover {reach:.1f} stops, but the scene has {scene:.1f}: take more"
        require(reach >= scene - 1e-6, message)
        message = f"{n:g} photos are one too many: {n - 1:g} also cover the {scene:.1f} stops"
        require(reach - (usable - overlap) < scene, message)


@points(3)
def test_more_overlap_needs_more_photos(subject, rng):
    """Neighboring photos share the overlap. Without it, nothing connects them.

    More overlap needs more photos.

    The step from one photo to the next is usable - overlap.
    """
    scene = float(rng.uniform(16, 24))
    usable = 7.0
    for overlap in (1.0, 3.0, 5.0, 6.0):
        expected = 1 + math.ceil((scene - usable) / (usable - overlap))
        what = f"the number of photos at {overlap:g} stops of overlap"
        same(subject.count(scene, usable, overlap), expected, 0, what=what)
