"""Why a condition measured nothing, in words for who wrote the node under test."""

import difflib
from typing import Callable, Collection, List, Mapping, NamedTuple, Optional, Sequence, Tuple

ALIKE = 0.8  # of names, from which on one may be a slip of the other: 1 for the same
HIDDEN = ('/rosout', '/rosout_agg', '/tf', '/tf_static', '/clock', '/diagnostics')  # that every node may publish


class Seen(NamedTuple):
    """What there was at the master during a run; all names are full."""

    publishers: Mapping[str, Collection[str]]  # of each topic: nodes, also those that have ended
    types: Mapping[str, str]  # of topics
    nodes: Collection[str]  # that were there
    ended: Collection[str]  # of these, that are not there any more
    ours: Collection[str]  # nodes of the world and the judge, which make no slips, and namespaces of robots
    heard: Collection[str]  # topics of which messages came


def reason(paths: Sequence[str], topics: Sequence[str], seen: Seen,
           fields: Callable[[str], Mapping[str, str]]) -> str:
    """What was seen in place of what a condition needs; empty if that is nothing special.

    Args:
        paths: full names of the topics that the condition needs, each perhaps with a field.
        topics: topics that are known to be expected.
        seen: what there was.
        fields: types of the fields of a type.
    """
    found = [_reason(path, topics, seen, fields) for path in paths]
    return '; '.join(dict.fromkeys(filter(None, found)))


def _reason(path: str, topics: Sequence[str], seen: Seen, fields: Callable[[str], Mapping[str, str]]) -> str:
    topic = max((each for each in seen.publishers if _is_below(path, each)), key=len, default='')
    if topic:
        return _lacks_field(path, topic, seen.types.get(topic, ''), fields) or _is_silent(topic, seen)
    wanted, near = _wrong_name(path, topics, seen, fields)
    if near:
        ended = ' before it ended' if set(seen.publishers[near]) <= set(seen.ended) else ''
        return (f'nothing was published on {wanted}; {_listed(seen.publishers[near])} publishes {near}{ended}: is that '
                "the topic's wrong name?")
    return f'nothing was published on {wanted}{_who_is_missing(wanted, seen)}'


def _lacks_field(path: str, topic: str, kind: str, fields: Callable[[str], Mapping[str, str]]) -> str:
    """In words, if a topic is of a type without the wanted field."""
    outer = kind
    for field in filter(None, path[len(topic):].split('/') if kind else ()):
        name = field.split('[')[0]
        known = fields(outer)
        if name not in known:
            where = f'{topic} is of type {kind}; {outer}' if outer != kind else f'{topic} is of type {kind}, which'
            return f'{where} has no field {name}; its fields are {", ".join(known) or "none"}'
        outer = known[name].split('[')[0]
    return ''


def _is_silent(topic: str, seen: Seen) -> str:
    """In words, if no message of a topic came that has a publisher."""
    if topic in seen.heard:
        return ''
    nodes = seen.publishers[topic]
    ended = [node for node in nodes if node in seen.ended]
    if ended:
        return f'no message came on {topic}: {_listed(ended)} has ended'
    return f'no message came on {topic}, although {_listed(nodes)} is its publisher'


def _wrong_name(path: str, topics: Sequence[str], seen: Seen,
                fields: Callable[[str], Mapping[str, str]]) -> Tuple[str, str]:
    """The topic that is wanted, and one that may be it by a wrong name; that is empty if there is none."""
    known = [topic for topic in topics if _is_below(path, topic)]
    others = [topic for topic, nodes in seen.publishers.items()
              if topic not in HIDDEN and topic not in topics and set(nodes) - set(seen.ours)]
    best: List[Tuple[float, str, str]] = []
    for wanted in known or _beginnings(path):
        for topic in others:
            likeness = _likeness(wanted, topic, path, seen.types.get(topic, ''), fields)
            if likeness is not None:
                best.append((likeness, wanted, topic))
    if best:
        _, wanted, near = max(best)
        return wanted, near
    return (known or [path])[0], ''


def _likeness(wanted: str, topic: str, path: str, kind: str,
              fields: Callable[[str], Mapping[str, str]]) -> Optional[float]:
    """How much a topic is like the wanted one; None if it is another one."""
    same = difflib.SequenceMatcher(None, wanted, topic).ratio()
    has_field = path != wanted and bool(kind) and not _lacks_field(path, wanted, kind, fields)
    if wanted.split('/')[-1] == topic.split('/')[-1]:
        return same + 2.0
    if same >= ALIKE:
        return same + 1.0
    return same if has_field else None


def _who_is_missing(wanted: str, seen: Seen) -> str:
    """In words, which node is not there."""
    ended = sorted(set(seen.ended) - set(seen.ours))
    if ended:
        return f': {_listed(ended)} has ended'
    first = '/' + wanted.strip('/').split('/')[0]
    is_used = first in (*seen.nodes, *seen.ours) or any(_is_below(topic, first) for topic in seen.publishers)
    return f': no node {first} came, or it ended at once' if not is_used and first != wanted else ''


def _beginnings(path: str) -> List[str]:
    """What may be the topic in a path of a topic and a field."""
    parts = path.strip('/').split('/')
    return ['/' + '/'.join(parts[:length]) for length in range(1, len(parts) + 1)]


def _is_below(path: str, name: str) -> bool:
    return f'{path}/'.startswith(f'{name}/')


def _listed(names: Collection[str]) -> str:
    return ' and '.join(sorted(names))
