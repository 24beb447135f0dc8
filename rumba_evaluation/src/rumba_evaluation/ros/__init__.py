"""What needs ROS: the nodes and commands of the evaluation."""

import rumba_sim.ros.common  # noqa: F401, so that rumba_msg is ours
