"""What `/rosapi` answers: about topics, services and parameters that clients can reach, and about types."""

from typing import Any, Callable, Dict, List

import rosgraph
import rosservice

from rumba_sim.model.common.errors import quoted
from rumba_viewer.page import republishing
from rumba_viewer.page.allow_list import AllowList
from rumba_viewer.page.messages.definitions import details
from rumba_viewer.page.messages.errors import Refusal
from rumba_viewer.ros.page.rosapi import parameters, types
from rumba_viewer.ros.page.rosapi.clock import Clock
from rumba_viewer.ros.page.rosapi.floor import Floor
from rumba_viewer.ros.page.rosapi.graph import Graph, Known

ACTION = ('goal', 'cancel', 'status', 'feedback', 'result')  # the topics of an action
Answers = Dict[str, Callable[[Dict[str, Any]], Dict[str, Any]]]


class Api:
    """Answers; some take time, so that they are asked for in threads."""

    def __init__(self, graph: Graph, allowed: AllowList, own: Callable[[], Dict[str, str]], clock: Clock) -> None:
        """Tell clients of what they may reach.

        Args:
            graph: knows what there is.
            allowed: knows what can be reached.
            own: gives the topics that clients of this page publish to, with their types, before the master knows them.
            clock: knows the time.
        """
        self._graph, self._allowed, self._own, self._clock = graph, allowed, own, clock
        self._answers: Answers = {**self._on_topics(), **self._on_services(), **self._on_the_rest()}

    def answer(self, name: str, values: Any) -> Dict[str, Any]:
        """The answer of `/rosapi/NAME`.

        Raises:
            Refusal: there is no such service, or no master.
        """
        answer = self._answers.get(name)
        if answer is None:
            raise Refusal(f'there is no /rosapi/{name} here: there are ' + ', '.join(self._answers))
        if not self._graph.fresh().is_there:
            raise Refusal(f'no roscore answers at {rosgraph.get_master_uri()}')
        return answer(values if isinstance(values, dict) else {})

    @property
    def _known(self) -> Known:
        return self._graph.known

    def _on_topics(self) -> Answers:
        return {
            'topics': lambda _: _columns(self._topics(), 'topics', 'types'),
            'topics_for_type': lambda values: {'topics': [
                name for name, kind in self._topics().items() if kind == values.get('type')]},
            'topic_type': lambda values: {'type': self._topics().get(_text(values, 'topic'), '')},
            'topics_and_raw_types': self._raw_types,
            'publishers': lambda values: {'publishers': self._nodes(self._known.publishers, values)},
            'subscribers': lambda values: {'subscribers': self._nodes(self._known.subscribers, values)},
            'nodes': lambda _: {'nodes': sorted({node for one in self._tables().values() for nodes in one.values()
                                                 for node in nodes})},
            'node_details': lambda values: {what: sorted(
                name for name, nodes in names.items() if values.get('node') in nodes)
                for what, names in self._tables().items()},
            'action_servers': lambda _: {'action_servers': self._actions()}}

    def _on_services(self) -> Answers:
        return {
            'services': lambda _: {'services': self._services()},
            'services_for_type': lambda values: {'services': [
                name for name in self._services() if self._service_type(name) == values.get('type')]},
            'service_type': lambda values: {'type': self._service_type(_text(values, 'service'))},
            'service_node': lambda values: {'node': next(iter(
                self._known.services.get(_text(values, 'service'), [])
                if values['service'] in self._services() else []), '')},
            'service_request_details': lambda values: _typedefs(_service(values)._request_class()),
            'service_response_details': lambda values: _typedefs(_service(values)._response_class())}

    def _on_the_rest(self) -> Answers:
        return {
            'message_details': lambda values: _typedefs(_message(values)),
            'floor': Floor().answer,
            'get_time': lambda _: {'time': dict(zip(('secs', 'nsecs'), self._clock.now()))},
            'get_param': parameters.get, 'set_param': parameters.put, 'has_param': parameters.has,
            'delete_param': parameters.delete,
            'get_param_names': lambda _: {'names': [
                name for name in parameters.names() if self._may('get', name) or self._may('set', name)]}}

    def _may(self, what: str, name: str) -> bool:
        try:
            self._allowed.robot(what, name)
        except Refusal:
            return False
        return True

    def _topics(self) -> Dict[str, str]:
        """Types of the topics that there are and that can be reached; '' if it is not known."""
        known = {**self._known.types, **self._own()}
        found = {name: kind.replace('*', '') for name, kind in known.items()
                 if self._may('read', name) or self._may('write', name)}
        if self._may('read', republishing.SOURCE):
            found.update(republishing.TYPES)
        return dict(sorted(found.items()))

    def _tables(self) -> Dict[str, Dict[str, List[str]]]:
        """What nodes do, by names that can be reached: who publishes, subscribes and serves."""
        topics, services, known = self._topics(), self._services(), self._known
        return {'publishing': {name: known.publishers.get(name, []) for name in topics},
                'subscribing': {name: known.subscribers.get(name, []) for name in topics},
                'services': {name: known.services.get(name, []) for name in services}}

    def _nodes(self, known: Dict[str, List[str]], values: Any) -> List[str]:
        name = _text(values, 'topic')
        return known.get(name, []) if name in self._topics() else []

    def _actions(self) -> List[str]:
        topics = self._topics()
        return [name[:-len('/goal')] for name in topics if name.endswith('/goal')
                and all(f'{name[:-len("goal")]}{part}' in topics for part in ACTION)]

    def _raw_types(self, _: Any) -> Dict[str, Any]:
        topics = self._topics()
        found = [types.of_message(kind) for kind in topics.values()]
        texts = ['' if one is None else one._full_text for one in found]
        return {**_columns(topics, 'topics', 'types'), 'typedefs_full_text': texts}

    def _services(self) -> List[str]:
        own = [republishing.SERVICE] if self._may('read', republishing.SOURCE) else []
        return sorted([*own, *(name for name in self._known.services if self._may('call', name))])

    def _service_type(self, name: str) -> str:
        if name == republishing.SERVICE:
            return republishing.SERVICE_TYPE
        return rosservice.get_service_type(name) or '' if name in self._services() else ''


def _message(values: Any) -> Any:
    """A message of a type."""
    found = types.of_message(_text(values, 'type'))
    if found is None or found in types.NOT_MESSAGES.values():
        raise Refusal(f'the type {quoted(values["type"])} is not installed here')
    return found()


def _service(values: Any) -> Any:
    """The class of a type of service."""
    kind = _text(values, 'type')
    found = types.of_service(kind)
    if found is None:
        raise Refusal(f'the type {quoted(kind)} is not installed here')
    return found


def _typedefs(message: Any) -> Dict[str, Any]:
    return {'typedefs': details(message, types.of_message)}


def _text(values: Any, key: str) -> str:
    value = values.get(key)
    if not isinstance(value, str):
        raise Refusal(f'{key} is {quoted(value)}: must be a text')
    return value


def _columns(topics: Dict[str, str], names: str, types: str) -> Dict[str, Any]:
    return {names: list(topics), types: list(topics.values())}
