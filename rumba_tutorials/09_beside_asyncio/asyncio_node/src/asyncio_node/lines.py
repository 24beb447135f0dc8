"""Conversion of a message to a line of JSON, and back."""

import json
from typing import Any

import genpy


class LineError(ValueError):
    """A line is not a message; the text says why."""


def to_line(message: Any) -> bytes:
    """Return a message of plain fields as a line."""
    return json.dumps({name: getattr(message, name) for name in message.__slots__}).encode() + b'\n'


def from_line(line: bytes, kind: Any) -> Any:
    """Return the message in a line; fields that the line does not name are zero.

    Raises:
        LineError: the line is not JSON or not an object, or has an unknown field or a value of the wrong type.
    """
    try:
        fields = json.loads(line.decode())
        if not isinstance(fields, dict):
            raise LineError(f'a line must be an object such as {{"{kind.__slots__[0]}": 0}}')
        message = kind(**fields)
        # rospy checks values only while it publishes, and only if there is a subscriber.
        message._check_types()
        return message
    except (ValueError, AttributeError, genpy.SerializationError) as error:
        raise LineError(*error.args) from error
