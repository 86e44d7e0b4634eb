#!/usr/bin/env bash
# gui.sh BUILD OUTPUT [DISPLAY] [SCRIPT]
# Starts ParaView's own window on a virtual display with the plugin of BUILD, lets SCRIPT (default:
# gui_script.py) show an isosurface there, and saves OUTPUT/gui_window.png, the whole window as a
# user sees it, and OUTPUT/gui_refining.png when the script makes a file gui_refining. What the
# script reports is in OUTPUT/gui.json, what ParaView says in OUTPUT/gui.log. Needs Debian's
# python3-pil, which ParaView's Python packages bring along, and python3-pyqt5 or, from Debian 13 on,
# python3-pyqt6.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$(realpath "$1")
mkdir -p "$2"
output=$(realpath "$2")
display=${3:-:$((100 + $$ % 400))}
script=$here/${4:-gui_script.py}
patience=${PROGISO_GUI_SECONDS:-240}

scratch=$(mktemp -d)
server= window=
finish() {
  [ -z "$window" ] || kill -KILL "$window" 2>/dev/null || true
  [ -z "$server" ] || kill "$server" 2>/dev/null || true
  rm -rf "$scratch"
}
trap finish EXIT

# A home of its own: no welcome dialog, a large window, nothing of the user's settings.
export HOME=$scratch XDG_CONFIG_HOME=$scratch/.config XDG_RUNTIME_DIR=$scratch/run DISPLAY=$display
mkdir -p "$XDG_RUNTIME_DIR" "$XDG_CONFIG_HOME/ParaView"
chmod 700 "$XDG_RUNTIME_DIR"
version=$(pvpython --version 2>&1 | grep -o '[0-9][0-9.]*$' | head -1)
cat >"$XDG_CONFIG_HOME/ParaView/ParaView$version.ini" <<'END'
[General]
GeneralSettings.ShowWelcomeDialog=false
[MainWindow]
Size=@Size(1600 1500)
Position=@Point(0 0)
END

Xvfb "$display" -screen 0 1600x1500x24 -noreset >/dev/null 2>&1 &
server=$!
for _ in $(seq 50); do
  [ -e "/tmp/.X11-unix/X${display#:}" ] && break
  sleep 0.1
done

rm -f "$output"/gui{.log,.json,_refining,_refining.png,_window.png}
grab() {
  /usr/bin/python3 -c '
import sys
from PIL import ImageGrab
ImageGrab.grab(xdisplay=sys.argv[1]).save(sys.argv[2])
' "$display" "$1"
}
export PROGISO_GUI_BUILD=$build PROGISO_GUI_OUTPUT=$output PYTHONPATH=$here
paraview --script="$script" >"$output/gui.log" 2>&1 &
window=$!
for _ in $(seq "$patience"); do
  sleep 1
  if [ -e "$output/gui_refining" ] && [ ! -e "$output/gui_refining.png" ]; then
    grab "$output/gui_refining.png"
  fi
  [ -e "$output/gui.json" ] && break
  kill -0 "$window" 2>/dev/null || break
done
if [ ! -e "$output/gui.json" ]; then
  echo "ParaView's window showed no complete image; see $output/gui.log:" >&2
  tail -20 "$output/gui.log" >&2
  exit 1
fi
sleep 1 # for the panels to be painted
grab "$output/gui_window.png"
cat "$output/gui.json"
