"""YAML files: read with clear errors, and written with a comment on every setting."""

import inspect
import textwrap
from typing import Any, Dict, List, Optional, Type

import yaml

from rumba_sim.model.common import config
from rumba_sim.model.common.errors import RumbaError
from rumba_sim.model.common.regular_file import opened

WIDTH = 118
LARGEST = 100_000  # [bytes] of a file; parsing takes some seconds for as much


class _Loader(yaml.SafeLoader):
    """Reads YAML without aliases: some lines of them can stand for more data than any memory holds."""

    def compose_node(self, parent: Any, index: Any) -> Any:
        """Compose a node, unless it is an alias."""
        if self.check_event(yaml.AliasEvent):
            event = self.peek_event()
            raise yaml.composer.ComposerError(None, None, f'the alias *{event.anchor} is not allowed: write the value',
                                              event.start_mark)
        return super().compose_node(parent, index)


def read_mapping(path: str, error: Type[RumbaError]) -> Dict[Any, Any]:
    """Read the keys and values of a YAML file; an empty file has none.

    Args:
        path: path of the file.
        error: class of the errors to raise.

    Raises:
        error: the file cannot be read, or does not hold keys and values; the message begins with the path.
    """
    content = _parsed(path, _text(path, error), error)
    if content is None:
        return {}
    if not isinstance(content, dict):
        raise error(f'{path}: must hold keys and values')
    return content


def _text(path: str, error: Type[RumbaError]) -> str:
    with opened(path, error) as file:
        try:
            data = file.read(LARGEST + 1)
        except OSError as exc:
            raise error(f'{path}: {exc.strerror}') from exc
    if len(data) > LARGEST:
        raise error(f'{path}: is larger than {LARGEST // 1000} kB: must be a YAML file of keys and values')
    try:
        return data.decode('utf-8')
    except UnicodeDecodeError as exc:
        raise error(f'{path}: is not a text file: must be YAML') from exc


def _parsed(path: str, text: str, error: Type[RumbaError]) -> Any:
    try:
        return yaml.load(text, _Loader)
    except Exception as exc:  # besides its own errors, PyYAML raises what Python's conversions do, or IndexError
        mark = getattr(exc, 'problem_mark', None)
        where = f', line {mark.line + 1}' if mark else ''
        problem = getattr(exc, 'problem', None) or ' '.join(str(exc).split()) or type(exc).__name__
        raise error(f'{path}{where}: is not valid YAML: {problem}') from exc


def document(settings: Any) -> str:
    """Settings as a complete YAML file that begins with the docstring of their class."""
    head = (inspect.getdoc(type(settings)) or '').splitlines()
    return '\n'.join(f'# {line}'.rstrip() for line in head) + '\n\n' + as_yaml(settings) + '\n'


def as_yaml(settings: Any, indent: str = '', by_preset_above: Optional[Dict[str, Any]] = None) -> str:
    """Settings as YAML, each after a comment with its meaning, range and unit.

    What is as a preset has it stays a comment: otherwise it would override another preset that a user chooses.
    """
    lines = []
    by_preset = {**config.values_by_presets(settings), **(by_preset_above or {})}
    for field in config.sections_last(type(settings)):
        value = getattr(settings, field.name)
        if 'section' in field.metadata:
            lines += ['', *_comment(field.metadata['doc'], indent), f'{indent}{field.name}:',
                      as_yaml(value, indent + '  ', by_preset.get(field.name))]
        else:
            is_preset = field.name in by_preset and by_preset[field.name] == value
            lines += [*_comment(config.explain(field), indent),
                      f'{indent}{"# " if is_preset else ""}{field.name}: {_scalar(value)}']
    return '\n'.join(lines)


def _comment(text: str, indent: str) -> List[str]:
    return textwrap.wrap(text, WIDTH, initial_indent=f'{indent}# ', subsequent_indent=f'{indent}# ')


def _scalar(value: Any) -> str:
    return str(yaml.safe_dump(value, default_flow_style=True)).replace('\n...', '').strip()
