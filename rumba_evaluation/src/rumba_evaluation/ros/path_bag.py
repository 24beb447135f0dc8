"""Reads a path from a bag: the last message of type nav_msgs/Path on a topic."""

from typing import Any, List

import numpy as np
import rosbag

from rumba_evaluation.scoring.drawn_path import DrawnPath, PathError, drawn_path
from rumba_sim.model.common.geometry import yaw
from rumba_sim.model.kernel import Array

KIND = 'nav_msgs/Path'
SHOWN = 10  # topics that an error names


def read(path: str, topic: str = '') -> DrawnPath:
    """Read a path; planners that publish it again and again made the last one last.

    Args:
        path: of the bag.
        topic: of the path; empty: the only one of its type.

    Raises:
        PathError: the bag cannot be read, or has no such path.
    """
    try:
        with rosbag.Bag(path) as bag:
            name = _topic(bag, path, topic)
            *_, (_, message, _) = bag.read_messages(topics=[name])
    except PathError:
        raise
    except rosbag.ROSBagUnindexedException:
        raise PathError(f'{path}: has no index, because the recording was interrupted: repair it by '
                        f'rosbag reindex {path}') from None
    except Exception as error:  # rosbag raises exceptions of many types if a bag is damaged
        raise PathError(f'{path}: is damaged ({type(error).__name__}: {error}): rosbag reindex {path} repairs what it '
                        'can') from error
    poses = message.poses
    return drawn_path(f'{path}, {name}', [f'pose {number}' for number in range(1, len(poses) + 1)],
                      np.array([(pose.pose.position.x, pose.pose.position.y) for pose in poses]).reshape(-1, 2),
                      np.array([_heading(pose.pose.orientation) for pose in poses]), _times(poses))


def _topic(bag: Any, path: str, wanted: str) -> str:
    topics = bag.get_type_and_topic_info().topics
    paths = [name for name, info in sorted(topics.items()) if info.msg_type == KIND and info.message_count]
    if wanted:
        found = [name for name in paths if name.strip('/') == wanted.strip('/')]
        if found:
            return str(found[0])
        raise PathError(f'{path}: has no {KIND} on {wanted}: has {_listed(paths)}')
    if len(paths) != 1:
        raise PathError(f'{path}: has {"several" if paths else "no"} topics of type {KIND}: '
                        + (f'choose one by --topic: {_listed(paths)}' if paths else f'has {_listed(sorted(topics))}'))
    return str(paths[0])


def _listed(names: List[str]) -> str:
    return ', '.join(names[:SHOWN]) + (', ...' if len(names) > SHOWN else '') or 'none'


def _heading(orientation: Any) -> float:
    return yaw(orientation.x, orientation.y, orientation.z, orientation.w)


def _times(poses: Any) -> Array:
    """The stamps of the poses [s] since the first; whole seconds first, so that nothing is rounded away."""
    begin = poses[0].header.stamp if poses else None
    return np.array([(pose.header.stamp - begin).to_sec() for pose in poses])
