"""check_robot: listens to a robot that is not ours, and prints what it lacks for the cleaner, and what would be right.

It subscribes to the topics that its parameters name, to /tf and /tf_static, and asks the master for their nodes. With
the parameter drive, it publishes velocities on the topic of cmd_vel: 35 cm ahead and back, a turn of 70 degrees and
back. After that it does not command a stop at once, to see whether the driver stops the robot. Put the robot where it
has half a metre of room. It ends with exit code 0 if the robot can be used, else with 1.

Parameters, as in `rosrun rumba_cleaning check_robot _own_robot:=my_robot.yaml _scan:=/front/laser _drive:=true`:
"""

import dataclasses
import sys
import time
from typing import Dict, List, Optional, Tuple

import rosgraph
import rospy
from geometry_msgs.msg import Twist, Vector3

from rumba_cleaning.own_robot.check import report, table
from rumba_cleaning.own_robot.gate import STOP, Velocity, limited
from rumba_cleaning.own_robot.heard import Heard, Topic
from rumba_cleaning.ros.own_robot.listeners import (
    CommandListener, ModeListener, OdometryListener, ScanListener, TopicListener)
from rumba_sim.model.common.config import setting
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.model.common.geometry import wrap_angle
from rumba_sim.model.settings.robot_config import DriveConfig
from rumba_sim.ros.common.own_robots import own_robot, own_robot_setting
from rumba_sim.ros.running import node

PERIOD = 0.02  # [s] of the wall clock between two looks
CLOCK_PATIENCE = 3.0  # [s] of the wall clock for which time may stand still
DRIVE = (  # for so long [s] with such velocities
    (2.3, Velocity(0.15, 0.0)), (2.3, Velocity(-0.15, 0.0)), (1.8, Velocity(0.0, 0.7)), (1.8, Velocity(0.0, -0.7)))
TURNED = 0.03  # [rad] in the rest of that time, from which on it has not
BEFORE = 0.5  # [s] of that, for the topics to connect
SILENT, STILL = 1.2, 0.9  # [s] after it without a command, and of that until the driver must have stopped the robot


@dataclasses.dataclass(frozen=True)
class Settings:
    """The node's private parameters: the topics are those of own_robot.launch."""

    own_robot: str = own_robot_setting()
    scan: str = setting('/scan', 'topic of its scan')
    odom: str = setting('/odom', 'topic of its odometry')
    cmd_vel: str = setting('/cmd_vel', 'topic of the velocity that it takes')
    battery_state: str = setting('/battery_state', 'topic of its charge')
    bumper: str = setting('/bumper', 'topic of its bumper')
    cliff: str = setting('/cliff', 'topic of its cliff sensors')
    wheel_drop: str = setting('/wheel_drop', 'topic that says whether a wheel hangs in the air')
    charging_state: str = setting('', 'topic of the charger of a Create; empty: it is another robot')
    mode: str = setting('', 'topic of the mode of a Create; empty: it is another robot')
    seconds: float = setting(10.0, 'how long it listens, by the clock of the robot', 's', 1.0, 600.0)
    drive: bool = setting(False, 'whether to drive the robot, so that scan, odometry and command can be compared')


def main() -> None:
    """Run the node."""
    found: List[bool] = []
    node.run('check_robot', Settings, lambda settings: found.append(_check(settings)))
    sys.exit(int(False in found))


def _check(settings: Settings) -> bool:
    """Print the table; returns whether the robot can be used.

    Raises:
        ConfigError: no file is named, or it is wrong.
    """
    own = own_robot(settings.own_robot)
    if own is None:
        raise ConfigError('own_robot is not given: must be the path of a YAML file that says what the robot is like')
    print(f'listens for {settings.seconds:g} s', flush=True)
    master = _Master()
    odometry = OdometryListener(settings.odom, own)
    scan = ScanListener(settings.scan, own, odometry)
    command = CommandListener(settings.cmd_vel, odometry)
    optional: Dict[str, TopicListener] = {
        name: TopicListener(getattr(settings, name))
        for name in ('battery_state', 'bumper', 'cliff', 'wheel_drop', 'charging_state') if getattr(settings, name)}
    mode = ModeListener(settings.mode) if settings.mode else None
    if mode is not None:
        optional['mode'] = mode
    drive = Driver(settings, own.config.drive)
    clock_fault = _listen(settings.seconds, drive)
    seen = master.look()
    found = report(Heard(
        settings.seconds, scan.topic(seen), odometry.topic(seen), command.topic(seen),
        {name: listener.topic(seen) for name, listener in optional.items()}, scan.heard(), odometry.heard(),
        scan.views(), seen.others(), odometry.map_odom(), clock_fault, _runs_on(drive, odometry),
        None if mode is None else mode.mode), own)
    print('\n'.join(table(found)), flush=True)
    rospy.signal_shutdown('done')
    return found.is_fit


