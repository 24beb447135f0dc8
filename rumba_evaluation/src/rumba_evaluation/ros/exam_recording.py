"""What was not allowed in an examination, as its recording shows it."""

import math
from typing import Any, Dict, List, Set

import rosbag
import rospy

from rumba_sim.model.simulation.robot import FIRST

TRUTH = f'/{FIRST}/ground_truth'
COMMANDS = (f'/{FIRST}/cmd_vel', f'/{FIRST}/teleop/cmd_vel')
FASTEST = 1.0  # [m/s]: no robot is as fast
SLACK = 0.05  # [m]


def findings(bag: str, commanders: int = 1) -> List[str]:
    """What was not allowed, in words.

    Args:
        bag: path of the recording.
        commanders: how many nodes may command.
    """
    try:
        with rosbag.Bag(bag) as recording:
            return [*_commands(recording, commanders), *_jumps(recording)]
    except (OSError, rosbag.ROSBagException, rospy.ROSException) as error:
        return [f'the recording cannot be read: {error}']


def _commands(recording: rosbag.Bag, commanders: int) -> List[str]:
    publishers: Dict[str, Set[str]] = {}
    for topic, _, _, header in recording.read_messages(COMMANDS, raw=True, return_connection_header=True):
        publishers.setdefault(topic, set()).add(_text(header.get('callerid', 'a node without a name')))
    return [f'{topic} was published by {" and ".join(sorted(nodes))}' for topic, nodes in sorted(publishers.items())
            if len(nodes) > commanders or topic != COMMANDS[0]]


def _text(value: Any) -> str:
    """A value of a header of a connection, which rosbag reads as bytes."""
    return value.decode(errors='replace') if isinstance(value, bytes) else str(value)


def _jumps(recording: rosbag.Bag) -> List[str]:
    before = None
    for _, message, _ in recording.read_messages(TRUTH):
        now, place = message.header.stamp.to_sec(), message.pose.pose.position
        if before is not None and (math.hypot(place.x - before[1], place.y - before[2])
                                   > FASTEST * abs(now - before[0]) + SLACK):
            return [f'the robot was moved by a call, from ({before[1]:.2f}, {before[2]:.2f}) m to ({place.x:.2f}, '
                    f'{place.y:.2f}) m after {now:.1f} s']
        before = now, place.x, place.y
    return [] if before is not None else ['the recording does not show where the robot was']
