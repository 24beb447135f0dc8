"""Classes of installed types, by names that clients and publishers give."""

import functools
import importlib.util
import pathlib
from typing import Any, Callable, Dict

import roslib.message
import rospy

from rumba_viewer.page.messages.operations import TYPE

NOT_MESSAGES: Dict[str, Any] = {'time': rospy.Time, 'duration': rospy.Duration}
MOST_KNOWN = 1000  # types that are remembered, installed or not


@functools.lru_cache(maxsize=MOST_KNOWN)
def of_message(kind: str) -> Any:
    """The class of the type of a message, or of a field; None if it is not installed."""
    return NOT_MESSAGES.get(kind) or _installed(kind, 'msg', roslib.message.get_message_class)


@functools.lru_cache(maxsize=MOST_KNOWN)
def of_service(kind: str) -> Any:
    """The class of the type of a service; None if it is not installed."""
    return _installed(kind, 'srv', roslib.message.get_service_class)


def _installed(kind: str, folder: str, get: Callable[[str], Any]) -> Any:
    """What a function finds that imports a package: no client shall have others imported than those with types."""
    if not TYPE.fullmatch(kind):
        return None
    try:
        spec = importlib.util.find_spec(kind.partition('/')[0])
        places = spec.submodule_search_locations if spec else None
        if not any((pathlib.Path(place) / folder).is_dir() for place in places or ()):
            return None
        return get(kind)
    except (ImportError, ValueError, AttributeError, SyntaxError):
        return None
