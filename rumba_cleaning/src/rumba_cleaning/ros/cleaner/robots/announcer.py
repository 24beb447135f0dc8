"""Tells what a robot does: programs by mission_status, people by the log."""

import itertools
import sys
from typing import Optional

import rospy

from rumba_cleaning.mission.stages import State
from rumba_cleaning.ros.cleaner.robots import conversions
from rumba_msg.msg import MissionStatus
from rumba_sim.model.common.errors import WorldError
from rumba_sim.ros.running import master_watch, peers
from rumba_sim.ros.running.terminal import TO_LINE_START_AND_ERASE

WORDS = {
    State.UNDOCKING: 'undocking', State.CLEANING: 'cleaning', State.RETURNING: 'going home', State.DOCKING: 'docking',
    State.CHARGING: 'charging', State.GOING_TO: 'on the way', State.STRANDED: 'stranded',
    State.YIELDING: 'yielding: a person drives'}

TOPIC = 'mission_status'  # below the robot's name; only its cleaner publishes it


class Announcer:
    """Publishes mission_status at each change of state or strategy, and whenever that is due.

    Attributes:
        status: what was published last.
    """

    def __init__(self, robot: str) -> None:
        """Speak for a robot, by its name, which is idle.

        Raises:
            WorldError: another cleaner does so already.
        """
        self._robot = robot
        self._publisher = rospy.Publisher(f'{robot}/{TOPIC}', MissionStatus, queue_size=10, latch=True)
        refuse_second(robot)
        master_watch.before_return(lambda: refuse_second(robot))
        self._publish(conversions.mission_status(State.IDLE, '', 'waits for a goal', rospy.Time.now()))

    def tell(self, state: State, strategy: str, message: str, stamp: Optional[rospy.Time], is_due: bool) -> None:
        """Publish if state or strategy is new, or a message is due."""
        is_new = (int(state), strategy) != (self.status.state, self.status.strategy)
        if is_new and state in WORDS:
            self.say(WORDS[state] + (f' by {strategy}' if state is State.CLEANING else ''))
        if is_new or is_due:
            self._publish(conversions.mission_status(state, strategy, message, stamp or rospy.Time.now()))

    def welcome(self, stamp: rospy.Time) -> None:
        """Tell that there are readings again, of a robot whose last goal has ended because there were none."""
        self.say('the robot is back')
        self.tell(State.IDLE, '', 'the robot is back, and waits for a goal', stamp, is_due=True)

    def say(self, text: str) -> None:
        """Log a line; erases what battery_status_listener may have left on the line of a terminal that both use."""
        if sys.stdout.isatty():
            print(TO_LINE_START_AND_ERASE, end='', flush=True)
        rospy.loginfo(f'{self._robot}: {text}')

    def _publish(self, status: MissionStatus) -> None:
        self.status = status
        self._publisher.publish(status)


def refuse_second(robot: str) -> None:
    """Refuse to work beside another cleaner of the same robot: both would drive it.

    The master keeps publishers in the order in which they came: of two that start at once, the first one stays.

    Raises:
        WorldError: there is another one.
    """
    topic = rospy.resolve_name(f'{robot}/{TOPIC}')
    for other in itertools.takewhile(lambda name: name != rospy.get_name(), peers.publishers(topic)):
        if peers.is_alive(other):
            raise WorldError(f'robot {robot!r} has a cleaner already: {other} publishes {topic}: end it first, or name '
                             'another robot: _robot:=rumba2')
