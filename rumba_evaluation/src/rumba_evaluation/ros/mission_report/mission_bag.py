"""Reads a bag: finds the robots in it, checks that a report can be made, and makes the record of one robot."""

import dataclasses
from typing import Dict, Iterable, List

import rosbag
import roslib.message

from rumba_evaluation.report.mission_record import MissionRecord
from rumba_evaluation.ros.mission_report.recorded_maps import read_maps
from rumba_evaluation.ros.mission_report.recorded_robot import TYPES, RecordedRobot, Topics
from rumba_sim.model.common.errors import RumbaError, one_line
from rumba_sim.model.simulation.robot import FIRST
from rumba_sim.ros.participants.maps import TRUE_TOPIC

POSITION, BATTERY = ('ground_truth', 'battery_status'), ('battery_status', 'battery_state')  # one of each is needed
LONGEST = 3000  # [characters] of an error
SHOWN = 20  # topics that an error names


class ReportError(RumbaError):
    """A bag cannot be read, lacks needed topics, or a report cannot be written."""

    def __init__(self, message: str) -> None:
        """Keep the message as one line, which may be long: it can end with the command to record all topics."""
        Exception.__init__(self, one_line(message, LONGEST))


def read(path: str, robot: str = '', target: float = 0.0) -> MissionRecord:
    """Read the record of one robot.

    Args:
        path: the bag.
        robot: name of the robot, with or without its namespace; empty: the only one, or the one named rumba.
        target: share of the floor that was to be swept [0..1]; 0: that of the recorded goal, or the cleaner's default.

    Raises:
        ReportError: the bag cannot be read, or lacks needed topics.
    """
    others: List[str] = []
    try:
        with rosbag.Bag(path) as bag:
            others = _other_definitions(bag)
            return _read(bag, path, robot, target)
    except ReportError:
        raise
    except rosbag.ROSBagUnindexedException:
        raise ReportError(f'{path}: has no index, because the recording was interrupted: repair it by '
                          f'rosbag reindex {path}') from None
    except Exception as error:  # rosbag raises exceptions of many types if a bag is damaged
        if isinstance(error, OSError) and error.strerror:
            raise ReportError(f'{path}: {error.strerror}') from error
        if others and not isinstance(error, rosbag.ROSBagException):
            raise ReportError(f'{path}: was recorded with another definition of {" and ".join(others)} than the one '
                              f'here ({error}): make the report where it was recorded') from error
        raise ReportError(f'{path}: is not a bag, or is damaged ({type(error).__name__}: {error}): '
                          f'rosbag reindex {path} repairs what it can') from error


def _other_definitions(bag: rosbag.Bag) -> List[str]:
    """Types that the bag and this system both know, by different definitions."""
    found = []
    for name, md5 in sorted(bag.get_type_and_topic_info().msg_types.items()):
        kind = roslib.message.get_message_class(name)
        if kind is not None and kind._md5sum != md5:
            found.append(name)
    return found


def _read(bag: rosbag.Bag, path: str, wanted: str, target: float) -> MissionRecord:
    kinds = {topic: info.msg_type for topic, info in sorted(bag.get_type_and_topic_info().topics.items())
             if info.message_count}
    robots = _robots(kinds)
    name = _choose(path, robots, wanted)
    _check(path, name, robots.get(name, {}), kinds)
    mates = _mates(bag, path, {other: topics for other, topics in robots.items() if other != name}, target)
    others = [other for other in robots if other != name and _shown(other) not in [mate.robot for mate in mates]]
    remarks = [f'Also in the bag, without what a report needs: {_listed(others)}.'] if others else []
    maps = read_maps(bag, kinds, name)
    record = RecordedRobot(bag, robots[name]).record(path, _shown(name), maps.floor, maps.known,
                                                     [*remarks, *maps.remarks], target)
    record = dataclasses.replace(record, mates=mates)
    for what, part in (('position', record.path), ('charge', record.charge)):
        if not len(part.times):
            raise ReportError(f'{path}: robot {record.robot}: no {what} is a finite number')
    return record


def _mates(bag: rosbag.Bag, path: str, robots: Dict[str, Topics], target: float) -> List[MissionRecord]:
    """The records of those robots of which a report can be made."""
    records = [RecordedRobot(bag, topics).record(path, _shown(name), None, None, [], target)
               for name, topics in robots.items() if not _lacks(topics)]
    return [record for record in records if len(record.path.times) and len(record.charge.times)]


def _robots(kinds: Dict[str, str]) -> Dict[str, Topics]:
    """The topics of each robot by its namespace, from the types of all topics."""
    robots: Dict[str, Topics] = {}
    for topic, kind in kinds.items():  # rosbag writes names as they were given: relative ones begin without a slash
        path = f'/{topic.strip("/")}'
        name = next((name for name, its_kind in TYPES.items() if its_kind == kind and path.endswith(f'/{name}')), '')
        namespace = path[:-len(name) - 1]
        if name:
            robots.setdefault(namespace, {}).setdefault(name, []).append(topic)
    return robots


def _choose(path: str, robots: Dict[str, Topics], wanted: str) -> str:
    """The namespace of the chosen robot."""
    if wanted:
        names = ([name for name in robots if name.strip('/') == wanted.strip('/')]
                 or [name for name in robots if name.rpartition('/')[2] == wanted])
        if not names:
            raise ReportError(f'{path}: there is no robot {wanted!r}: the robots are {_listed(robots) or "none"}')
    else:
        names = [name for name, topics in robots.items() if not _lacks(topics)] or list(robots) or [f'/{FIRST}']
        names = [name for name in names if len(names) == 1 or name.rpartition('/')[2] == FIRST] or names
    if len(names) > 1:
        raise ReportError(f'{path}: there are several robots: choose one by --robot NAME: {_listed(names)}')
    return names[0]


def _check(path: str, name: str, topics: Topics, kinds: Dict[str, str]) -> None:
    lacks = _lacks(topics)
    if lacks:
        found = ', '.join(list(kinds)[:SHOWN]) + (', ...' if len(kinds) > SHOWN else '')
        wanted = ' '.join(f'{name}/{short}' for short in TYPES)
        simulator = f'{name.rpartition("/")[0]}/{TRUE_TOPIC}'
        raise ReportError(f'{path}: robot {_shown(name)} lacks {lacks}; the bag has {found or "no messages"}; '
                          f'record a mission by: rosbag record /map /tf_static {simulator} {wanted}')


def _lacks(topics: Topics) -> str:
    return ' and '.join(' or '.join(either) for either in (POSITION, BATTERY) if not topics.keys() & set(either))


def _shown(namespace: str) -> str:
    return namespace.strip('/') or '/'


def _listed(names: Iterable[str]) -> str:
    return ', '.join(map(_shown, names))
