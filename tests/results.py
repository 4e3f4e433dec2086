"""`python tests/results.py FOLDER` reads pytest's reports: the slowest tests, what failed, how many ran."""

import sys
import xml.etree.ElementTree as ET
from pathlib import Path

SLOWEST = 20


def main(folder: Path) -> int:
    """Print what the reports in a folder say; return 1 where a test failed, or none ran."""
    tests = [
        test for file in sorted(folder.glob("*.xml")) for test in ET.parse(file).iter("testcase")
    ]
    failed = [test for test in tests if any(kind.tag in ("failure", "error") for kind in test)]
    skipped = sum(test.find("skipped") is not None for test in tests)
    print(f"the {SLOWEST} slowest tests, in seconds, with what each of them sets up")
    for test in sorted(tests, key=seconds, reverse=True)[:SLOWEST]:
        print(f"{seconds(test):8.1f}  {address(test)}")
    for test in failed:
        print(f"FAILED {address(test)}")
    print(f"{len(tests) - len(failed) - skipped} passed, {len(failed)} failed, {skipped} skipped")
    return int(bool(failed) or not tests)


def seconds(test: ET.Element) -> float:
    """Return how long a test took."""
    return float(test.get("time", 0))


def address(test: ET.Element) -> str:
    """Return where a test is and what it promises."""
    return f"{test.get('classname')}::{test.get('name')}"


if __name__ == "__main__":
    raise SystemExit(main(Path(sys.argv[1])))
