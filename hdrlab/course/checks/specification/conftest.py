"""What the checks ask for: here `subject` is the library itself, and `rng` draws from the seed 0.

The grader runs the same files with --noconftest and its own plugin, which brings the same two
fixtures: there `subject` speaks to a student's code in another process, and `rng` draws what is
that student's own.
"""

import numpy as np
import pytest

from hdrlab.course.checks import inprocess


@pytest.fixture
def subject():
    """subject.gsolve(...) -> what the task's function answers, as plain arrays."""
    return inprocess.library()


@pytest.fixture
def rng(request):
    """A random generator, afresh for every check."""
    return np.random.default_rng(0)
