#!/usr/bin/env bash
# From nothing to a picture, on Debian 12 as root or with sudo: sets up the wheel stack in .venv, fetches a CT
# scan of a skull and renders its bone through the whole pipeline. The last line is the picture's path.
set -euo pipefail
cd "$(dirname "$0")/.."

.ci/setup-wheel
scan=$(.venv/bin/python -m progiso data ct-cranium)
picture=$PWD/skull.png
# seen from the front left
.venv/bin/python -m progiso render "$scan" --isovalue 226 --rate 8 --size 1280x720 --view 0.5,1,0.15 --output "$picture"
echo "$picture"
