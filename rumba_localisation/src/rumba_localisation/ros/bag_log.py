"""Reads scans and odometry of a bag."""

import math
from typing import Any, Callable, Iterator, List, Optional

import rosbag

from rumba_localisation.logs.entry import Entry, LogError
from rumba_localisation.ros.odometries import Odometries
from rumba_localisation.scan import Reading, fault, told
from rumba_sim.ros.common.conversions import plane_pose
from rumba_sim.ros.common.mountings import Mountings


def entries(path: str, scan: str, odom: str, base: str, reading: Reading,
            advance: Callable[[int], None]) -> Iterator[Entry]:
    """The scans of a bag, one after the other.

    Args:
        path: of the bag.
        scan: topic of sensor_msgs/LaserScan.
        odom: topic of nav_msgs/Odometry.
        base: frame of the robot, from which tf leads to that of the laser.
        reading: how ranges are taken.
        advance: called with the number of messages that were read since the last call.

    Raises:
        LogError: the bag cannot be read, lacks a topic, or a scan cannot be used.
    """
    try:
        with rosbag.Bag(path) as bag:
            topics = bag.get_type_and_topic_info().topics
            for topic in (scan, odom):
                if topic not in topics:
                    raise LogError(f'{path}: has no topic {topic}; it has {", ".join(sorted(topics))}')
            yield from _entries(bag, scan, odom, base, reading, advance)
    except (OSError, rosbag.ROSBagException) as error:
        raise LogError(f'{path}: cannot be read: {getattr(error, "strerror", None) or error}') from error


def _entries(bag: Any, scan: str, odom: str, base: str, reading: Reading,
             advance: Callable[[int], None]) -> Iterator[Entry]:
    odometries, mountings, waiting = Odometries(), Mountings(base), []  # type: Any, Any, List[Any]
    for topic, message, _ in bag.read_messages(topics=[scan, odom, '/tf_static', '/tf']):
        advance(1)
        if topic == scan:
            waiting.append(message)
        elif topic == odom:
            pose = plane_pose(message.pose.pose)
            if all(map(math.isfinite, pose)):
                odometries.add(message.header.stamp, pose)
        else:
            mountings.take(message)
        while waiting:
            found = _entry(waiting[0], odometries, mountings, reading)
            if found is None and not odometries.is_before(waiting[0].header.stamp):
                break
            waiting.pop(0)
            if found is not None:
                yield found
    if waiting and mountings.of(waiting[0]) is None:
        raise LogError(f'{bag.filename}: {mountings.fault(waiting[0])}')


def _entry(message: Any, odometries: Odometries, mountings: Mountings, reading: Reading) -> Optional[Entry]:
    """What a scan tells; None if it is not known where the robot was, or the laser is."""
    odometry, mounting = odometries.at(message.header.stamp), mountings.of(message)
    if odometry is None or mounting is None:
        return None
    seen = told(message, mounting, reading)
    if seen is None:
        raise LogError(f'scan at {message.header.stamp.to_sec():.3f} s: {fault(message)}')
    return Entry(message.header.stamp.to_sec(), odometry, seen, None)
