"""Settings: frozen dataclasses whose fields know their unit and range, filled strictly from a mapping."""

import dataclasses
import difflib
import math
from typing import Any, List, Mapping, Optional, Type, TypeVar

from rumba_sim.model.errors import ConfigError

Settings = TypeVar('Settings')


def setting(default: Any, doc: str, unit: str = '', low: Optional[float] = None, high: Optional[float] = None) -> Any:
    """A dataclass field that a user may set.

    Args:
        default: value where the user gives none; its type is the type of the setting.
        doc: what it is, for people.
        unit: unit of a number, as in `m/s`.
        low, high: the range of a number, both ends allowed; None for any finite number.
    """
    return dataclasses.field(default=default, metadata={'doc': doc, 'unit': unit, 'low': low, 'high': high})


def names(cls: type) -> List[str]:
    """Names of the settings of a class, in their order."""
    return [field.name for field in dataclasses.fields(cls)]


def describe(cls: type) -> str:
    """One line for each setting of a class: name, default, unit, meaning and range."""
    return '\n'.join(
        f'  {field.name:<18} {field.default!s:<6} {_unit(field):<7} {field.metadata["doc"]}; {_range(field)}'
        for field in dataclasses.fields(cls))


def from_mapping(cls: Type[Settings], mapping: Mapping[str, Any], where: str) -> Settings:
    """Settings of class `cls` from a mapping, as YAML or the parameter server give it.

    Args:
        cls: a frozen dataclass, its fields made by `setting`.
        mapping: value by field name; fields that it leaves out keep their default.
        where: what the mapping was read from, for the error message.

    Raises:
        ConfigError: a name is unknown, or a value has the wrong type or is out of range.
    """
    fields = {field.name: field for field in dataclasses.fields(cls)}
    for name in mapping:
        if name not in fields:
            raise ConfigError(f'{where}: {name} is unknown: {_nearest(name, list(fields))}')
    return cls(**{name: _checked(fields[name], value, where) for name, value in mapping.items()})


def _nearest(name: str, known: List[str]) -> str:
    close = difflib.get_close_matches(name, known, n=1)
    return f'did you mean {close[0]!r}?' if close else f'known are {", ".join(known)}'


def _checked(field: 'dataclasses.Field[Any]', value: Any, where: str) -> Any:
    wanted = type(field.default)
    if wanted is float and type(value) is int:
        value = float(value)
    if type(value) is not wanted or not _in_range(field, value):
        raise ConfigError(f'{where}: {field.name} is {value!r}: must be {_range(field)} {_unit(field)}'.rstrip())
    return value


def _in_range(field: 'dataclasses.Field[Any]', value: Any) -> bool:
    low, high = field.metadata['low'], field.metadata['high']
    if isinstance(value, (bool, str)):
        return True
    return math.isfinite(value) and (low is None or value >= low) and (high is None or value <= high)


def _range(field: 'dataclasses.Field[Any]') -> str:
    wanted, low, high = type(field.default), field.metadata['low'], field.metadata['high']
    if wanted is bool:
        return 'true or false'
    if low is None or high is None:
        return {int: 'a whole number', float: 'a finite number', str: 'text'}[wanted]
    return f'{low:g} to {high:g}'


def _unit(field: 'dataclasses.Field[Any]') -> str:
    return f'[{field.metadata["unit"]}]' if field.metadata['unit'] else ''
