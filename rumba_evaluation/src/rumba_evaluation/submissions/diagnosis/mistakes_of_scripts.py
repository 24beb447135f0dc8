"""Mistakes in a script that make it impossible to start, found by looking at its first line."""

import difflib
import os
import pathlib
import shlex
import shutil
from typing import List, Sequence

from rumba_evaluation.submissions.diagnosis.quotations import printable, relative
from rumba_evaluation.submissions.diagnosis.submitted_files import Package, content

MARK = b'\xef\xbb\xbf'  # UTF-8 byte order mark
SHEBANG = '#!/usr/bin/env python3'
SOURCES = ('.c', '.cc', '.cpp', '.cxx')
NO_NODES = ('.xml', '.txt', '.md', '.rst', '.yaml', '.launch', '.test', '.msg', '.srv', '.action', '.h', '.hpp')


def of_node(package: Package, node: str, folder: pathlib.Path) -> List[str]:
    """Why a node of a package cannot be started, if it cannot.

    Args:
        package: of the submission.
        node: the name of its file.
        folder: the submission.
    """
    if _is_built(package, node):
        return []
    found = [path for path in package.files if path.name == node]
    if not found:
        return [_missing(package, node, folder)]
    told = [_of_file(path, folder) for path in found]
    return told[0] if all(told) else []  # one that can run is enough


def _is_built(package: Package, node: str) -> bool:
    """Whether CMakeLists.txt builds a node, or may: names can be computed."""
    return any(node in call.arguments for call in package.calls if call.name == 'set_target_properties') or any(
        target == node or '$' in target for target in package.targets)


def _of_file(path: pathlib.Path, folder: pathlib.Path) -> List[str]:
    where, data = relative(path, folder), content(path)
    if data or path.is_symlink() or not path.is_file() or path.stat().st_size:
        return of_script(data, where) if data else []  # what a link leads to is not looked at
    return [f'{where} is empty: save your program, and hand it in again']


def of_script(data: bytes, where: str) -> List[str]:
    """What is wrong with the first line of a script.

    Args:
        data: the script.
        where: its path, as it is told.
    """
    if data.startswith(b'\x7fELF'):
        return []
    first = data.split(b'\n', 1)[0]
    if data.startswith(MARK):
        return [f'{where} begins with a byte order mark, three invisible bytes before the #!, so it cannot be '
                'started: save it as "UTF-8" without BOM, '
                f"for example by `sed -i '1s/^\\xEF\\xBB\\xBF//' {shlex.quote(where)}`"]
    if not first.startswith(b'#!'):
        return [_without_shebang(data, where)]
    if first.endswith(b'\r'):
        program = printable(_program(first.decode('utf-8', 'surrogateescape')))
        return [f"{where} has Windows line ends (CR LF), so its first line names '{program}', which does not exist: "
                "save it with Unix line ends (LF), for example by "
                f"`sed -i 's/\\r$//' {shlex.quote(where)}`"]
    return _interpreter(first.decode('utf-8', 'surrogateescape'), where)


def _without_shebang(data: bytes, where: str) -> str:
    if data.lstrip().startswith(b'#!'):
        return (f'{where} has empty lines or spaces before the #!, so that it cannot be started: the #! must be the '
                'very first characters of the file: delete what is before it')
    return (f'{where} does not begin with #!, so that the computer does not know which program shall run it: write '
            f'{SHEBANG} as its first line')


def _program(first: str) -> str:
    """The program in the first line of a script or behind env, which takes all that follows for one name without -S."""
    program, _, rest = first[2:].strip(' \t').partition(' ')
    if os.path.basename(program) != 'env':
        return program
    if not rest.lstrip().startswith('-'):
        return rest.strip(' \t')
    return next((word for word in rest.split(' ') if word and not word.startswith('-') and '=' not in word), '')


def _interpreter(first: str, where: str) -> List[str]:
    program = _program(first)
    is_there = os.path.exists(program) if '/' in program else bool(program) and shutil.which(program) is not None
    if is_there:
        return []
    old = os.path.basename(program).startswith('python2')
    hint = ', and translate your program to Python 3, for example by print() with brackets' if old else ''
    return [f"{where}, line 1: the program '{printable(program)}' does not exist here: write {SHEBANG} as the first "
            f'line{hint}']


def _missing(package: Package, node: str, folder: pathlib.Path) -> str:
    """That there is no such node, with what is nearest to it."""
    where = relative(package.folder, folder)
    place = f'the package {printable(package.name)}' if where == '.' else where
    sources = [path for path in package.files if path.suffix in SOURCES]
    if not package.targets and any(path.stem == node for path in sources):
        source = next(path for path in sources if path.stem == node)
        name = printable(str(source.relative_to(package.folder)))
        return (f'{place} has no node {node}: its source {name} is there, but CMakeLists.txt does not build it: '
                f'write add_executable({node} {name}) and target_link_libraries({node} ${{catkin_LIBRARIES}})')
    nearest = _nearest(package, node)
    if nearest in package.targets:
        return (f'{place} has no node {node}, but CMakeLists.txt builds {printable(nearest)}: give add_executable and '
                f'target_link_libraries the name {node}')
    if nearest:
        path = next(path for path in package.files if path.name == nearest)
        return (f'{place} has no node {node}, but {relative(path, folder)}: rename it to '
                f'{printable(str(path.with_name(node).relative_to(folder)))}, exactly so')
    return f'{place} has no node {node}: put your program into the folder scripts of the package, with this name'


def _nearest(package: Package, node: str) -> str:
    """The file or target whose name is most like that of a node; empty if none could be it."""
    scripts = [path.name for path in package.files if path.suffix not in (*NO_NODES, *SOURCES)
               and _is_program(path)]
    names: Sequence[str] = [*package.targets, *scripts]
    for name in names:
        if name.lower().partition('.')[0] == node.lower():
            return name
    near = difflib.get_close_matches(node, [name[:100] for name in names], 1, 0.6)
    if near:
        return near[0]
    return names[0] if len(names) == 1 else ''


def _is_program(path: pathlib.Path) -> bool:
    return path.suffix == '.py' and path.name not in ('setup.py', '__init__.py') or b'#!' in content(path, 5)
