"""YAML files: read with one clear error, and written with a comment on every setting."""

import inspect
import textwrap
from typing import Any, Dict, List, Type

import yaml

from rumba_sim.model import config
from rumba_sim.model.errors import RumbaError

WIDTH = 118


def read_mapping(path: str, error: Type[RumbaError]) -> Dict[Any, Any]:
    """Keys and values of a YAML file; an empty file has none.

    Raises:
        error: the file cannot be read, or holds something else; the message begins with the path.
    """
    try:
        with open(path, encoding='utf-8') as file:
            content = yaml.safe_load(file)
    except UnicodeDecodeError as exc:
        raise error(f'{path}: is not text: must be a YAML file') from exc
    except OSError as exc:
        raise error(f'{path}: {exc.strerror}') from exc
    except (yaml.YAMLError, ValueError, RecursionError) as exc:
        mark = getattr(exc, 'problem_mark', None)
        where = f', line {mark.line + 1}' if mark else ''
        raise error(f'{path}{where}: is no YAML: {getattr(exc, "problem", None) or str(exc).splitlines()[0]}') from exc
    if content is None:
        return {}
    if not isinstance(content, dict):
        raise error(f'{path}: must hold keys and values')
    return content


def document(settings: Any) -> str:
    """Settings as a whole YAML file, the docstring of their class at its head."""
    head = (inspect.getdoc(type(settings)) or '').splitlines()
    return '\n'.join(f'# {line}'.rstrip() for line in head) + '\n\n' + as_yaml(settings) + '\n'


def as_yaml(settings: Any, indent: str = '') -> str:
    """Settings as YAML, each under a comment that tells its meaning, range and unit."""
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
