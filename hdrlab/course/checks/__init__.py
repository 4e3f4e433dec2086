"""The checks of the course, the known mistakes, and what runs the checks against a student's code."""

from pathlib import Path

# test_<task>.py holds the promises of a task
SPECIFICATION = Path(__file__).parent / "specification"
