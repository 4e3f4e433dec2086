"""Fixtures of the checks in hdrlab's own tests: `subject` is the library, and `rng` has the seed 0.

The grader runs the same files with --noconftest and its own plugin, which provides the same two
fixtures. There, `subject` calls the student's code in another process, and `rng` has a seed of the
student's own.
"""

import numpy as np
import pytest

from hdrlab.course.checks import inprocess


@pytest.fixture
def subject():
    """Return the library as a subject: subject.gsolve(...) returns plain arrays."""
    return inprocess.library()


@pytest.fixture
def rng(request):
    """Return a new random generator for every check."""
    return np.random.default_rng(0)
