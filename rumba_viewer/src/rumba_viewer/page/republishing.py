"""Transforms for clients, in the way of tf2_web_republisher: a client names frames, and hears whenever they have moved.

A client asks by the service `/republish_tfs`, whose answer names a topic, or by the action `/tf2_web_republisher`,
whose feedback it hears. Neither is in ROS: both belong to this page, and a client only gets what it asked for itself.
"""

import collections
import itertools
import math
from typing import Any, Callable, Deque, Dict, List, Tuple

from rumba_sim.model.common.errors import quoted
from rumba_viewer.page.feeds import Demand
from rumba_viewer.page.messages import operations
from rumba_viewer.page.messages.errors import Refusal
from rumba_viewer.page.messages.transforms import Transform, Tree

SOURCE = '/tf'  # whoever may subscribe to it may use all of this
SERVICE, SERVICE_TYPE = '/republish_tfs', 'tf2_web_republisher/RepublishTFs'
ACTION = '/tf2_web_republisher'
GOAL, CANCEL, STATUS, FEEDBACK, RESULT = (f'{ACTION}/{part}' for part in (
    'goal', 'cancel', 'status', 'feedback', 'result'))
TYPES = {GOAL: 'tf2_web_republisher/TFSubscriptionActionGoal', CANCEL: 'actionlib_msgs/GoalID',
         STATUS: 'actionlib_msgs/GoalStatusArray', FEEDBACK: 'tf2_web_republisher/TFSubscriptionActionFeedback',
         RESULT: 'tf2_web_republisher/TFSubscriptionActionResult'}
ANSWER = '/tf_repub_'  # with which the names of the topics for answers of the service begin
ACTIVE, PREEMPTED = 1, 2  # states of a goal: actionlib_msgs/GoalStatus
MOST_WANTED = 20  # that a client follows at the same time; of more, the oldest ends
MOST_FRAMES = 128  # of each
SLICE = 0.005  # [s] of a tick for all clients: what is left over is the first of the next tick
USUAL_RATE, HIGHEST_RATE = 10.0, 20.0  # [1/s]
Send = Callable[[Any, str, Demand, Any], None]  # a client, a topic, how it listens to it, and values


class Wanted:
    """Frames that a client follows.

    Attributes:
        client: who.
        topic: on which it gets them.
        goal: identity of its goal; None: it asked by the service.
        sources, target: frames, and the one in which it wants them.
        angle, distance: [rad], [m] by which one must have moved.
        period: [s] between two messages, at least.
        due: when the next message may come [s].
        sent: by frame.
    """

    def __init__(self, client: Any, topic: str, goal: Any, values: Any) -> None:
        """Follow what a request or a goal says."""
        self.client, self.topic, self.goal = client, topic, goal
        frames = values.get('source_frames', [])
        if not isinstance(frames, list) or len(frames) > MOST_FRAMES:
            raise Refusal(f'source_frames is {quoted(frames)}: must be a list of at most {MOST_FRAMES} frames')
        self.sources = [_frame('source_frames', one) for one in frames]
        self.target = _frame('target_frame', values.get('target_frame'))
        self.angle = operations.number(values, 'angular_thres')
        self.distance = operations.number(values, 'trans_thres')
        self.period = 1.0 / min(operations.number(values, 'rate') or USUAL_RATE, HIGHEST_RATE)
        self.due = 0.0
        self.sent: Dict[str, Transform] = {}

    def moved(self, tree: Tree) -> List[Dict[str, Any]]:
        """The frames that have moved, as messages `geometry_msgs/TransformStamped`."""
        found = []
        for source in self.sources:
            now, before = tree.between(self.target, source), self.sent.get(source)
            if now is not None and (before is None or math.dist(now.shift, before.shift) > self.distance
                                    or _angle(now, before) > self.angle):
                self.sent[source] = now
                found.append(_message(self.target, source, now))
        return found


