#!/usr/bin/env bash
# From nothing to a picture, on Debian 12 as root or with sudo: sets up the wheel stack in .venv, fetches a CT
# scan of a skull and renders its bone through the whole pipeline. Takes 2 to 5 minutes, and says what it is at. The
# last line is the picture's path.
set -euo pipefail
cd "$(dirname "$0")/.."

.ci/setup-wheel
echo "== fetching a CT scan of a skull"
scan=$(.venv/bin/python -m progiso data ct-cranium)
picture=$PWD/skull.png
echo "== rendering $scan"
# seen from the front left
.venv/bin/python -m progiso render "$scan" --isovalue 226 --rate 8 --size 1280x720 --view 0.5,1,0.15 --output "$picture"
echo "$picture"
