"""The part of the ROS graph that the window needs, as the master describes it."""

import socket
from typing import FrozenSet, NamedTuple, Tuple

import rosgraph
import rospy

ODOMETRY, TRUTH = 'nav_msgs/Odometry', '/ground_truth'


class RosGraph(NamedTuple):
    """What the master knows.

    Attributes:
        master: identifies one run of a master; empty if none answers.
        robots: names below which a ground_truth is published.
        services: full names of all services.
        has_clock: whether /clock is published.
    """

    master: str = ''
    robots: Tuple[str, ...] = ()
    services: FrozenSet[str] = frozenset()
    has_clock: bool = False


def look() -> RosGraph:
    """Ask the master; blocks until it answers."""
    master = rosgraph.Master(rospy.get_name())
    try:
        run = str(master.getParam('/run_id'))
        topics = master.getPublishedTopics('')
        services = frozenset(name for name, _ in master.getSystemState()[2])
    except (rosgraph.MasterException, socket.error):
        return RosGraph()
    return RosGraph(run, robots(topics, rospy.get_namespace()), services, '/clock' in (name for name, _ in topics))


def robots(topics: Tuple[Tuple[str, str], ...], namespace: str) -> Tuple[str, ...]:
    """Names of the robots of a namespace, rumba2 before rumba10, from pairs of topic and type."""
    found = [topic[len(namespace):-len(TRUTH)] for topic, kind in topics
             if kind == ODOMETRY and topic.startswith(namespace) and topic.endswith(TRUTH)]
    return tuple(sorted((name for name in found if name and '/' not in name), key=lambda name: (len(name), name)))
