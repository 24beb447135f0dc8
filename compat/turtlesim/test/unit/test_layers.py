"""The model imports no ROS, no Qt and no clock; each script is a few lines, executable and installed."""

import ast
import pathlib

import pytest

PACKAGE = pathlib.Path(__file__).resolve().parents[2]
MODEL = sorted((PACKAGE / 'src' / 'turtlesim' / 'model').glob('*.py'))
SCRIPTS = sorted((PACKAGE / 'scripts').iterdir())
PURE = {'contextlib', 'functools', 'math', 're', 'typing', '__future__', 'numpy', 'PIL'}


@pytest.mark.parametrize('path', MODEL, ids=lambda path: path.name)
def test_the_model_imports_only_pure_modules(path):
    for node in ast.walk(ast.parse(path.read_text())):
        names = ([alias.name for alias in node.names] if isinstance(node, ast.Import) else
                 [node.module] if isinstance(node, ast.ImportFrom) else [])
        for name in names:
            assert name.split('.')[0] in PURE or name.startswith('turtlesim.model.'), name


@pytest.mark.parametrize('path', SCRIPTS, ids=lambda path: path.name)
def test_a_script_is_a_few_lines_executable_and_installed(path):
    assert len(path.read_text().splitlines()) <= 5
    assert path.stat().st_mode & 0o111
    build_file = (PACKAGE / 'CMakeLists.txt').read_text().replace('${PROJECT_NAME}', 'turtlesim')
    assert f'scripts/{path.name}\n' in build_file
