"""The node viewer: it listens to topics and the master, and calls services and actions of robots."""

import rumba_sim.ros.common  # noqa: F401, so that rumba_msg is ours
