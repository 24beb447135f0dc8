"""Settings: frozen dataclasses whose fields have a unit and a range, read from mappings with strict checks."""

import dataclasses
import difflib
import math
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Type, TypeVar

from rumba_sim.model.common.errors import ConfigError, quoted

Settings = TypeVar('Settings')
LONGEST_NAME = 80  # [characters] that are compared with the known names
LARGEST = 1e300  # a larger number is out of range: an integer of YAML may be too large for a float
Field = Any  # of dataclasses.Field: Python 3.8 cannot subscript it at run time


def setting(default: Any, doc: str, unit: str = '', low: Optional[float] = None, high: Optional[float] = None,
            choices: Sequence[str] = (), presets: Optional[Mapping[str, Mapping[str, Any]]] = None) -> Any:
    """A dataclass field that a user may set.

    Args:
        default: value if the user gives none; its type is the type of the setting.
        doc: the meaning of the setting and the source of its default, for people.
        unit: unit of a number, for example `m/s`.
        low: smallest allowed number; None for any finite number.
        high: largest allowed number; None for any finite number.
        choices: the texts that are allowed; empty for any. The Booleans of YAML count as 'true' and 'false' here.
        presets: the texts that are allowed, each with values of other settings of its section, nested like those.
            Whoever gives one of the texts gives all settings that have a value in any preset: those not in its own get
            their defaults.
    """
    return dataclasses.field(default=default, metadata={'doc': doc, 'unit': unit, 'low': low, 'high': high,
                                                        'choices': choices or tuple(presets or ()),
                                                        'presets': presets or {}})


def section(cls: type, doc: str) -> Any:
    """A dataclass field that holds further settings, of class `cls`."""
    return dataclasses.field(default_factory=cls, metadata={'doc': doc, 'section': cls})


def names(cls: type) -> List[str]:
    """Names of the settings of a class, in their order."""
    return [field.name for field in dataclasses.fields(cls)]


def part(settings: Any, cls: Type[Settings]) -> Settings:
    """The part of some settings that belongs to `cls`, a base class of theirs, as an instance of `cls`."""
    return cls(**{name: getattr(settings, name) for name in names(cls)})


def describe(cls: type) -> str:
    """A line for each setting of a class: name, default, unit, meaning and range."""
    rows = [(path, f'{field.default!s}', _unit(field), f'{field.metadata["doc"]}; {_range(field)}')
            for path, field in leaves(cls)]
    widths = [max(len(row[column]) for row in rows) for column in range(3)] if rows else []
    return '\n'.join('  ' + '  '.join([*(text.ljust(width) for text, width in zip(row, widths)), row[3]])
                     for row in rows)


def explain(field: Field) -> str:
    """Meaning, range and unit of a setting in one line."""
    return f'{field.metadata["doc"]}; {_range(field)} {_unit(field)}'.rstrip()


def leaves(cls: type, path: str = '') -> Iterator[Tuple[str, Field]]:
    """Path (for example `battery/drain`) and field of each setting; settings in sections come last."""
    for field in sections_last(cls):
        if 'section' in field.metadata:
            yield from leaves(field.metadata['section'], f'{path}{field.name}/')
        else:
            yield path + field.name, field


def sections_last(cls: type) -> List[Field]:
    """The fields of a class of settings, sections after single settings."""
    return sorted(dataclasses.fields(cls), key=lambda field: 'section' in field.metadata)


def from_mapping(cls: Type[Settings], mapping: Mapping[str, Any], where: str) -> Settings:
    """Settings of class `cls` from a mapping that comes from YAML or from the parameter server.

    Args:
        cls: a frozen dataclass with fields made by `setting` and `section`.
        mapping: values by field name; other fields keep their defaults.
        where: source of the mapping, for error messages.

    Raises:
        ConfigError: a name is unknown, or a value has the wrong type or is out of range.
    """
    return updated(cls(), mapping, where)


def updated(settings: Settings, mapping: Mapping[str, Any], where: str) -> Settings:
    """A copy of settings with values replaced by those of a mapping, which is nested like the settings.

    Raises:
        ConfigError: as for `from_mapping`.
    """
    try:
        return _updated(settings, mapping, '')
    except ConfigError as error:
        raise ConfigError(f'{where}: {error}') from None


