"""Print the slowest tests, the failures and the counts from the JUnit reports of pytest.

    python -m tools.junit_summary FOLDER

`.ci/run` calls it at its end. The exit code is 1 if a test failed or if there are no tests.
"""

import sys
import xml.etree.ElementTree as ET
from pathlib import Path

SLOWEST_COUNT = 20


def print_summary(folder: Path) -> int:
    """Print the summary of all reports in a folder and return the exit code."""
    tests = []
    for report in sorted(folder.glob("*.xml")):
        tests.extend(ET.parse(report).iter("testcase"))
    failed = [test for test in tests if has_failed(test)]
    skipped = [test for test in tests if test.find("skipped") is not None]
    passed_count = len(tests) - len(failed) - len(skipped)
    print(f"the {SLOWEST_COUNT} slowest tests, in seconds, including their fixtures")
    for test in sorted(tests, key=duration_seconds, reverse=True)[:SLOWEST_COUNT]:
        print(f"{duration_seconds(test):8.1f}  {full_name(test)}")
    for test in failed:
        print(f"FAILED {full_name(test)}")
    print(f"{passed_count} passed, {len(failed)} failed, {len(skipped)} skipped")
    return 0 if tests and not failed else 1


def has_failed(test: ET.Element) -> bool:
    """Return whether a test failed, or a fixture of it."""
    return any(child.tag in ("failure", "error") for child in test)


def duration_seconds(test: ET.Element) -> float:
    """Return how long a test took."""
    return float(test.get("time", 0))


def full_name(test: ET.Element) -> str:
    """Return the module, the class and the name of a test."""
    return f"{test.get('classname')}::{test.get('name')}"


if __name__ == "__main__":
    raise SystemExit(print_summary(Path(sys.argv[1])))
