"""The ROS face of the behaviours: the only place in this package that imports rospy."""

import rumba_sim.ros.common  # noqa: F401, so that rumba_msg is ours
