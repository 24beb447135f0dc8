"""What the definition of a type says, as rosapi tells it: fields and constants of the type, and of all types within."""

from typing import Any, Callable, Dict, List

from rumba_viewer.page.messages.conversion import INTEGERS, TIMES, kind
from rumba_viewer.page.messages.errors import Refusal

PLAIN = {**{base: '0' for base in INTEGERS}, 'float32': '0.0', 'float64': '0.0', 'bool': 'False', 'string': ''}


def details(message: Any, find: Callable[[str], Any]) -> List[Dict[str, Any]]:
    """The definition of the type of a message, and of those that it contains.

    Args:
        message: one with the defaults of all fields.
        find: gives the class of a type.

    Raises:
        Refusal: a type is not installed.
    """
    found, waiting = {}, [message]
    while waiting:
        one = waiting.pop()
        found[one._type] = _definition(one)
        for base in {kind(of).base for of in one._slot_types} - set(PLAIN) - set(found):
            if base in TIMES:
                found[base] = _definition_of_time(base)
            else:
                waiting.append(_made(base, find))
    return list(found.values())


def _made(base: str, find: Callable[[str], Any]) -> Any:
    found = find(base)
    if found is None:
        raise Refusal(f'the type {base} is not installed here')
    return found()


def _definition(message: Any) -> Dict[str, Any]:
    kinds = [kind(of) for of in message._slot_types]
    constants = {name: value for name, value in vars(type(message)).items()
                 if name.isupper() and isinstance(value, (bool, int, float, str))}
    return {
        'type': message._type, 'fieldnames': list(message.__slots__), 'fieldtypes': [one.base for one in kinds],
        'fieldarraylen': [(one.length or 0) if one.is_list else -1 for one in kinds],
        'examples': ['[]' if one.is_list else PLAIN.get(one.base, '{}') for one in kinds],
        'constnames': list(constants), 'constvalues': [str(value) for value in constants.values()]}


def _definition_of_time(base: str) -> Dict[str, Any]:
    part = 'uint32' if base == 'time' else 'int32'
    return {'type': base, 'fieldnames': ['secs', 'nsecs'], 'fieldtypes': [part, part], 'fieldarraylen': [-1, -1],
            'examples': ['0', '0'], 'constnames': [], 'constvalues': []}
