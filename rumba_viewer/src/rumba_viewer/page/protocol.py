"""One client's session in rosbridge's protocol, version 2: operations in JSON come in, operations go out.

What is asked of ROS goes to a `Ros`; this module knows names, rights and bounds.
"""

import abc
import json
import re
from typing import Any, Callable, Dict, List, Optional, Set

from rumba_sim.model.errors import quoted
from rumba_viewer.page.allow_list import AllowList, Rights
from rumba_viewer.page.errors import Hostile, Refusal
from rumba_viewer.page.feeds import Demand

LEVELS = ('none', 'error', 'warning', 'info')
COMPRESSIONS = ('none', 'png')
API = '/rosapi/'  # below it, services tell about the graph
MOST_TOPICS = 128  # that a client listens to, and that it publishes to
MOST_NAME = 255  # characters
LONGEST_THROTTLE = 3600.0  # [s]
NAME = re.compile(r'/[A-Za-z]\w*(/[A-Za-z]\w*)*', re.ASCII)
TYPE = re.compile(r'[A-Za-z]\w*/[A-Za-z]\w*', re.ASCII)
Reply = Callable[[Dict[str, Any]], None]
Operation = Dict[str, Any]


class Ros(abc.ABC):
    """What a session asks of ROS; each method may raise a Refusal. `client` identifies the client."""

    @abc.abstractmethod
    def subscribe(self, client: Any, topic: str, reason: Any, demand: Demand) -> None:
        """Send the messages of a topic to a client."""

    @abc.abstractmethod
    def unsubscribe(self, client: Any, topic: str, reason: Any) -> None:
        """No longer send them; reason None: for no reason."""

    @abc.abstractmethod
    def advertise(self, client: Any, topic: str, kind: Optional[str], latch: bool) -> None:
        """Prepare to publish messages of a type; None: that which the topic has."""

    @abc.abstractmethod
    def unadvertise(self, client: Any, topic: str) -> None:
        """The client no longer publishes."""

    @abc.abstractmethod
    def publish(self, client: Any, topic: str, values: Any) -> None:
        """Publish a message with these values on a topic that the client has advertised."""

    @abc.abstractmethod
    def call(self, client: Any, service: str, values: Any, done: Callable[[bool, Any], None]) -> None:
        """Call a service; `done` gets whether it worked, and the values of the answer or a line that says why not."""


