"""How many photographs a scene takes: count(scene, usable, overlap) -> n, all in stops."""

import math

from hdrlab.course.checks.compare import points, require, same


def drawn(rng):
    """Return scene, usable, overlap: stops."""
    usable = float(rng.uniform(5, 9))
    return float(rng.uniform(12, 24)), usable, float(rng.uniform(1, usable - 1))


def test_a_scene_of_a_stop_takes_one_photograph(subject, rng):
    """How many photographs can there be at least?

    Return a whole number.

    One photograph holds the stop.
    """
    _, usable, overlap = drawn(rng)
    same(subject.count(0.4, usable, overlap), 1, 0, what="photographs for 0.4 stops")


@points(3, needs="test_the_photographs_hold_the_whole_scene_and_none_is_one_too_many")
def test_a_scene_that_one_photograph_holds_takes_one(subject, rng):
    """What does one photograph hold, if the scene has no more stops than that?

    The formula goes below 1 for a scene of few stops.

    At least one photograph: max(1, ...).
    """
    _, usable, overlap = drawn(rng)
    for scene in (0.5, usable / 2, usable - 0.01):
        same(subject.count(scene, usable, overlap), 1, 0, what=f"photographs for {scene:.2f} stops")


@points(4)
def test_the_photographs_hold_the_whole_scene_and_none_is_one_too_many(subject, rng):
    """Lay the photographs' ranges along the scene's: how far does each next one reach beyond the last?

    Each next one adds usable - overlap stops.

    n = 1 + ceil((scene - usable) / (usable - overlap)).
    """
    scenes = [drawn(rng) for _ in range(8)]
    found = [
        subject.count(*one) for one in scenes
    ]  # all of them: a mistake is known by what it answers
    for (scene, usable, overlap), n in zip(scenes, map(float, found), strict=True):
        reach = usable + (n - 1) * (usable - overlap)
        said = f"{n:g} photographs reach over {reach:.1f} stops, and the scene has {scene:.1f}"
        require(reach >= scene - 1e-6, said)
        said = f"expected one less: {n - 1:g} photographs hold the {scene:.1f} stops too"
        require(reach - (usable - overlap) < scene, said)


@points(3)
def test_more_overlap_takes_more_photographs(subject, rng):
    """Neighbours share the overlap, or nothing ties them together.

    More overlap takes more photographs.

    The step is what a photograph holds less the overlap.
    """
    scene, usable = float(rng.uniform(16, 24)), 7.0
    for overlap in (1.0, 3.0, 5.0, 6.0):
        expected = 1 + math.ceil((scene - usable) / (usable - overlap))
        what = f"photographs at {overlap:g} stops of overlap"
        same(subject.count(scene, usable, overlap), expected, 0, what=what)
