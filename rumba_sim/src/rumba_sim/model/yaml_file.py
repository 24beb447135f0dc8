"""YAML files: read with clear errors, and written with a comment on every setting."""

import inspect
import textwrap
from typing import Any, Dict, List, Type

import yaml

from rumba_sim.model import config
from rumba_sim.model.errors import RumbaError

WIDTH = 118


def read_mapping(path: str, error: Type[RumbaError]) -> Dict[Any, Any]:
    """Read the keys and values of a YAML file; an empty file has none.

    Args:
        path: path of the file.
        error: class of the errors to raise.

    Raises:
        error: the file cannot be read, or does not hold keys and values; the message begins with the path.
    """
    try:
        with open(path, encoding='utf-8') as file:
            content = yaml.safe_load(file)
    except UnicodeDecodeError as exc:
        raise error(f'{path}: is not a text file: must be YAML') from exc
    except OSError as exc:
        raise error(f'{path}: {exc.strerror}') from exc
    except (yaml.YAMLError, ValueError, RecursionError) as exc:
        mark = getattr(exc, 'problem_mark', None)
        where = f', line {mark.line + 1}' if mark else ''
        problem = getattr(exc, 'problem', None) or str(exc).splitlines()[0]
        raise error(f'{path}{where}: is not valid YAML: {problem}') from exc
    if content is None:
        return {}
    if not isinstance(content, dict):
        raise error(f'{path}: must hold keys and values')
    return content


def document(settings: Any) -> str:
    """Settings as a complete YAML file that begins with the docstring of their class."""
    head = (inspect.getdoc(type(settings)) or '').splitlines()
    return '\n'.join(f'# {line}'.rstrip() for line in head) + '\n\n' + as_yaml(settings) + '\n'


def as_yaml(settings: Any, indent: str = '') -> str:
    """Settings as YAML, each after a comment with its meaning, range and unit."""
    lines = []
    for field in config.sections_last(type(settings)):
        value = getattr(settings, field.name)
        if 'section' in field.metadata:
            lines += ['', *_comment(field.metadata['doc'], indent), f'{indent}{field.name}:',
                      as_yaml(value, indent + '  ')]
        else:
            lines += [*_comment(config.explain(field), indent), f'{indent}{field.name}: {_scalar(value)}']
    return '\n'.join(lines)


def _comment(text: str, indent: str) -> List[str]:
    return textwrap.wrap(text, WIDTH, initial_indent=f'{indent}# ', subsequent_indent=f'{indent}# ')


def _scalar(value: Any) -> str:
    return str(yaml.safe_dump(value, default_flow_style=True)).replace('\n...', '').strip()
