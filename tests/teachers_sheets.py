"""The former path of `python -m tools.teachers_sheets`, for scripts that still call it."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from tools.teachers_sheets import main

main()
