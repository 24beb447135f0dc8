"""A bag of a mission: which robots are in it, whether it has what a report needs, and the record of one of them."""

from typing import Dict, Iterable, List

import rosbag

from rumba_evaluation.report.mission_record import MissionRecord
from rumba_evaluation.ros.mission_report.recorded_robot import GRID, TYPES, RecordedRobot, Topics
from rumba_sim.model.errors import RumbaError
from rumba_sim.ros.common.frames import FIRST

PLACE, BATTERY = ('ground_truth', 'battery_status'), ('battery_status', 'battery_state')  # one of each is needed
SHOWN = 20  # topics that an error names


class ReportError(RumbaError):
    """A bag cannot be read, lacks what a report needs, or a report cannot be written."""


def read(path: str, robot: str = '') -> MissionRecord:
    """Read what a report needs of one robot.

    Args:
        path: of the bag.
        robot: name of the robot, with or without its namespace; empty: the only one, or the one named rumba.

    Raises:
        ReportError: the bag cannot be read, or lacks what a report needs.
    """
    try:
        with rosbag.Bag(path) as bag:
            return _read(bag, path, robot)
    except ReportError:
        raise
    except rosbag.ROSBagUnindexedException:
        raise ReportError(f'{path}: has no index, as a recording that was cut off: rosbag reindex {path}') from None
    except Exception as error:  # over a damaged bag rosbag raises whatever it stumbles into
        if isinstance(error, OSError) and error.strerror:
            raise ReportError(f'{path}: {error.strerror}') from error
        raise ReportError(f'{path}: no bag, or cut short, or damaged ({type(error).__name__}: {error}): '
                          f'rosbag reindex {path} mends what can be mended') from error


def _read(bag: rosbag.Bag, path: str, wanted: str) -> MissionRecord:
    kinds = {topic: info.msg_type for topic, info in sorted(bag.get_type_and_topic_info().topics.items())
             if info.message_count}
    robots = _robots(kinds)
    name = _choose(path, robots, wanted)
    _check(path, name, robots.get(name, {}), kinds)
    remarks = [f'Also in the bag: {_listed(other for other in robots if other != name)}.'] if len(robots) > 1 else []
    record = RecordedRobot(bag, robots[name]).record(path, _shown(name), _map_topics(kinds, name), remarks)
    for what, part in (('place', record.path), ('charge', record.charge)):
        if not len(part.times):
            raise ReportError(f'{path}: of the robot {record.robot} no {what} is a finite number')
    return record


def _robots(kinds: Dict[str, str]) -> Dict[str, Topics]:
    """What there is of each robot, by its namespace, out of the types of all topics."""
    robots: Dict[str, Topics] = {}
    for topic, kind in kinds.items():  # rosbag records the name that it was given: relative ones have no slash
        namespace, _, name = f'/{topic.strip("/")}'.rpartition('/')
        if TYPES.get(name) == kind:
            robots.setdefault(namespace, {}).setdefault(name, []).append(topic)
    return robots


def _choose(path: str, robots: Dict[str, Topics], wanted: str) -> str:
    """The namespace of the robot that is meant."""
    if wanted:
        names = ([name for name in robots if name.strip('/') == wanted.strip('/')]
                 or [name for name in robots if name.rpartition('/')[2] == wanted])
        if not names:
            raise ReportError(f'{path}: no robot {wanted!r}: there is {_listed(robots) or "none"}')
    else:
        names = [name for name, topics in robots.items() if not _lacks(topics)] or list(robots) or [f'/{FIRST}']
        names = [name for name in names if len(names) == 1 or name.rpartition('/')[2] == FIRST] or names
    if len(names) > 1:
        raise ReportError(f'{path}: several robots, choose one by --robot NAME: {_listed(names)}')
    return names[0]


def _check(path: str, name: str, topics: Topics, kinds: Dict[str, str]) -> None:
    lacks = _lacks(topics)
    if lacks:
        found = ', '.join(list(kinds)[:SHOWN]) + (', ...' if len(kinds) > SHOWN else '')
        wanted = ' '.join(f'{name}/{short}' for short in TYPES)
        raise ReportError(f'{path}: of the robot {_shown(name)} there is no {lacks}; found: {found or "no messages"}; '
                          f'record a mission by: rosbag record /map {wanted}')


def _lacks(topics: Topics) -> str:
    return ' and no '.join(' or '.join(either) for either in (PLACE, BATTERY) if not topics.keys() & set(either))


def _map_topics(kinds: Dict[str, str], robot: str) -> List[str]:
    """The map of the innermost of the robot's namespaces that has one."""
    maps = [(f'/{topic.strip("/")}'[:-len('map')], topic) for topic, kind in kinds.items()
            if kind == GRID and topic.rpartition('/')[2] == 'map']
    around = [(namespace, topic) for namespace, topic in maps if f'{robot}/'.startswith(namespace)]
    return [max(around, key=lambda pair: len(pair[0]))[1]] if around else []


def _shown(namespace: str) -> str:
    return namespace.strip('/') or '/'


def _listed(names: Iterable[str]) -> str:
    return ', '.join(map(_shown, names))
