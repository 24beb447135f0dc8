"""Benches and the scripts of pictures, which no other test runs, use names that the packages have."""

import ast
import importlib

import pytest
from workspaces import ROOT

SCRIPTS = sorted(path for folder in ('bench', 'docs/pictures') for path in (ROOT / folder).glob('**/*.py'))
OURS = ('rumba', 'rumba_cleaning', 'rumba_evaluation', 'rumba_localisation', 'rumba_sim', 'rumba_viewer')


def imported(tree):
    """What a script imports from our packages, and under which name: (module, name, own name)."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module.split('.')[0] in OURS:
            yield from ((node.module, alias.name, alias.asname or alias.name) for alias in node.names)


def found(module, name):
    """A name of a module, or the module below a package that has it."""
    place = importlib.import_module(module)
    return getattr(place, name) if hasattr(place, name) else importlib.import_module(f'{module}.{name}')


@pytest.mark.parametrize('path', SCRIPTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_what_it_imports_from_our_packages_is_there(path):
    tree = ast.parse(path.read_text())
    known = {own: found(module, name) for module, name, own in imported(tree)}
    modules = {own for own, value in known.items() if hasattr(value, '__file__')}
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in modules:
            assert hasattr(known[node.value.id], node.attr), f'line {node.lineno}: {node.value.id}.{node.attr}'
