"""A homework with one small function, for tests of everything around its grading."""

PLAN = """
[late]
free_days = 10
points_a_day = 1
[hw2]
title = "T"
due = 2026-10-23T23:59:00Z
tasks = [{ id = "hat", function = "core.weights.hat", points = 10 }]
"""
CORRECT_CODE = """import numpy as np

def hat(n=256):
    return n - 1 - abs(2 * np.arange(n) - n + 1)
"""
