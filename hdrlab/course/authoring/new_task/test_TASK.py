"""Flat-field correction: TASK(Z, flat) -> corrected (H, W)."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same


def scene_and_vignetting(rng):
    """Return a scene (H, W), and the fraction of the light that each pixel gets: less in the corners."""
    H = int(rng.integers(20, 30))
    W = int(rng.integers(30, 40))
    y, x = np.mgrid[-1 : 1 : H * 1j, -1 : 1 : W * 1j]
    scene = rng.uniform(10, 200, (H, W))
    return scene, 1 - rng.uniform(0.2, 0.4) * (y**2 + x**2) / 2


@points(5)
def test_a_vignetted_scene_becomes_the_scene(subject, rng):
    """A pixel in a corner gets less light from the scene, and less from the wall. By which factor?

    The wall is uniform, so all differences in its photo come from the camera.

    Divide by flat, pixel by pixel.
    """
    scene, fraction = scene_and_vignetting(rng)
    corrected = subject.TASK(scene * fraction, 150 * fraction)
    corrected = finite(corrected, scene.shape, what="corrected")
    same(
        corrected / corrected.mean(),
        scene / scene.mean(),
        1e-3,
        what="corrected, divided by its mean",
        picture=True,
    )


@points(4)
def test_the_wall_keeps_its_mean(subject, rng):
    """Correct the photo of the wall with itself. What should the result look like?

    It should be uniform. Which pixel value should it have?

    Multiply by the mean of flat, so that the pixel values keep their scale.
    """
    _, fraction = scene_and_vignetting(rng)
    wall = rng.uniform(100, 200) * fraction
    corrected = subject.TASK(wall, wall)
    same(corrected, np.full(wall.shape, wall.mean()), 0.1, what="the corrected wall", picture=True)


@points(1, needs="test_a_vignetted_scene_becomes_the_scene")
def test_a_brighter_wall_changes_nothing(subject, rng):
    """Does it matter how long the wall was exposed?

    Twice the light from the wall doubles flat in every pixel.

    It also doubles mean(flat), so the factor cancels.
    """
    scene, fraction = scene_and_vignetting(rng)
    once = finite(subject.TASK(scene, 50 * fraction), scene.shape, what="corrected")
    twice = subject.TASK(scene, 100 * fraction)
    same(twice, once, 0.1, what="corrected with a brighter wall", picture=True)
