"""Limits of the checks that the command line states, apart from the plan so that it starts quickly."""

# For one call of a student's function, by default. `checks.subject` and `grading.grader` derive or
# state the limits of a check, of a submission and of all checks, and SECURITY.md adds them up.
CALL_TIMEOUT_SECONDS = 10.0
