"""Goals of actions as a client sends them, and that they end."""

import contextlib
import itertools
import time

import roslib.message
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray

from rumba_msg.msg import MissionStatus
from stress import wire
from stress.failure import Failure

ACTIONS = {'clean': 'Clean', 'dock': 'Dock', 'undock': 'Undock', 'go_to': 'GoTo'}
STANDS_STILL = (MissionStatus.IDLE, MissionStatus.STRANDED)
ENDED_WITHIN = 20.0  # [s] after a cancel
NOT_ENDED = tuple(getattr(GoalStatus, name) for name in ('PENDING', 'ACTIVE', 'PREEMPTING', 'RECALLING'))
NUMBERS = itertools.count(1)


def kind(action, part):
    """A class of messages of an action: `ActionGoal`, `ActionResult` or `Goal`."""
    return roslib.message.get_message_class(f'rumba_msg/{ACTIONS[action]}{part}')


class Client:
    """A client of one action of the robot `rumba`, connected both ways.

    Attributes:
        sent: ids of the goals without a result.
        results: results by id.
    """

    def __init__(self, ground, action, results, goals):
        """Take a subscription to results and the socket on which goals are sent."""
        self._action, self._subscription, self._socket = action, results, goals
        self._ground = ground
        self.sent, self.results = [], {}

    def send(self, **fields):
        """Send a goal with these fields; returns its id."""
        number = f'stress-{next(NUMBERS)}'
        message = kind(self._action, 'ActionGoal')()
        message.goal_id.id = number
        for name, value in fields.items():
            setattr(message.goal, name, value)
        self.sent.append(number)
        try:
            self._socket.sendall(wire.frame(wire.serialized(message)))
        except OSError as error:
            raise wire.WireError(f'the cleaner has closed its connection: {error}') from error
        return number

    def await_results(self, within):
        """Wait until each goal that was sent has its result.

        Raises:
            Failure: one has not, after so many seconds.
        """
        end = time.monotonic() + within
        while self.sent:
            try:
                result = self._subscription.next(max(end - time.monotonic(), 0.001))
            except wire.WireError as error:
                raise Failure('goal', self._ground.cleaner.name, f'no result of {len(self.sent)} goals of '
                              f'{self._action} after {within:g} s: {error}') from error
            if result.status.goal_id.id in self.sent:
                self.sent.remove(result.status.goal_id.id)
                self.results[result.status.goal_id.id] = result


@contextlib.contextmanager
def client(ground, action):
    """A client, as long as the block.

    Raises:
        wire.WireError: the cleaner does not serve the action.
    """
    prefix = f'/rumba/{action}'
    with ground.listen(f'{prefix}/result', kind(action, 'ActionResult'), ground.cleaner) as results, \
            ground.publishers.publish(ground.uri, f'{prefix}/goal', kind(action, 'ActionGoal'),
                                      wanted=ground.cleaner.name) as connections:
        connection = dict(connections).get(ground.cleaner.name)  # others, such as a viewer, may listen too
        if connection is None:
            raise Failure('goal', ground.cleaner.name, f'does not subscribe to {prefix}/goal')
        connection.sendall(wire.greeting(kind(action, 'ActionGoal')))
        yield Client(ground, action, results, connection)


def keep_busy(ground):
    """Send a goal of clean if the robot has nothing to do, so that blows meet it at work."""
    if ground.read('/rumba/mission_status', MissionStatus, ground.cleaner).state in STANDS_STILL:
        with client(ground, 'clean') as cleaning:
            cleaning.send()


def cancel_all(ground):
    """Cancel every goal of every action, all of which must end.

    Raises:
        Failure: one does not.
    """
    for action in ACTIONS:
        with ground.publishers.publish(ground.uri, f'/rumba/{action}/cancel', GoalID) as connections:
            for _, connection in connections:
                with contextlib.suppress(OSError):
                    connection.sendall(wire.greeting(GoalID) + wire.frame(wire.serialized(GoalID())))
            _await_end(ground, action)


def _await_end(ground, action):
    """Wait until no goal of an action is pending or active."""
    end = time.monotonic() + ENDED_WITHIN
    with ground.listen(f'/rumba/{action}/status', GoalStatusArray, ground.cleaner) as statuses:
        while True:
            left = [status.goal_id.id for status in statuses.next().status_list if status.status in NOT_ENDED]
            if not left:
                return
            if time.monotonic() > end:
                raise Failure('goal', ground.cleaner.name, f'{ENDED_WITHIN:g} s after a cancel, {len(left)} goals of '
                              f'{action} have not ended')
