"""One client's session in rosbridge's protocol, version 2: operations in JSON come in, operations go out.

What is asked of ROS goes to a `Ros`; this module knows names, rights and bounds.
"""

import json
from typing import Any, Callable, Dict, List, Optional, Set

from rumba_sim.model.common.errors import quoted
from rumba_viewer.page import republishing
from rumba_viewer.page.allow_list import AllowList, Rights
from rumba_viewer.page.feeds import Demand
from rumba_viewer.page.messages import operations
from rumba_viewer.page.messages.errors import Hostile, Refusal
from rumba_viewer.page.messages.operations import Operation
from rumba_viewer.page.ros import Ros

LEVELS = ('none', 'error', 'warning', 'info')
COMPRESSIONS = ('none', 'png', 'cbor', 'cbor-raw')
API = '/rosapi/'  # below it, services tell about the graph
RIGHTS = API + 'rights'  # tells a client what it may change
PARAMETERS = {'get_param': 'get', 'has_param': 'get', 'set_param': 'set', 'delete_param': 'set'}  # of the API: rights
MOST_TOPICS = 128  # that a client listens to, and that it publishes to; and services that it serves
LONGEST_THROTTLE = 3600.0  # [s]
LONGEST_WAIT = 3600.0  # [s] for an answer, if a client wants to wait for a limited time
NOT_OFFERED = {
    'fragment': 'send the message whole: it may have as many bytes as the parameter size says',
    'png': 'send the message without compression',
    'auth': 'open the connection with ?token=TOKEN in its address',
    **{name: 'ROS 1 has actions as topics: goal, cancel, status, feedback and result' for name in (
        'advertise_action', 'unadvertise_action', 'send_action_goal', 'cancel_action_goal', 'action_feedback',
        'action_result')}}
