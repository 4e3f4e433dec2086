"""Variants of a task: the same question with other parameters."""
