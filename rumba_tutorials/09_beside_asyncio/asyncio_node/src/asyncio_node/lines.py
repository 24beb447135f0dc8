"""A message as a line of JSON, and back."""

import json
from typing import Any

import genpy


class LineError(ValueError):
    """A line is no message; says why."""


def to_line(message: Any) -> bytes:
    """A message of plain fields as a line."""
    return json.dumps({name: getattr(message, name) for name in message.__slots__}).encode() + b'\n'


def from_line(line: bytes, kind: Any) -> Any:
    """The message of a line; fields that the line does not name are zero.

    Raises:
        LineError: no JSON, no object, a field that the message does not have, or a value that does not fit it.
    """
    try:
        fields = json.loads(line.decode())
        if not isinstance(fields, dict):
            raise LineError(f'a line must be an object such as {{"{kind.__slots__[0]}": 0}}')
        message = kind(**fields)
        # rospy itself would look at the values while it publishes, and then only where somebody listens.
        message._check_types()
        return message
    except (ValueError, AttributeError, genpy.SerializationError) as error:
        raise LineError(*error.args) from error
