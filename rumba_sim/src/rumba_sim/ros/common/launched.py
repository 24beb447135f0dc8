"""Parameters that nobody can change: those of a file, in place of the parameter server, which obeys everybody.

Who marks has started all nodes by one launch file, and writes its parameters into a file of its own. The environment
variable RUMBA_PARAMETERS names it.
"""

import json
import os
from typing import Any, Dict

VARIABLE = 'RUMBA_PARAMETERS'


def is_fixed() -> bool:
    """Whether nodes take their parameters from a file."""
    return VARIABLE in os.environ


def all_of_them() -> Dict[str, Any]:
    """All parameters by their full names, as the launch file sets them."""
    with open(os.environ[VARIABLE], encoding='utf-8') as file:
        found: Dict[str, Any] = json.load(file)
    return found


def below(node: str) -> Dict[str, Any]:
    """The private parameters of a node, given by its full name: those of a namespace are a dictionary."""
    found: Dict[str, Any] = {}
    for name, value in all_of_them().items():
        if name.startswith(f'{node}/'):
            *places, last = name[len(node) + 1:].split('/')
            inner = found
            for place in places:
                inner = inner.setdefault(place, {})
            inner[last] = value
    return found