class Republisher:
    """What all clients follow."""

    def __init__(self, send: Send, clock: Callable[[], float]) -> None:
        """Send messages by `send`; `clock` gives the time [s]."""
        self.tree = Tree()
        self._send, self._clock = send, clock
        self._numbers = itertools.count()
        self._wanted: Deque[Wanted] = collections.deque()
        self._listeners: Dict[Tuple[Any, str], Dict[Any, Demand]] = {}  # by client and topic: how, by reason

    @property
    def is_busy(self) -> bool:
        """Whether any client follows anything."""
        return bool(self._wanted)

    def answer(self, client: Any, values: Any) -> Dict[str, Any]:
        """The answer of the service."""
        topic = f'{ANSWER}{next(self._numbers)}'
        self._add(Wanted(client, topic, None, _object('args', values)))
        return {'topic_name': topic}

    def publish(self, client: Any, topic: str, values: Any) -> None:
        """Take a goal, or the end of one."""
        values = _object('msg', values)
        if topic == CANCEL:
            self._end(client, _identity(values))
            return
        goal = _identity(_object('goal_id', values.get('goal_id', {})))
        self._end(client, goal)
        self._add(Wanted(client, FEEDBACK, goal, _object('goal', values.get('goal'))))
        self._tell_status(client)

    def subscribe(self, client: Any, topic: str, reason: Any, demand: Demand) -> None:
        """Let a client listen to a topic; it gets all frames anew."""
        if topic.startswith(ANSWER) and not any(one.topic == topic for one in self._of(client)):
            raise Refusal(f'{topic} does not belong to this client: call {SERVICE} first')
        self._listeners.setdefault((client, topic), {})[reason] = demand
        for wanted in self._of(client):
            if wanted.topic == topic:
                wanted.sent.clear()
        if topic == STATUS:
            self._tell_status(client)

    def unsubscribe(self, client: Any, topic: str, reason: Any) -> None:
        """No longer send it; reason None: for no reason. What the client asked for by the service ends with it."""
        reasons = self._listeners.get((client, topic), {})
        if reason is not None:
            reasons.pop(reason, None)
        if reason is None or not reasons:
            self._listeners.pop((client, topic), None)
            self._wanted = collections.deque(
                one for one in self._wanted if one.client is not client or one.topic != topic)

    def leave(self, client: Any) -> None:
        """Forget a client."""
        self._wanted = collections.deque(one for one in self._wanted if one.client is not client)
        self._listeners = {key: value for key, value in self._listeners.items() if key[0] is not client}

    def tick(self, now: float) -> None:
        """Send what is due, to each client in its turn; the time is in seconds."""
        end = self._clock() + SLICE
        for _ in range(len(self._wanted)):
            wanted = self._wanted[0]
            self._wanted.rotate(-1)
            if now >= wanted.due and (wanted.client, wanted.topic) in self._listeners:
                wanted.due = max(wanted.due, now - wanted.period / 2) + wanted.period
                transforms = wanted.moved(self.tree)
                if transforms:
                    self._say(wanted.client, wanted.topic, {'transforms': transforms} if wanted.goal is None else {
                        'header': _header(), 'status': _status(wanted.goal, ACTIVE),
                        'feedback': {'transforms': transforms}})
                if self._clock() > end:
                    break

    def _add(self, wanted: Wanted) -> None:
        others = self._of(wanted.client)
        if len(others) >= MOST_WANTED:
            self._wanted.remove(others[0])
        self._wanted.append(wanted)

    def _of(self, client: Any) -> List[Wanted]:
        return [one for one in self._wanted if one.client is client]

    def _end(self, client: Any, goal: Any) -> None:
        """End a goal; without an id, all goals of the client, as actions do."""
        for wanted in self._of(client):
            if wanted.goal is not None and (not goal['id'] or wanted.goal['id'] == goal['id']):
                self._wanted.remove(wanted)
                self._say(client, RESULT, {'header': _header(), 'status': _status(wanted.goal, PREEMPTED),
                                           'result': {}})
        self._tell_status(client)

    def _tell_status(self, client: Any) -> None:
        goals = [one.goal for one in self._of(client) if one.goal is not None]
        self._say(client, STATUS, {'header': _header(), 'status_list': [_status(goal, ACTIVE) for goal in goals]})

    def _say(self, client: Any, topic: str, values: Any) -> None:
        demands = self._listeners.get((client, topic))
        if demands:
            self._send(client, topic, next(iter(demands.values())), values)


def is_ours(what: str, name: str) -> bool:
    """Whether something that is to be read, written or called is a topic or service of this module."""
    return (what == 'read' and (name.startswith(ANSWER) or name in (STATUS, FEEDBACK, RESULT))
            or what == 'write' and name in (GOAL, CANCEL) or what == 'call' and name == SERVICE)


def _frame(key: str, name: Any) -> str:
    if not isinstance(name, str) or not name.strip('/') or len(name) > operations.MOST_NAME:
        raise Refusal(f'{key}: {quoted(name)} is no frame: must be a name such as base_link')
    return name.lstrip('/')


def _object(key: str, values: Any) -> Dict[str, Any]:
    if not isinstance(values, dict):
        raise Refusal(f'{key} is {quoted(values)}: must be an object')
    return values


def _identity(values: Dict[str, Any]) -> Dict[str, Any]:
    name = values.get('id', '')
    if not isinstance(name, str):
        raise Refusal(f'id is {quoted(name)}: must be a text')
    return {'stamp': {'secs': 0, 'nsecs': 0}, 'id': name}


def _angle(one: Transform, other: Transform) -> float:
    """By how much frames are turned against each other [rad]."""
    product = sum(a * b for a, b in zip(one.turn, other.turn))
    return 2.0 * math.acos(min(abs(product), 1.0))


def _header(stamp: Tuple[int, int] = (0, 0), frame: str = '') -> Dict[str, Any]:
    return {'seq': 0, 'stamp': {'secs': stamp[0], 'nsecs': stamp[1]}, 'frame_id': frame}


def _status(goal: Dict[str, Any], state: int) -> Dict[str, Any]:
    return {'goal_id': goal, 'status': state, 'text': ''}


def _message(target: str, source: str, transform: Transform) -> Dict[str, Any]:
    return {'header': _header(transform.stamp, target), 'child_frame_id': source, 'transform': {
        'translation': dict(zip('xyz', transform.shift)), 'rotation': dict(zip('xyzw', transform.turn))}}
