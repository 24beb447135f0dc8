"""Parameters for clients, as JSON; whether a client may use one is checked before."""

import json
import xmlrpc.client
from typing import Any, Dict, List
from xml.parsers.expat import ExpatError

import rosgraph
import rospy

from rumba_sim.model.common.errors import quoted
from rumba_viewer.page.messages.errors import Refusal


def get(values: Any) -> Dict[str, Any]:
    """The value of a parameter, or the default that is given; null if there is neither."""
    name = _checked(values['name'])
    try:
        value = _master().getParam(name)
    except rosgraph.MasterError:
        default = values.get('default')
        value = _parsed('default', default) if default else None
    try:
        return {'value': json.dumps(value, allow_nan=False)}
    except (TypeError, ValueError):
        raise Refusal(f'{name} is {quoted(value)}, which JSON cannot express') from None


def put(values: Any) -> Dict[str, Any]:
    """Set a parameter to a value that is given as JSON."""
    name, value = _checked(values['name']), _parsed('value', values.get('value'))
    for parent in _above(name):
        if _master().hasParam(parent) and not isinstance(_master().getParam(parent), dict):
            raise Refusal(f'{name} cannot be set: {parent} is a parameter, and would be lost')
    try:
        json.dumps(value, allow_nan=False)
        xmlrpc.client.loads(xmlrpc.client.dumps((value,)))
    except (TypeError, ValueError, OverflowError, RecursionError, ExpatError) as error:
        raise Refusal(f'value is {quoted(value)}, which cannot be a parameter: {error}') from None
    _master().setParam(name, value)
    return {}


def delete(values: Any) -> Dict[str, Any]:
    """Delete a parameter."""
    name = _checked(values['name'])
    try:
        _master().deleteParam(name)
    except rosgraph.MasterError:
        raise Refusal(f'there is no parameter {name}') from None
    return {}


def has(values: Any) -> Dict[str, Any]:
    """Whether a parameter is set."""
    return {'exists': bool(_master().hasParam(_checked(values['name'])))}


def names() -> List[str]:
    """Names of all parameters."""
    return list(_master().getParamNames())


def _master() -> rosgraph.Master:
    return rosgraph.Master(rospy.get_name())


def _checked(name: str) -> str:
    """A name, unless it stands for parameters of this node, among which are its tokens."""
    own = rospy.get_name()
    if name == own or own in _above(name) or name in _above(own):
        raise Refusal(f'{name} cannot be reached: it belongs to this page, or contains what does')
    return name


def _above(name: str) -> List[str]:
    """The names of the parameters that contain one of this name."""
    parts = name.split('/')
    return ['/'.join(parts[:count]) for count in range(2, len(parts))]


def _parsed(key: str, text: Any) -> Any:
    try:
        return json.loads(text)
    except (TypeError, ValueError, RecursionError):
        raise Refusal(f'{key} is {quoted(text)}: must be a text with JSON') from None
