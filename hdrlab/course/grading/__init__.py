"""Grade one submission: read it, run the checks, and divide the points among them."""

from hdrlab.course.grading.grader import grade

__all__ = ["grade"]
