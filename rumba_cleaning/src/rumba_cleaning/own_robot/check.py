"""What is needed of a robot, what was heard of it, what is wrong with that, and what would be right: a table."""

import math
import statistics
from typing import List, NamedTuple, Optional, Sequence

import numpy as np

from rumba_cleaning.own_robot.agreement import TURNS_BACK
from rumba_cleaning.own_robot.heard import Heard, OdometryHeard, ScanHeard, Topic
from rumba_cleaning.own_robot.inputs import READERS
from rumba_cleaning.own_robot.own_dock import PASSIVE
from rumba_cleaning.own_robot.views import can_tell, contradiction, has_driven, has_moved_by_scans
from rumba_sim.model.settings.own_robot import OwnRobot

MODE = ('create_msgs/Mode', 'ca_msgs/Mode')
SCAN, ODOMETRY, TWIST = 'sensor_msgs/LaserScan', 'nav_msgs/Odometry', 'geometry_msgs/Twist'
SLOWEST = 3.0  # [Hz] of scan and odometry: safe_drive stops the robot after 0.4 s without
LATE = 0.5  # [s] by which stamps may differ from the clock
LONGEST = 60.0  # [m] of half of the ranges: no laser that drives on a floor sees so far, but many see so in millimetres
FAR_TURN, FAR_WAY = 0.1, 0.05  # [rad], [m] by which file and tf may differ


class Row(NamedTuple):
    """A line of the table."""

    what: str
    is_needed: bool
    topic: Topic
    faults: List[str]


class Report(NamedTuple):
    """The table, and what it does not tell."""

    rows: List[Row]
    remarks: List[str]

    @property
    def is_fit(self) -> bool:
        """Whether nothing is wrong with what is needed."""
        return not any(row.faults for row in self.rows if row.is_needed)


def report(heard: Heard, own: OwnRobot) -> Report:
    """Look at what was heard of a robot."""
    rows = [Row('scan', True, heard.scan, _scan_faults(heard)),
            Row('odometry', True, heard.odom, _odometry_faults(heard, own)),
            Row('velocity command', True, heard.cmd_vel, _command_faults(heard))]
    rows += [Row(name, False, topic, _optional_faults(name, topic)) for name, topic in heard.optional.items()]
    return Report(rows, _remarks(heard))


def _remarks(heard: Heard) -> List[str]:
    remarks = []
    if heard.map_odom:
        remarks.append(f'{" and ".join(heard.map_odom)} publishes map -> odom: end it, or give localisation:=none')
    if heard.odometry_heard is None or heard.odometry_heard.contradiction or not heard.views:
        return remarks
    if not can_tell(heard.views):
        remarks.append('the robot stood still: whether scan and odometry agree was not tested: drive it by hand '
                       'meanwhile, or give _drive:=true, and it drives 35 cm ahead and back, and turns')
    elif not has_driven(heard.views):
        remarks.append('the robot only turned: whether the laser looks ahead was not tested')
    return remarks


# --- what comes -------------------------------------------------------------------------------------------------------

def _comes(topic: Topic, kind: str, argument: str, heard: Heard) -> List[str]:
    """Why nothing useful comes on a topic that must have a type."""
    others = [name for name in heard.others.get(kind, ()) if name != topic.name]
    hint = f': give {argument}:={others[0]}' if others else ''
    if not topic.publishers:
        return [f'nothing came on {topic.name}: no node publishes it{hint}']
    if topic.kinds != (kind,):
        return [f'{topic.name} has type {" and ".join(topic.kinds)}: must be {kind}{hint}']
    who = ' and '.join(topic.publishers)
    if not topic.rate:
        return [f'nothing came on {topic.name}, although {who} publishes it{hint}']
    faults = []
    if topic.rate < SLOWEST:
        faults.append(f'{topic.name} comes at {topic.rate:.1f} Hz: must be {SLOWEST:g} Hz or more')
    if len(topic.publishers) > 1:
        faults.append(f'{who} publish {topic.name}: must be one node')
    return faults