def _updated(settings: Settings, mapping: Mapping[str, Any], path: str) -> Settings:
    fields = {field.name: field for field in dataclasses.fields(settings)}
    if not isinstance(mapping, Mapping):
        raise ConfigError(f'{path[:-1]} is {quoted(mapping)}: must be a mapping of {", ".join(fields)}'.lstrip())
    changes, parts = {}, {}
    for name, value in mapping.items():
        if name not in fields:
            raise ConfigError(f'{path}{name if isinstance(name, str) else quoted(name)} is unknown: '
                              f'{nearest(name, list(fields))}')
        if 'section' in fields[name].metadata:
            parts[name] = value
        else:
            changes[name] = _checked(fields[name], value, path)
    preset = _preset(type(settings), [fields[name] for name in changes], changes)
    for name in [name for name in fields if 'section' in fields[name].metadata]:
        part_settings = _updated(getattr(settings, name), preset.pop(name, {}), f'{path}{name}/')
        changes[name] = _updated(part_settings, parts.get(name, {}), f'{path}{name}/')
    return dataclasses.replace(settings, **{**preset, **changes})


def values_by_presets(settings: Any) -> Dict[str, Any]:
    """What settings of a section are by the presets that others of its settings name, nested like the settings."""
    return _preset(type(settings), dataclasses.fields(settings), vars(settings))


def _preset(cls: type, chosen: Sequence[Field], values: Mapping[str, Any]) -> Dict[str, Any]:
    """What the values of some fields of a class, by their names, set other fields to."""
    preset: Dict[str, Any] = {}
    for field in chosen:
        presets = field.metadata.get('presets', {})
        if presets:
            preset.update(_filled(cls, presets[values[field.name]], list(presets.values())))
    return preset


def _filled(cls: type, own: Mapping[str, Any], presets: Sequence[Mapping[str, Any]]) -> Dict[str, Any]:
    """A preset, with the defaults of a class for all that is in other presets alone."""
    filled: Dict[str, Any] = {}
    for field in dataclasses.fields(cls):
        values = [preset[field.name] for preset in presets if field.name in preset]
        if values and 'section' in field.metadata:
            filled[field.name] = _filled(field.metadata['section'], own.get(field.name, {}), values)
        elif values:
            filled[field.name] = own.get(field.name, field.default)
    return filled


def nearest(name: Any, known: List[str]) -> str:
    """End of a message about an unknown name: the known name that is most similar, or all known names."""
    close = closest(name, known)
    return f'known are {", ".join(known)}' if close is None else f'did you mean {close!r}?'


def closest(name: Any, known: List[str]) -> Optional[str]:
    """The known name that an unknown name was probably meant to be; None if none is similar."""
    close = difflib.get_close_matches(name[:LONGEST_NAME].lower(), known, n=1) if isinstance(name, str) else []
    return close[0] if close else None


def _checked(field: Field, value: Any, path: str) -> Any:
    wanted = type(field.default)
    if wanted is float and type(value) is int:
        value = float(value) if abs(value) < LARGEST else math.inf
    if field.metadata['choices'] and type(value) is bool:
        value = str(value).lower()
    if type(value) is not wanted or not _in_range(field, value):
        raise ConfigError(f'{path}{field.name} is {quoted(value)}: must be {_range(field)} {_unit(field)}'.rstrip())
    return value


def _in_range(field: Field, value: Any) -> bool:
    low, high = field.metadata['low'], field.metadata['high']
    if isinstance(value, str):
        return value in (field.metadata['choices'] or [value])
    if isinstance(value, bool):
        return True
    return abs(value) < LARGEST and (low is None or value >= low) and (high is None or value <= high)


def _range(field: Field) -> str:
    wanted, low, high = type(field.default), field.metadata['low'], field.metadata['high']
    if wanted is bool:
        return 'true or false'
    if field.metadata['choices']:
        return ' or '.join(field.metadata['choices'])
    if low is None or high is None:
        return {int: 'a whole number', float: 'a finite number', str: 'text'}[wanted]
    return f'{low:.10g} to {high:.10g}'


def _unit(field: Field) -> str:
    return f'[{field.metadata["unit"]}]' if field.metadata['unit'] else ''
