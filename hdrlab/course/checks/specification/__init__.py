"""The checks of the course: one file per task, and one test function per check."""
