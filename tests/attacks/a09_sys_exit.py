"""It leaves as a program does that ended well, when it is imported."""

import sys

sys.exit(0)
