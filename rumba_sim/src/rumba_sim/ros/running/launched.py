"""Parameters that nobody can change: those of a file, in place of the parameter server, which obeys everybody.

Who marks starts all nodes by one launch file, and writes what it says into a file of its own. The environment variable
RUMBA_LAUNCHED names it.
"""

import json
import os
from typing import Any, Dict, List

VARIABLE = 'RUMBA_LAUNCHED'


def is_fixed() -> bool:
    """Whether nodes take their parameters from a file."""
    return VARIABLE in os.environ


def nodes() -> List[str]:
    """Full names of the nodes whose parameters nobody may change."""
    found: List[str] = _read()['nodes']
    return found


def parameters() -> Dict[str, Any]:
    """All parameters by their full names, as the launch file sets them."""
    found: Dict[str, Any] = _read()['parameters']
    return found


def _read() -> Dict[str, Any]:
    with open(os.environ[VARIABLE], encoding='utf-8') as file:
        found: Dict[str, Any] = json.load(file)
    return found


def below(node: str) -> Dict[str, Any]:
    """The private parameters of a node, given by its full name: those of a namespace are a dictionary."""
    found: Dict[str, Any] = {}
    for name, value in parameters().items():
        if name.startswith(f'{node}/'):
            *places, last = name[len(node) + 1:].split('/')
            inner = found
            for place in places:
                inner = inner.setdefault(place, {})
            inner[last] = value
    return found
