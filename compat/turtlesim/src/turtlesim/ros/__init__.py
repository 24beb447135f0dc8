"""The nodes: the only place that imports rospy, one module a node."""

import threading

# Debian 11: rospy 1.15.9 ends every node by a method that Python 3.9 took away.
if not hasattr(threading.Thread, 'isAlive'):
    threading.Thread.isAlive = threading.Thread.is_alive  # type: ignore[attr-defined]
