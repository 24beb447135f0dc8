# On ROS Noetic the headers of all messages lie in one folder, which is that of roscpp: a node that includes
# turtlesim/Pose.h compiles there although its package does not name turtlesim. This makes it so here.
_headers=$CATKIN_ENV_HOOK_WORKSPACE/include
case :${CPLUS_INCLUDE_PATH:-}: in
  *":$_headers:"*) ;;
  *) export CPLUS_INCLUDE_PATH="$_headers${CPLUS_INCLUDE_PATH:+:$CPLUS_INCLUDE_PATH}" ;;
esac
unset _headers