Reply = Callable[[Dict[str, Any]], None]


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
        self._serves: Set[str] = set()
        self._operations: Dict[str, Callable[[Operation], None]] = {
            'advertise': self._advertise, 'unadvertise': self._unadvertise, 'publish': self._publish,
            'subscribe': self._subscribe, 'unsubscribe': self._unsubscribe, 'call_service': self._call,
            'advertise_service': self._serve, 'unadvertise_service': self._unserve, 'service_response': self._respond,
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
        reason = operation.get('id')
        try:
            self._carry_out(operation)
        except Refusal as refusal:
            self.refuse(str(refusal), reason if operations.can_be_id(reason) else None)

    def refuse(self, line: str, reason: Any = None) -> None:
        """Say that something is not carried out, and why."""
        self._note(line)
        self.tell('error', line, reason)

    def _carry_out(self, operation: Operation) -> None:
        name = operation['op']
        if name in NOT_OFFERED:
            raise Refusal(f'{name} is not offered here: {NOT_OFFERED[name]}')
        act = self._operations.get(name)
        if act is None:
            raise Refusal(f'unknown operation {quoted(name)}: this server knows ' + ', '.join(sorted(self._operations)))
        act(operation)

    def tell(self, level: str, line: str, reason: Any = None) -> None:
        """Send the client a status, if it wants to hear of such."""
        if LEVELS.index(level) <= self._level:
            status = {'op': 'status', 'level': level, 'msg': line}
            self._reply(status if reason is None else {**status, 'id': reason})

    def lose(self, topic: str) -> None:
        """No longer get the messages of a topic: there are too many topics, and others listen to less."""
        if self._listens.pop(topic, None) is not None:
            self._ros.unsubscribe(self._client, topic, None)
            self.refuse(f'{topic} is no longer sent: the clients of this page listen to too many topics, you to most')

    def close(self) -> None:
        """Give back all that the client has asked for."""
        for topic in self._listens:
            self._ros.unsubscribe(self._client, topic, None)
        for topic in self._publishes:
            self._ros.unadvertise(self._client, topic)
        for service in self._serves:
            self._ros.unserve(self._client, service)
        self._ros.leave(self._client)
        self._listens, self._publishes, self._serves = {}, {}, set()

    # --- topics -------------------------------------------------------------------------------------------------------

    def _subscribe(self, operation: Operation) -> None:
        topic = self._name(operation, 'topic')
        self._robot('read', topic)
        if topic not in self._listens and len(self._listens) >= MOST_TOPICS:
            raise Refusal(f'a client can subscribe to {MOST_TOPICS} topics at most')
        reason = operations.reason(operation)
        if len(self._listens.get(topic, ())) >= MOST_TOPICS:
            raise Refusal(f'{topic} has {MOST_TOPICS} subscriptions of this client already')
        demand = Demand(min(operations.number(operation, 'throttle_rate') / 1000.0, LONGEST_THROTTLE),
                        int(operations.number(operation, 'queue_length')),
                        operations.one(operation, 'compression', COMPRESSIONS, 'none'), operation['topic'],
                        operation.get('newest') is True)
        self._ros.subscribe(self._client, topic, reason, demand)
        self._listens.setdefault(topic, set()).add(reason)
        self._warn_of_ignored(operation, 'fragment_size')
        wanted, known = operation.get('type'), self._ros.kind(topic)
        if wanted is not None and known and wanted != known:
            self.tell('warning', f'{topic} has the type {known} and not {quoted(wanted)}', operation.get('id'))

    def _unsubscribe(self, operation: Operation) -> None:
        topic, reason = self._name(operation, 'topic'), operations.reason(operation)
        reasons = self._listens.get(topic)
        if reasons is None:
            self.tell('warning', f'this client has not subscribed to {topic}', operation.get('id'))
            return
        if 'id' not in operation:
            reasons.clear()
        reasons.discard(reason)
        self._ros.unsubscribe(self._client, topic, reason if reasons else None)
        if not reasons:
            del self._listens[topic]

    def _advertise(self, operation: Operation) -> None:
        topic = self._changed('write', operation, 'topic')
        self._prepare(topic, operations.kind(operation, 'message, such as std_msgs/String'), operation)

    def _prepare(self, topic: str, kind: Optional[str], operation: Operation) -> None:
        reason, reasons = operations.reason(operation), self._publishes.get(topic, [])
        if len(self._publishes) + len(reasons) >= MOST_TOPICS:
            raise Refusal(f'a client can advertise {MOST_TOPICS} topics at most')
        if kind is not None or not reasons:
            self._ros.advertise(self._client, topic, kind, operation.get('latch') is True)
        self._publishes.setdefault(topic, []).append(reason)

    def _unadvertise(self, operation: Operation) -> None:
        topic, reason = self._name(operation, 'topic'), operations.reason(operation)
        reasons = self._publishes.get(topic)
        if reasons is None:
            self.tell('warning', f'this client has not advertised {topic}', operation.get('id'))
            return
        if 'id' not in operation:
            reasons.clear()
        if reason in reasons:
            reasons.remove(reason)
        if not reasons:
            del self._publishes[topic]
            self._ros.unadvertise(self._client, topic)

    def _publish(self, operation: Operation) -> None:
        topic = self._changed('write', operation, 'topic')
        if topic not in self._publishes:
            self._prepare(topic, None, operation)
        self._ros.publish(self._client, topic, operation.get('msg', {}))

    # --- services -----------------------------------------------------------------------------------------------------

    def _call(self, operation: Operation) -> None:
        operations.reason(operation)
        if not isinstance(operation.get('service'), str):
            self._name(operation, 'service')  # cannot be repeated in an answer
        answer = {'op': 'service_response', 'service': operation['service']}
        if 'id' in operation:
            answer['id'] = operation['id']

        def done(worked: bool, values: Any) -> None:
            if not worked:
                self._note(str(values))
            self._reply({**answer, 'values': values, 'result': worked})
        try:
            service, values = self._name(operation, 'service'), operation.get('args', {})
            if service == RIGHTS:
                done(True, {'everything': self._rights.everything, 'robots': sorted(self._rights.robots)})
                return
            if service.startswith(API):
                values = self._with_full_name(service[len(API):], values)
            else:
                self._changed('call', operation, 'service')
            timeout = min(operations.number(operation, 'timeout'), LONGEST_WAIT)
            self._warn_of_ignored(operation, 'fragment_size', 'compression')
            self._ros.call(self._client, service, values, done, timeout)
        except Refusal as refusal:
            done(False, str(refusal))

    def _with_full_name(self, name: str, values: Any) -> Any:
        """The values for a service of the API, with the full name of a parameter that this client may use."""
        right = PARAMETERS.get(name)
        if right is None:
            return values
        if not isinstance(values, dict):
            raise Refusal(f'args is {quoted(values)}: must be an object with the name of a parameter')
        parameter = self._name(values, 'name')
        if right == 'set':
            self._changed(right, values, 'name')
        else:
            self._allowed.robot(right, parameter)
        return {**values, 'name': parameter}

    def _serve(self, operation: Operation) -> None:
        service = self._changed('serve', operation, 'service')
        kind, reason = operations.kind(operation, 'service, such as std_srvs/Trigger'), operation.get('id')
        if len(self._serves) >= MOST_TOPICS:
            raise Refusal(f'a client can serve {MOST_TOPICS} services at most')

        def ask(request: str, values: Any) -> None:
            self._reply({'op': 'call_service', 'id': request, 'service': operation['service'], 'args': values})

        def tell(level: str, line: str) -> None:
            if level == 'error':
                self._serves.discard(service)
                self.refuse(line, reason)
            else:
                self.tell(level, line, reason)
        operations.reason(operation)
        self._ros.serve(self._client, service, kind, ask, tell)
        self._serves.add(service)

    def _unserve(self, operation: Operation) -> None:
        service = self._name(operation, 'service')
        if service not in self._serves:
            raise Refusal(f'this client does not serve {service}')
        self._serves.discard(service)
        self._ros.unserve(self._client, service)

    def _respond(self, operation: Operation) -> None:
        """Take an answer: it worked if the client says so by `result`, or by values, which roslibpy's examples do."""
        service, values = self._name(operation, 'service'), operation.get('values')
        if service not in self._serves:
            raise Refusal(f'this client does not serve {service}')
        worked = bool(operation.get('result', 'values' in operation) or isinstance(values, dict) and values)
        self._ros.answer(self._client, service, operations.reason(operation), worked, values)

    # --- the rest -----------------------------------------------------------------------------------------------------

    def _set_level(self, operation: Operation) -> None:
        self._level = LEVELS.index(operations.one(operation, 'level', LEVELS, 'error'))

    def _warn_of_ignored(self, operation: Operation, *keys: str) -> None:
        for key in keys:
            if operation.get(key, 'none') not in ('none', None):
                self.tell('warning', f'{key} is ignored here', operation.get('id'))

    def _name(self, operation: Operation, key: str) -> str:
        """The full name of a topic, service or parameter."""
        return operations.name(operation, key, self._namespace)

    def _robot(self, what: str, name: str) -> Optional[str]:
        """The robot to which a name belongs, None if to none; what follows frames is allowed if their source is."""
        if republishing.is_ours(what, name):
            what, name = 'read', republishing.SOURCE
        return self._allowed.robot(what, name)

    def _changed(self, what: str, operation: Operation, key: str) -> str:
        """The name of something that is changed, if this client may do so."""
        name = self._name(operation, key)
        robot = self._robot(what, name)
        if not self._rights.may_change(robot) and not republishing.is_ours(what, name):
            raise Refusal(f'{name} needs {"the token of " + robot + " or that" if robot else "the token"} of the '
                          'whole page: yours permits less' if self._rights.robots else
                          f'{name} needs a token: without one you can only watch')
        return name


def _shown(text: Any) -> str:
    return text if isinstance(text, str) else repr(text)
