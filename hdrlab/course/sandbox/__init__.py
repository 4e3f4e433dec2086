"""Where a student's functions run: apart from who scores them, in one of four tiers.

The fourth is for a page in a browser, where there are no processes (`in_process`).
"""