class Session:
    """What one client has asked for."""

    def __init__(self, ros: Ros, allowed: AllowList, rights: Rights, namespace: str, client: Any, reply: Reply,
                 note: Callable[[str], Any] = lambda _: None) -> None:
        """Serve a client; `reply` sends it an operation, `note` gets a line about each refusal."""
        self._ros, self._allowed, self._rights, self._namespace = ros, allowed, rights, namespace
        self._client, self._reply, self._note = client, reply, note
        self._level = LEVELS.index('error')
        self._listens: Dict[str, Set[Any]] = {}  # ids by topic
        self._publishes: Dict[str, List[Any]] = {}
        self._operations: Dict[str, Callable[[Operation], None]] = {
            'advertise': self._advertise, 'unadvertise': self._unadvertise, 'publish': self._publish,
            'subscribe': self._subscribe, 'unsubscribe': self._unsubscribe, 'call_service': self._call,
            'set_level': self._set_level, 'status': lambda _: None}

    def receive(self, text: Any) -> None:
        """Carry out an operation.

        Raises:
            Hostile: it is none; no client library sends such a thing.
        """
        try:
            operation = json.loads(text)
        except (ValueError, RecursionError):
            raise Hostile(f'{quoted(_shown(text))} is no JSON') from None
        if not isinstance(operation, dict) or not isinstance(operation.get('op'), str):
            raise Hostile('an operation must be a JSON object with the text "op"')
        act = self._operations.get(operation['op'])
        try:
            if act is None:
                raise Refusal(f'unknown operation {quoted(operation["op"])}: this server knows '
                              + ', '.join(sorted(self._operations)))
            act(operation)
        except Refusal as refusal:
            self.refuse(str(refusal), operation.get('id'))

    def refuse(self, line: str, reason: Any = None) -> None:
        """Say that something is not carried out, and why."""
        self._note(line)
        self.tell('error', line, reason)

    def tell(self, level: str, line: str, reason: Any = None) -> None:
        """Send the client a status, if it wants to hear of such."""
        if LEVELS.index(level) <= self._level:
            status = {'op': 'status', 'level': level, 'msg': line}
            self._reply(status if reason is None else {**status, 'id': reason})

    def close(self) -> None:
        """Give back all that the client has asked for."""
        for topic in self._listens:
            self._ros.unsubscribe(self._client, topic, None)
        for topic in self._publishes:
            self._ros.unadvertise(self._client, topic)
        self._listens, self._publishes = {}, {}

    # --- operations ---------------------------------------------------------------------------------------------------

    def _subscribe(self, operation: Operation) -> None:
        topic = self._name(operation, 'topic')
        self._allowed.robot('read', topic)
        if topic not in self._listens and len(self._listens) >= MOST_TOPICS:
            raise Refusal(f'a client can subscribe to {MOST_TOPICS} topics at most')
        reason = _id(operation)
        if len(self._listens.get(topic, ())) >= MOST_TOPICS:
            raise Refusal(f'{topic} has {MOST_TOPICS} subscriptions of this client already')
        compression = _one(operation, 'compression', COMPRESSIONS, 'none')
        demand = Demand(min(_number(operation, 'throttle_rate') / 1000.0, LONGEST_THROTTLE),
                        int(_number(operation, 'queue_length')), compression == 'png', operation['topic'],
                        operation.get('newest') is True)
        self._ros.subscribe(self._client, topic, reason, demand)
        self._listens.setdefault(topic, set()).add(reason)

    def _unsubscribe(self, operation: Operation) -> None:
        topic, reason = self._name(operation, 'topic'), _id(operation)
        reasons = self._listens.get(topic, set())
        if 'id' not in operation:
            reasons.clear()
        reasons.discard(reason)
        self._ros.unsubscribe(self._client, topic, reason if reasons else None)
        if not reasons:
            self._listens.pop(topic, None)

    def _advertise(self, operation: Operation) -> None:
        topic, kind = self._changed('write', operation, 'topic'), operation.get('type')
        if not isinstance(kind, str) or not TYPE.fullmatch(kind):
            raise Refusal(f'type is {quoted(kind)}: must be the type of a message, such as std_msgs/String')
        self._prepare(topic, kind, operation)

    def _prepare(self, topic: str, kind: Optional[str], operation: Operation) -> None:
        reasons = self._publishes.get(topic, [])
        if len(self._publishes) + len(reasons) >= MOST_TOPICS:
            raise Refusal(f'a client can advertise {MOST_TOPICS} topics at most')
        if kind is not None or not reasons:
            self._ros.advertise(self._client, topic, kind, operation.get('latch') is True)
        self._publishes.setdefault(topic, []).append(_id(operation))

    def _unadvertise(self, operation: Operation) -> None:
        topic, reason = self._name(operation, 'topic'), _id(operation)
        reasons = self._publishes.get(topic, [])
        if 'id' not in operation:
            reasons.clear()
        if reason in reasons:
            reasons.remove(reason)
        if not reasons and self._publishes.pop(topic, None) is not None:
            self._ros.unadvertise(self._client, topic)

    def _publish(self, operation: Operation) -> None:
        topic = self._changed('write', operation, 'topic')
        if topic not in self._publishes:
            self._prepare(topic, None, operation)
        self._ros.publish(self._client, topic, operation.get('msg', {}))

    def _call(self, operation: Operation) -> None:
        answer = {'op': 'service_response', 'service': operation.get('service')}
        if 'id' in operation:
            answer['id'] = operation['id']

        def done(worked: bool, values: Any) -> None:
            if not worked:
                self._note(str(values))
            self._reply({**answer, 'values': values, 'result': worked})
        try:
            service = self._name(operation, 'service')
            if not service.startswith(API):
                self._changed('call', operation, 'service')
            self._ros.call(self._client, service, operation.get('args', {}), done)
        except Refusal as refusal:
            done(False, str(refusal))

    def _set_level(self, operation: Operation) -> None:
        self._level = LEVELS.index(_one(operation, 'level', LEVELS, 'error'))

    # --- names and rights ---------------------------------------------------------------------------------------------

    def _name(self, operation: Operation, key: str) -> str:
        """The full name of a topic or service."""
        name = operation.get(key)
        full = name if not isinstance(name, str) or name.startswith('/') else self._namespace + name
        if not isinstance(full, str) or len(full) > MOST_NAME or not NAME.fullmatch(full):
            raise Refusal(f'{key} is {quoted(name)}: must be a name such as /rumba/scan')
        return full

    def _changed(self, what: str, operation: Operation, key: str) -> str:
        """The name of something that is written or called, if this client may do so."""
        name = self._name(operation, key)
        robot = self._allowed.robot(what, name)
        if not self._rights.may_change(robot):
            raise Refusal(f'{name} needs {"the token of " + robot + " or that" if robot else "the token"} of the '
                          'whole page: yours permits less' if self._rights.robots else
                          f'{name} needs a token: without one you can only watch')
        return name


def _id(operation: Operation) -> Any:
    """What tells apart several subscriptions to one topic."""
    found = operation.get('id')
    if found is not None and not isinstance(found, (str, int)):
        raise Refusal(f'id is {quoted(found)}: must be a text')
    return '' if found is None else found


def _number(operation: Operation, key: str) -> float:
    """A number that is not negative."""
    value = operation.get(key, 0)
    if value is None:
        return 0.0
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 <= value <= 1e9:
        raise Refusal(f'{key} is {quoted(value)}: must be a number from 0 to 1e9')
    return float(value)


def _one(operation: Operation, key: str, known: Any, default: str) -> str:
    value = operation.get(key, default)
    if value not in known:
        raise Refusal(f'{key} is {quoted(value)}: must be one of {", ".join(known)}')
    return str(value)


def _shown(text: Any) -> str:
    return text if isinstance(text, str) else repr(text)
