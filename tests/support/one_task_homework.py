"""A homework of one small function, for tests of what surrounds its grading."""

PLAN = """
[late]
free_days = 10
points_a_day = 1
[hw2]
title = "T"
due = 2026-10-23T23:59:00Z
tasks = [{ id = "hat", function = "core.weights.hat", points = 10 }]
"""
GOOD = "import numpy as np\n\ndef hat(n=256):\n    return n - 1 - abs(2 * np.arange(n) - n + 1)\n"
