# On ROS Noetic the headers of all messages lie in one folder, which is that of roscpp: a node that includes
# turtlesim/Pose.h compiles there although its package does not name turtlesim. This makes it so here. The folder holds
# those of turtlesim alone: headers of others could hide that a package does not name what it needs.
_headers=$CATKIN_ENV_HOOK_WORKSPACE/share/turtlesim/headers
case :${CPLUS_INCLUDE_PATH:-}: in
  *":$_headers:"*) ;;
  *) export CPLUS_INCLUDE_PATH="$_headers${CPLUS_INCLUDE_PATH:+:$CPLUS_INCLUDE_PATH}" ;;
esac
unset _headers
