# source setup.bash: a bash or zsh with the project's Python, its ROS packages and its commands in it.
# Works from any folder. A ROS 2 that is sourced already is used, and its ros2 command is never shadowed.

if [ -n "${BASH_VERSION:-}" ]; then _unicon_source="${BASH_SOURCE[0]}"; else eval '_unicon_source="${(%):-%x}"'; fi
_unicon_root="$(cd "$(dirname "$_unicon_source")" && pwd)"
case $- in *u*) _unicon_nounset=1; set +u ;; *) _unicon_nounset= ;; esac

if [ ! -f "$_unicon_root/.venv/bin/activate" ]; then
  echo "setup.bash: $_unicon_root is not set up yet: run \`make setup\` there" >&2
else
  . "$_unicon_root/.venv/bin/activate"
  if [ -z "${AMENT_PREFIX_PATH:-}" ]; then
    export AMENT_PREFIX_PATH="$VIRTUAL_ENV" CMAKE_PREFIX_PATH="$VIRTUAL_ENV"
  fi
  if [ -f "$_unicon_root/ros_ws/install/setup.bash" ] && [ -n "${BASH_VERSION:-}" ]; then
    . "$_unicon_root/ros_ws/install/setup.bash" 2>/dev/null
  elif [ -f "$_unicon_root/ros_ws/install/setup.sh" ] && [ -n "${ZSH_VERSION:-}" ]; then
    emulate sh -c '. "$_unicon_root/ros_ws/install/setup.sh"' 2>/dev/null
  fi
  export ROS_DISTRO="${ROS_DISTRO:-jazzy}"
  export ROS_AUTOMATIC_DISCOVERY_RANGE="${ROS_AUTOMATIC_DISCOVERY_RANGE:-LOCALHOST}"
  export FASTRTPS_DEFAULT_PROFILES_FILE="${FASTRTPS_DEFAULT_PROFILES_FILE:-$_unicon_root/config/fastdds.xml}"
  case ":$PATH:" in *":$_unicon_root/tools/bin:"*) ;; *) export PATH="$PATH:$_unicon_root/tools/bin" ;; esac
fi

[ -n "$_unicon_nounset" ] && set -u
unset _unicon_source _unicon_root _unicon_nounset
true
