"""The former path of `python -m tools.fold_cells`, for scripts that still call it."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from tools.fold_cells import main

main()
