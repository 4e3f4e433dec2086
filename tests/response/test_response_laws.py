"""Every method of response recovery obeys the laws; new modules are tested automatically."""

import pytest
from support import laws

from hdrlab.capture.responses import RESPONSES
from hdrlab.pipeline import catalogue, recovery

CAMERAS = {  # what a method assumes of its camera; of one that takes seconds, one does
    "linear": ["linear"],
    "mann": ["gamma", "linear"],
    "marginal": ["film"],
}
SLOW = {"marginal": pytest.mark.papers}  # it takes seconds
CASES = [
    pytest.param(name, camera, marks=SLOW.get(name, ()))
    for name in catalogue.names("response")
    for camera in CAMERAS.get(name, sorted(RESPONSES))
]


@pytest.mark.parametrize("law", laws.RECOVERY, ids=lambda law: law.__name__)
@pytest.mark.parametrize(("name", "response"), CASES)
def test_every_recovery(name, response, law):
    law(recovery.find_method(name), response)


@pytest.mark.parametrize("law", laws.CALIBRATION, ids=lambda law: law.__name__)
@pytest.mark.parametrize(
    ("name", "response"), [case for case in CASES if case.values[0] != "linear"]
)
def test_every_recovery_that_uses_the_photos(name, response, law):
    law(recovery.find_method(name), response)