def _stamps(topic: Topic, ages: Sequence[float], heard: Heard) -> List[str]:
    if heard.clock_fault:
        return [heard.clock_fault]
    age = statistics.median(ages)
    if abs(age) <= LATE:
        return []
    return [f'{topic.name} has stamps {abs(age):.1f} s {"before" if age > 0 else "after"} the clock of this computer: '
            'must be the time of the measurement, by the same clock (chrony on both computers; use_sim_time as /clock)']


def _scan_faults(heard: Heard) -> List[str]:
    topic, scan = heard.scan, heard.scan_heard
    faults = _comes(topic, SCAN, 'scan', heard)
    if scan is None:
        return faults
    faults += _stamps(topic, scan.ages, heard) + _range_faults(topic, scan)
    if scan.mounting is None:
        faults.append(f'{topic.name} is in the frame {scan.frame}: {scan.fault}: have your robot publish that, or '
                      'write laser: {x: ..., y: ..., yaw: ...} into the file of the robot')
        return faults
    return faults + _mounting_faults(topic, scan) + _view_faults(heard, scan)


def _range_faults(topic: Topic, scan: ScanHeard) -> List[str]:
    echoes = scan.ranges[np.isfinite(scan.ranges) & (scan.ranges > 0.0)]
    if not len(echoes):
        return [f'{topic.name} has no range above 0: is the laser covered, or does it not turn?']
    if float(np.median(echoes)) > LONGEST:
        return [f'{topic.name} has ranges of {float(np.median(echoes)):.0f} m: must be metres, not millimetres']
    return []


def _mounting_faults(topic: Topic, scan: ScanHeard) -> List[str]:
    told, said = scan.by_tf, scan.mounting
    if told is None or said is None:
        return []
    turn = abs(math.remainder(told.yaw - said.yaw, 2.0 * math.pi))
    if turn <= FAR_TURN and max(abs(told.x - said.x), abs(told.y - said.y)) <= FAR_WAY and (
            told.upside_down is said.upside_down):
        return []
    return [f'the file has the laser at ({said.x:g}, {said.y:g}) m, {math.degrees(said.yaw):.0f} degrees, and tf at '
            f'({told.x:g}, {told.y:g}) m, {math.degrees(told.yaw):.0f} degrees: the file counts: correct it, or leave '
            'laser out of it']


def _view_faults(heard: Heard, scan: ScanHeard) -> List[str]:
    """What scans and odometry tell of the laser."""
    assert scan.mounting is not None
    found = contradiction(heard.views, scan.mounting)
    odometry = heard.odometry_heard
    if found is None or odometry is not None and odometry.contradiction:
        return []
    if found.mirrored and not (odometry is not None and odometry.is_tested):
        return [f'{heard.scan.name} turns the other way than the odometry: is the laser upside down, or its angles '
                'clockwise, or does the odometry turn the wrong way?']
    turned = f'by {math.degrees(found.turned):.0f} degrees' if abs(found.turned) > 1e-9 else ''
    what = ' and '.join(filter(None, ['upside down' if found.mirrored else '', turned and f'turned {turned}']))
    return [f'the laser is {what} against what {"the file" if scan.by_tf is not scan.mounting else "tf"} says, by how '
            'scans change while the odometry moves: correct its yaw, or upside_down']


# --- odometry and command -----------------------------------------------------------------------------------------

def _odometry_faults(heard: Heard, own: OwnRobot) -> List[str]:
    topic, odometry = heard.odom, heard.odometry_heard
    faults = _comes(topic, ODOMETRY, 'odom', heard)
    if odometry is None:
        return faults
    faults += _stamps(topic, odometry.ages, heard) + _frame_faults(topic, odometry, own)
    if not odometry.is_valid:
        faults.append(f'{topic.name} has numbers that make no pose: must be finite, with a quaternion of norm 1')
    if odometry.contradiction == TURNS_BACK:
        faults.append(f'{topic.name}: {odometry.contradiction}: is a wheel, or an axis, reversed?')
    elif odometry.contradiction:
        faults.append(f'{topic.name}: {odometry.contradiction}')
    elif not can_tell(heard.views) and has_moved_by_scans(heard.views):
        faults.append(f'{topic.name}: odometry does not move although the scan does')
    return faults


