"""Modules that several test files use; `from support import malicious_archives` works in every
test.
"""
