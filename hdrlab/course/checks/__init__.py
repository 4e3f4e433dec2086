"""The checks: the specification, the well-known mistakes, and what runs them against a student's code."""

from pathlib import Path

SPECIFICATION = Path(__file__).parent / "specification"  # test_<task>.py, the promises of a task
MISTAKES = Path(__file__).parent / "mistakes"  # <task>_<mistake>.py, the wrong function and a sentence
