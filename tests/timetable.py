"""The former path of `python -m tools.course_minutes`, for scripts that still call it."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from tools.course_minutes import main

main()
