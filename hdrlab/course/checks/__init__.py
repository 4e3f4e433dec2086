"""The checks: the specification, the well-known mistakes, and what runs them against a student's code."""

from pathlib import Path

SPECIFICATION = Path(__file__).parent / "specification"  # test_<task>.py, the promises of a task
# <task>_<mistake>.py, the wrong function and a sentence; in method/ those that miss what the task
# is about
MISTAKES = Path(__file__).parent / "mistakes"