def _frame_faults(topic: Topic, odometry: OdometryHeard, own: OwnRobot) -> List[str]:
    faults = []
    if odometry.frame != own.frames.odom.lstrip('/'):
        faults.append(f'{topic.name} is in the frame {odometry.frame or "of no name"}, and the file says '
                      f'{own.frames.odom}: write frames: {{odom: {odometry.frame or own.frames.odom}}} into it')
    if not odometry.is_linked:
        faults.append(f'{topic.name} is of the frame {odometry.child}, and the file says {own.frames.base}, to which '
                      f'no transforms lead: write frames: {{base: {odometry.child}}} into it')
    return faults


def _command_faults(heard: Heard) -> List[str]:
    topic = heard.cmd_vel
    faults = []
    if not topic.subscribers:
        others = [name for name in heard.others.get(TWIST, ()) if name != topic.name]
        faults.append(f'no node takes {topic.name}' + (f': give cmd_vel:={others[0]}' if others else ''))
    elif topic.kinds and topic.kinds != (TWIST,):
        faults.append(f'{topic.name} has type {" and ".join(topic.kinds)}: must be {TWIST}')
    if heard.mode is not None and heard.mode <= PASSIVE:
        faults.append(f'the robot is in passive mode and obeys nobody: it docks, charges or sleeps: have it obey with '
                      f'rostopic pub -1 {_undock(heard)} std_msgs/Empty; create.launch does so by itself')
    if heard.runs_on:
        faults.append(f'the robot drove on for a second after the last {topic.name}: its driver must stop the motors '
                      'if commands stay away, since nothing else can if the connection is lost')
    if topic.publishers:
        faults.append(f'{" and ".join(topic.publishers)} publish{"es" if len(topic.publishers) == 1 else ""} '
                      f'{topic.name} too: the robot would obey both: end it, or have it publish rumba/teleop/cmd_vel, '
                      'which goes before the cleaner')
    return faults


def _undock(heard: Heard) -> str:
    """The topic of create_driver beside that of its mode that has a Create obey."""
    return f'{heard.optional["mode"].name.rsplit("/", 1)[0]}/undock'


def _optional_faults(name: str, topic: Topic) -> List[str]:
    known = READERS.get(name, MODE)
    wrong = [kind for kind in topic.kinds if kind not in known]
    return [f'{topic.name} has type {wrong[0]}: ignored, since it must be one of {", ".join(known)}'] if wrong else []


# --- the table --------------------------------------------------------------------------------------------------------

HEADS = 'what', 'need', 'topic', 'heard', 'from or to'


def table(found: Report) -> List[str]:
    """The lines to print."""
    cells = [HEADS] + [_cells(row) for row in found.rows]
    widths = [max(len(line[column]) for line in cells) for column in range(len(HEADS))]
    lines = ['  '.join(text.ljust(width) for text, width in zip(line, widths)).rstrip() for line in cells]
    faults = [fault for row in found.rows for fault in row.faults]
    lines += [f'wrong: {fault}' for fault in dict.fromkeys(faults)] + [f'note: {each}' for each in found.remarks]
    return [*lines, 'the robot can be used' if found.is_fit else 'the robot cannot be used yet']


def _cells(row: Row) -> Sequence[str]:
    topic = row.topic
    nodes: Optional[Sequence[str]] = topic.publishers
    heard = f'{topic.rate:.1f} Hz' if topic.rate else 'nothing'
    if row.what == 'velocity command':
        nodes, heard = topic.subscribers, 'taken' if topic.subscribers else 'taken by nobody'
    return (row.what, 'needed' if row.is_needed else 'optional', topic.name, heard, ', '.join(nodes or ('nobody',)))