def _runs_on(drive: 'Driver', odometry: OdometryListener) -> bool:
    """Whether the robot turned on when it was commanded nothing any more."""
    if drive.fell_silent is None:
        return False
    begin, end = (odometry.at(drive.fell_silent + after) for after in (STILL, SILENT - 0.1))
    return begin is not None and end is not None and abs(wrap_angle(end.theta - begin.theta)) > TURNED


def _listen(seconds: float, drive: 'Driver') -> str:
    """Return after some time of the robot; what is wrong with the clock, or an empty text."""
    begin = last = rospy.get_time()
    changed = time.monotonic()
    while not rospy.is_shutdown():
        now = rospy.get_time()
        if now != last:
            last, changed = now, time.monotonic()
            begin = begin or now
        if begin and now - begin >= seconds:
            break
        if time.monotonic() - changed > CLOCK_PATIENCE:
            drive.command(STOP)
            return 'the parameter /use_sim_time is true, but nothing came on /clock: rosparam set use_sim_time false'
        drive.step(now - begin if begin else 0.0)
        time.sleep(PERIOD)
    drive.command(STOP)
    return ''


class Driver:
    """Drives the robot, if it shall."""

    def __init__(self, settings: Settings, limits: DriveConfig) -> None:
        self._limits = limits
        self._publisher = rospy.Publisher(settings.cmd_vel, Twist, queue_size=1) if settings.drive else None
        self.fell_silent: Optional[float] = None  # [s]

    def step(self, passed: float) -> None:
        """Command what is due so long after the beginning [s]."""
        end = BEFORE
        for duration, velocity in DRIVE:
            if end <= passed < end + duration:
                self.command(limited(velocity, self._limits))
                return
            end += duration
        if not end <= passed < end + SILENT:
            self.command(STOP)
        elif self._publisher is not None and self.fell_silent is None:
            self.fell_silent = rospy.get_time()

    def command(self, velocity: Velocity) -> None:
        """Command a velocity."""
        if self._publisher is not None:
            self._publisher.publish(Twist(Vector3(velocity.v, 0.0, 0.0), Vector3(0.0, 0.0, velocity.w)))


class Seen:
    """What the master knows, but for this node."""

    def __init__(self, publishers: Dict[str, Tuple[str, ...]], subscribers: Dict[str, Tuple[str, ...]],
                 kinds: Dict[str, str]) -> None:
        self.publishers, self.subscribers, self.kinds = publishers, subscribers, kinds

    def topic(self, name: str, rate: float) -> Topic:
        """What is known of a topic, at which messages came at a rate [Hz]."""
        kind = self.kinds.get(name)
        return Topic(name, (kind,) if kind else (), self.publishers.get(name, ()), self.subscribers.get(name, ()), rate)

    def others(self) -> Dict[str, Tuple[str, ...]]:
        """Topics by their type: those that somebody publishes, or, of velocities, takes."""
        found: Dict[str, List[str]] = {}
        for name, kind in sorted(self.kinds.items()):
            if (self.subscribers if kind == 'geometry_msgs/Twist' else self.publishers).get(name):
                found.setdefault(kind, []).append(name)
        return {kind: tuple(names) for kind, names in found.items()}


class _Master:
    """Asks the master before this node has topics of its own, too: it keeps the types of topics."""

    def __init__(self) -> None:
        self._master = rosgraph.Master(rospy.get_name())
        self._kinds = self._types()

    def _types(self) -> Dict[str, str]:
        return {name: kind for name, kind in self._master.getTopicTypes() if kind != '*'}

    def look(self) -> Seen:
        """What it knows now."""
        publishers, subscribers, _ = ({name: tuple(each for each in nodes if each != rospy.get_name())
                                       for name, nodes in part} for part in self._master.getSystemState())
        return Seen(publishers, subscribers, {**self._types(), **self._kinds})
