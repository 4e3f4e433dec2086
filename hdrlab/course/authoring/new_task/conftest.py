"""Run the checks on the solutions in this folder. The grader runs them on a student's code instead."""

from pathlib import Path

import numpy as np
import pytest

from hdrlab.course import plan
from hdrlab.course.checks import inprocess


@pytest.fixture
def subject():
    """Return the solutions: subject.name(...) calls one, and its answer comes as plain arrays."""
    return inprocess.library(plan.read(Path(__file__).with_name("plan.toml")))


@pytest.fixture
def rng():
    """Return a new random generator for each check; the grader draws another for each student."""
    return np.random.default_rng(0)
