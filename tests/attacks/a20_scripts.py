"""Print and raise scripts, formulas and codes that move the cursor."""

NASTY = "\x1b]0;title\x07\x1b[2J\x1b[31m"
NASTY += "<script>alert(1)</script><svg onload=alert(1)>\u202e=cmd|'/C calc'!A0\r\b"


def double(x):
    print(NASTY)
    raise type(NASTY[-20:], (Exception,), {})(NASTY)
