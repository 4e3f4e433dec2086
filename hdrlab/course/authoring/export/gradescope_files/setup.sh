#!/usr/bin/env bash
# Run once by Gradescope when the image is made. hdrlab needs Python 3.11 or later.
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive

is_new_enough() {
  "$1" -c "import sys; sys.exit(sys.version_info < (3, 11))"
}

apt-get update -qq
apt-get install -y -qq python3 python3-venv libseccomp2
python=python3
if ! is_new_enough "$python"; then
  # Ubuntu 22.04: python3 is 3.10 there, but 3.11 is among its packages
  python=python3.11
  if ! apt-get install -y -qq python3.11 python3.11-venv; then
    echo "hdrlab needs Python 3.11; choose Ubuntu 22.04 or later as the base image" >&2
    exit 1
  fi
fi
"$python" -m venv /autograder/env
/autograder/env/bin/pip install --quiet -r /autograder/source/requirements.txt
# The log of the build then shows whether the tier "container" works here.
PYTHONPATH=/autograder/source /autograder/env/bin/python -m hdrlab doctor || true
