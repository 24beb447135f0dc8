"""The maps in a bag: that by which a robot worked, or the true one with what the robot's own map shows of it."""

import collections
import math
from typing import Dict, List, NamedTuple, Optional, Sequence

import rosbag

from rumba_evaluation.report.mission_record import Grid
from rumba_evaluation.ros.mission_report.recorded_robot import FAR, GRID, grid_of
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.laid_over import laid_over
from rumba_sim.ros.common.conversions import map_pose
from rumba_sim.ros.participants.maps import TRUE_TOPIC

STATIC = 'tf_static'


class Maps(NamedTuple):
    """The map of a mission; see `MissionRecord`.

    Attributes:
        remarks: why something of it is not there.
    """

    floor: Optional[Grid]
    known: Optional[Grid]
    remarks: Sequence[str]


def read_maps(bag: rosbag.Bag, kinds: Dict[str, str], robot: str) -> Maps:
    """The last maps for a robot, by its namespace, from the types of all topics."""
    own_topics, true_topics = _own_topics(kinds, robot), _true_topics(kinds, robot)
    own, true = _last_grid(bag, own_topics), _last_grid(bag, true_topics)
    remarks = ([] if own or not own_topics else
               ['The map is not drawn: it is damaged, or rotated against the axes.'])
    if true is None:
        return Maps(own, None, remarks)
    frame = _map_frame(bag)
    if own is None or frame is None:
        return Maps(true, None, remarks or [f'The map of the robot is not drawn: it needs /map and /{STATIC}.'])
    return Maps(true, true._replace(cells=laid_over(own, frame, true)), remarks)


def _own_topics(kinds: Dict[str, str], robot: str) -> List[str]:
    """The map in the robot's namespace, or in the nearest namespace above it that has one."""
    maps = [(f'/{topic.strip("/")}'[:-len('map')], topic) for topic, kind in kinds.items()
            if kind == GRID and topic.rpartition('/')[2] == 'map']
    around = [(namespace, topic) for namespace, topic in maps if f'{robot}/'.startswith(namespace)]
    return [max(around, key=lambda pair: len(pair[0]))[1]] if around else []


def _true_topics(kinds: Dict[str, str], robot: str) -> List[str]:
    """The true map, which the simulator in the namespace of the robot tells to onlookers."""
    wanted = f'{robot.rpartition("/")[0]}/{TRUE_TOPIC}'
    return [topic for topic, kind in kinds.items() if kind == GRID and f'/{topic.strip("/")}' == wanted]


def _last_grid(bag: rosbag.Bag, topics: List[str]) -> Optional[Grid]:
    """The last grid of topics; None if there is none, or if it is not valid."""
    last = collections.deque(bag.read_messages(topics, raw=True) if topics else (), maxlen=1)
    for _, raw, _ in last:
        if raw[0] == GRID:
            message = raw[-1]()
            message.deserialize(raw[1])
            return grid_of(message)
    return None


def _map_frame(bag: rosbag.Bag) -> Optional[Pose]:
    """Where the map that a robot made is in the world; None if the bag does not tell it."""
    poses = [map_pose(message) for _, message, _ in bag.read_messages([STATIC, f'/{STATIC}'])]
    good = [pose for pose in poses if pose is not None
            and abs(pose.x) < FAR and abs(pose.y) < FAR and math.isfinite(pose.theta)]
    return good[-1] if good else None
