# Sourced by the scripts that take pictures of rviz: a virtual display and a ROS master of their own.

# Ends the script unless these programs are there.
require_commands() {
  local command missing=()
  for command in "$@"; do
    command -v "$command" >/dev/null || missing+=("$command")
  done
  if [ ${#missing[@]} -gt 0 ]; then
    echo "${0##*/}: missing: ${missing[*]} (apt-get install xvfb imagemagick rviz python3-roslaunch)" >&2
    exit 1
  fi
}

# source_workspace SETUP: catkin's file reads unset variables and the caller's positional parameters.
source_workspace() {
  local setup=$1
  if [ ! -f "$setup" ]; then
    echo "${0##*/}: no $setup; build first (scripts/build), or name the workspace's setup.bash" >&2
    exit 1
  fi
  shift
  set +u
  # shellcheck disable=SC1090
  source "$setup"
  set -u
}

# open_display WIDTHxHEIGHT: sets DISPLAY, ROS_MASTER_URI, master_port and scratch, a directory that is removed at the
# end, as what was started here is.
open_display() {
  scratch=$(mktemp -d)
  trap 'rm -rf "$scratch"' EXIT
  # A master on a port of its own, so that a running one is left alone.
  master_port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("", 0)); print(s.getsockname()[1])')
  export ROS_MASTER_URI=http://localhost:$master_port ROS_HOME=$scratch/ros XDG_RUNTIME_DIR=$scratch
  export LIBGL_ALWAYS_SOFTWARE=1
  chmod 700 "$scratch"
  # Xvfb takes a free display and writes its number.
  Xvfb -displayfd 3 -screen 0 "${1}x24" -nolisten tcp 3>"$scratch/display" 2>"$scratch/xvfb.log" &
  xvfb=$!
  trap 'kill "$xvfb" 2>/dev/null || true; rm -rf "$scratch"' EXIT
  local i
  for ((i = 0; i < 100; ++i)); do
    [ -s "$scratch/display" ] && break
    sleep 0.1
  done
  DISPLAY=:$(cat "$scratch/display")
  export DISPLAY
}

# start_simulator SCENE [ARGUMENT:=VALUE...]: sim.launch without rviz; its process is $launch.
start_simulator() {
  roslaunch -p "$master_port" hybrid_sphere sim.launch "scene:=$1" rviz:=false "${@:2}" >"$scratch/log" 2>&1 &
  launch=$!
  local i
  for ((i = 0; i < 100; ++i)); do
    rosservice list 2>/dev/null | grep -q /hybrid_sphere/reset && break
    sleep 0.2
  done
}

# start_rviz: the picture alone, without panels and without the handle, which is there while time stands and would
# hide the sphere. Waits until rviz listens, and for its first frames. Its process is $rviz.
start_rviz() {
  sed -e '/^Panels:/,/^Visualization Manager:/{/^  /d;s/^Panels:/& []/}' \
    -e '/Class: rviz\/InteractiveMarkers/,/Enabled:/s/Enabled: true/Enabled: false/' \
    -e 's/^  Width: .*/  Width: 1280/;s/^  Height: .*/  Height: 800/' rviz/sim.rviz >"$scratch/view.rviz"
  rviz --display-config "$scratch/view.rviz" >"$scratch/rviz.log" 2>&1 &
  rviz=$!
  local i
  for ((i = 0; i < 200; ++i)); do
    if rostopic info /hybrid_sphere/markers 2>/dev/null | grep -q '\* /rviz'; then
      break
    fi
    sleep 0.2
  done
  sleep 4
}

stop_both() {
  kill "$rviz"
  wait "$rviz" || true
  kill -INT "$launch"
  wait "$launch" || true
}

# require_small FILE BYTES: ends the script where the file is larger.
require_small() {
  local bytes
  bytes=$(stat --format=%s "$1")
  if [ "$bytes" -gt "$2" ]; then
    echo "${0##*/}: $1 has $bytes bytes, more than $2" >&2
    exit 1
  fi
  echo "$1: $bytes bytes"
}
