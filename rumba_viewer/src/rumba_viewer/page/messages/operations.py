"""The fields of rosbridge's operations, checked."""

import math
import re
from typing import Any, Dict, Sequence

from rumba_sim.model.common.errors import quoted
from rumba_viewer.page.messages.errors import Refusal

MOST_NAME = 255  # characters
MOST_NESTED = 32  # levels of a value
NAME = re.compile(r'/[A-Za-z][\w-]*(/[A-Za-z][\w-]*)*', re.ASCII)  # rospy only warns of hyphens
TYPE = re.compile(r'[A-Za-z]\w*/[A-Za-z]\w*', re.ASCII)
Operation = Dict[str, Any]


def name(operation: Operation, key: str, namespace: str) -> str:
    """The full name of a topic, service or parameter."""
    given = operation.get(key)
    full = given if not isinstance(given, str) or given.startswith('/') else namespace + given
    if not isinstance(full, str) or len(full) > MOST_NAME or not NAME.fullmatch(full):
        raise Refusal(f'{key} is {quoted(given)}: must be a name such as /rumba/scan')
    return full


def kind(operation: Operation, of: str) -> str:
    """The type of a message or service."""
    value = operation.get('type')
    if not isinstance(value, str) or not TYPE.fullmatch(value):
        raise Refusal(f'type is {quoted(value)}: must be the type of a {of}')
    return value


def reason(operation: Operation) -> Any:
    """What tells apart several subscriptions to one topic; '' if the operation has no id."""
    found = operation.get('id')
    if not can_be_id(found):
        raise Refusal(f'id is {quoted(found)}: must be a text or a number')
    return '' if found is None else found


def can_be_id(value: Any) -> bool:
    """Whether answers can repeat an id: JSON has neither NaN nor infinities, and ids are no objects."""
    return value is None or isinstance(value, (str, int)) or isinstance(value, float) and math.isfinite(value)


def can_be_repeated(value: Any, levels: int = MOST_NESTED) -> bool:
    """Whether a value of one client can be sent to another: it is not nested deeply, and all numbers are finite."""
    if isinstance(value, (dict, list)):
        parts = value.values() if isinstance(value, dict) else value
        return levels > 0 and all(can_be_repeated(part, levels - 1) for part in parts)
    return not isinstance(value, float) or math.isfinite(value)


def number(operation: Operation, key: str) -> float:
    """A number that is not negative; 0 if there is none."""
    value = operation.get(key, 0)
    if value is None:
        return 0.0
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 <= value <= 1e9:
        raise Refusal(f'{key} is {quoted(value)}: must be a number from 0 to 1e9')
    return float(value)


def one(operation: Operation, key: str, known: Sequence[str], default: str) -> str:
    """One of several texts."""
    value = operation.get(key, default)
    if not isinstance(value, str) or value not in known:
        raise Refusal(f'{key} is {quoted(value)}: must be one of {", ".join(known)}')
    return value
