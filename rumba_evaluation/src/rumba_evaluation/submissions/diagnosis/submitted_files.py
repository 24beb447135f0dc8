"""The files of a submission, read with care: it may hold links to anywhere, devices, pipes, and gigabytes."""

import contextlib
import os
import pathlib
import re
import stat
import xml.etree.ElementTree as ElementTree
from typing import Dict, Iterator, List, NamedTuple, Set

MOST_BYTES = 1_000_000  # of a file that is read
MOST_FILES = 20_000  # of a submission that are looked at
MOST_PACKAGES = 50
LEFT_OUT = ('.git', '__pycache__', 'build', 'devel')  # as when a submission is copied
# A word boundary before the name keeps the search linear in a long word.
CALL = re.compile(r'\b([A-Za-z_]\w*)[ \t\r\n]*\(([^()]*)\)')


class Call(NamedTuple):
    """A command in a CMakeLists.txt."""

    name: str  # in lower case: CMake does not distinguish
    arguments: List[str]
    line: int


class Package(NamedTuple):
    """A package of a submission."""

    folder: pathlib.Path
    name: str  # empty if the package.xml gives none
    problem: str  # why the package.xml cannot be read; empty if it can
    dependencies: Dict[str, Set[str]]  # names of packages by the kind of dependency, such as exec_depend
    files: List[pathlib.Path]
    calls: List[Call]  # of its CMakeLists.txt

    @property
    def targets(self) -> List[str]:
        """The names of the executables that it builds."""
        return [self.resolved(call.arguments[0]) for call in self.calls
                if call.name == 'add_executable' and call.arguments]

    def resolved(self, name: str) -> str:
        """A word of its CMakeLists.txt with the name of the project."""
        return name.replace('${PROJECT_NAME}', self.project)

    @property
    def project(self) -> str:
        """The name in project(); empty if there is none."""
        return next((call.arguments[0] for call in self.calls if call.name == 'project' and call.arguments), '')

    def depends_on(self, name: str, *kinds: str) -> bool:
        """Whether the package.xml names a package as a dependency of one of the kinds."""
        return any(name in self.dependencies.get(kind, ()) for kind in kinds)


def content(path: pathlib.Path, most: int = MOST_BYTES) -> bytes:
    """The first bytes of a file; none if it is a link or no regular file, or too large, or cannot be read."""
    with contextlib.suppress(OSError, ValueError):
        if not stat.S_ISREG(os.lstat(path).st_mode):
            return b''
        # Neither follows a link nor waits for a pipe, should it have become one by now.
        with open(os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK), 'rb') as file:
            about = os.fstat(file.fileno())
            if stat.S_ISREG(about.st_mode) and about.st_size <= MOST_BYTES:
                return file.read(most)
    return b''


def text(path: pathlib.Path) -> str:
    """The text of a file, as `content` reads it."""
    return content(path).decode('utf-8', 'surrogateescape')


def files(folder: pathlib.Path) -> List[pathlib.Path]:
    """The files of a submission, in order."""
    found: List[pathlib.Path] = []
    for path in _walk(folder):
        if len(found) >= MOST_FILES:
            break
        found.append(path)
    return sorted(found)


def _walk(folder: pathlib.Path) -> Iterator[pathlib.Path]:
    for root, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if name not in LEFT_OUT)
        for name in sorted(names):
            yield pathlib.Path(root, name)


def packages(paths: List[pathlib.Path]) -> List[Package]:
    """The packages among the files of a submission."""
    folders = [path.parent for path in paths if path.name == 'package.xml'][:MOST_PACKAGES]
    return [_package(folder, [path for path in paths if folder in path.parents]) for folder in folders]


def _package(folder: pathlib.Path, paths: List[pathlib.Path]) -> Package:
    data = content(folder / 'package.xml')
    problem, name = '', ''
    dependencies: Dict[str, Set[str]] = {}
    try:
        for element in _root(data):
            words = (element.text or '').strip()
            if element.tag == 'name':
                name = words
            elif element.tag.endswith('depend'):
                dependencies.setdefault(element.tag, set()).add(words)
    except (ElementTree.ParseError, ValueError) as error:
        problem = str(error)
    return Package(folder, name, problem, dependencies, paths, calls(text(folder / 'CMakeLists.txt')))


def _root(data: bytes) -> ElementTree.Element:
    """The root of a package.xml.

    Raises:
        ParseError: it is no valid XML.
        ValueError: it is empty, or defines entities, which can stand for gigabytes.
    """
    if not data.strip():
        raise ValueError('it is empty')
    if b'<!DOCTYPE' in data or b'<!ENTITY' in data:
        raise ValueError('it has a <!DOCTYPE>, which a package.xml does not need')
    return ElementTree.fromstring(data)


def calls(text_of_cmake: str) -> List[Call]:
    """The commands in the text of a CMakeLists.txt."""
    code = '\n'.join(line.partition('#')[0] for line in text_of_cmake.split('\n'))
    found: List[Call] = []
    line, at = 1, 0
    for match in CALL.finditer(code):
        line, at = line + code.count('\n', at, match.start()), match.start()
        found.append(Call(match.group(1).lower(), match.group(2).replace('"', ' ').split(), line))
    return found
