"""Every recovery of a response obeys the laws; a new one is tested by existing."""

import laws
import pytest

from hdrlab.capture.responses import RESPONSES
from hdrlab.core import catalogue

CAMERAS = {"linear": ["linear"], "mann": ["gamma", "linear"]}  # what a method assumes of its camera
CASES = [(name, one) for name in catalogue.names("response") for one in CAMERAS.get(name, sorted(RESPONSES))]


@pytest.mark.parametrize("law", laws.RECOVERY, ids=lambda law: law.__name__)
@pytest.mark.parametrize(("name", "response"), CASES)
def test_every_recovery(name, response, law):
    law(catalogue.method("response", name), response)
