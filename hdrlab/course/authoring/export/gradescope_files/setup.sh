#!/usr/bin/env bash
# Run once by Gradescope when the image is made.
set -euo pipefail
apt-get update -qq
DEBIAN_FRONTEND=noninteractive apt-get install -y -qq python3 python3-venv
python3 -m venv /autograder/env
/autograder/env/bin/pip install --quiet -r /autograder/source/requirements.txt
