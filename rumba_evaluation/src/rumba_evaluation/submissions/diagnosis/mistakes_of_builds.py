"""Mistakes that stop a build, by what catkin_make, CMake, the compiler, the linker and genmsg printed."""

import re
from typing import Callable, Iterable, List, Match, NamedTuple, Pattern, Sequence, Tuple

from rumba_evaluation.submissions.diagnosis.quotations import lines_of, printable, within_copy

MOST_BLOCKS = 10  # errors of CMake that are looked at
MOST_WORDS = 3000  # characters of an error of CMake
CMAKE = 'CMake Error'
INVALID = 'genmsg.base.InvalidMsgSpec'
LIBRARIES = '${catkin_LIBRARIES}'


class _Block(NamedTuple):
    """One error of CMake."""

    place: str  # file and line in the submission
    words: str  # of the message, on one line


def of_output(output: str) -> List[str]:
    """What the output of a build says about mistakes of a submission."""
    lines = lines_of(output)
    told = [*_manifests(lines), *_definitions(lines)]
    blocks = _blocks(lines)
    told += filter(None, map(_of_block, blocks))
    if blocks and not told:
        told.append(f'{_where(blocks[0])}CMake says: {printable(blocks[0].words)}')
    return [*told, *_compiler(lines), *_linker(lines)]


def _place(path: str, line: str) -> str:
    """File and line; of a path that CMake or the compiler printed."""
    name = within_copy(path) or (path[len('submission/'):] if path.startswith('submission/') else '')
    return f'{printable(name)}, line {line}' if name else ''


# --- catkin_make, before it starts CMake ---


def _manifests(lines: Sequence[str]) -> List[str]:
    told = []
    for number, line in enumerate(lines):
        if line.startswith("Error(s) in package '"):
            words = ' '.join(filter(None, lines[number + 1:number + 4]))
            told.append(f'{printable(within_copy(line[:-2]))} cannot be used: {printable(words)}')
        elif line.startswith('Multiple packages found with the same name'):
            folders = [printable(other[2:].partition('/')[2] or other[2:]) for other in lines[number + 1:number + 11]
                       if other.startswith('- ')]
            told.append(f'there are several packages with one name, in {" and ".join(folders)}: hand in only one')
    return told


# --- message definitions ---


def _definitions(lines: Sequence[str]) -> List[str]:
    for line in lines:
        if INVALID in line and within_copy(line):
            name, _, problem = within_copy(line).partition(': ')
            return [f'{printable(name)} is no message: {printable(problem)}: each line must be a type and a name, such '
                    'as "float64 speed"']
    return []


# --- CMake ---


def _blocks(lines: Sequence[str]) -> List[_Block]:
    found: List[_Block] = []
    for number, line in enumerate(lines):
        if line.startswith(CMAKE) and len(found) < MOST_BLOCKS:
            body = [line]
            for other in lines[number + 1:number + 40]:
                if other and other[0] not in ' C' or other.startswith(('CMake', 'Configuring')):
                    break
                body.append(other)
            found.append(_block(body))
    return found


def _block(body: Sequence[str]) -> _Block:
    message = [line for line in body[1:] if line.startswith(' ')]
    stack = body.index('Call Stack (most recent call first):') if 'Call Stack (most recent call first):' in body else 0
    if stack:
        message = [line for line in body[1:stack] if line.startswith(' ')]
    heads = [body[0].partition(' at ')[2], *(map(str.strip, body[stack:]) if stack else ())]
    places = (_place(path, rest.split(' ')[0].rstrip(':'))
              for path, _, rest in (head.partition(':') for head in heads))
    return _Block(next(filter(None, places), ''), ' '.join(' '.join(message).split())[:MOST_WORDS])


def _of_block(block: _Block) -> str:
    """What to do about an error; empty if it is none that is known: it often follows from another one."""
    for pattern, tell in RULES:
        match = pattern.search(block.words)
        if match:
            return _where(block) + tell(match)
    return ''


def _where(block: _Block) -> str:
    return f'{block.place}: ' if block.place else ''


def _text(template: str) -> Callable[[Match[str]], str]:
    """A sentence with the groups of a match as {0}, {1}: quotations."""
    return lambda match: template.format(*(printable(group, 100) for group in match.groups()))


def _unknown_command(match: Match[str]) -> str:
    name = match.group(1)
    if name in ('add_message_files', 'add_service_files', 'add_action_files', 'generate_messages'):
        return (f'{name} is unknown, because message_generation was not found before: write it into '
                'find_package(catkin REQUIRED COMPONENTS message_generation ...)')
    return f'there is no command {printable(name)}: look at its spelling'


def _missing_package(match: Match[str]) -> str:
    name = printable(match.group(1), 100)
    return (f'the package {name} is not installed here: look at its spelling in find_package, and use only packages '
            'that the exercise names')


def _missing_file(match: Match[str]) -> str:
    name = printable(within_copy(match.group(1)) or match.group(1))
    return f'{name} does not exist: look at the spelling, and hand in this file too'


_NAMED: Sequence[Tuple[str, Callable[[Match[str]], str]]] = (
    (r"package name '([^']*)' in '[^']*' does not match current PROJECT_NAME '([^']*)'",
     _text('project({1}) is not the name in package.xml, {0}: write project({0})')),
    (r'Unknown CMake command "([^"]*)"', _unknown_command),
    (r'Could not find a package configuration file provided by "([^"]*)"', _missing_package),
    (r'depends on unknown pkg: (\S*)',
     _text('messages of {0} are used, but it is not found before: write {0} into find_package(catkin REQUIRED '
           'COMPONENTS ...), and <depend>{0}</depend> into package.xml')),
    (r'Cannot locate message \[([^\]]*)\]: unknown package \[([^\]]*)\]',
     _text('a message uses {1}/{0}: write {1} into find_package(catkin REQUIRED COMPONENTS ...) and into '
           'generate_messages(DEPENDENCIES ...), and <depend>{1}</depend> into package.xml')),
    (r'Cannot locate message \[([^\]]*)\]',
     _text('a message uses the type {0}, which does not exist: numbers are float64 or int32, texts are string. '
           'Messages of other packages begin with the name of the package, such as std_msgs/Header')),
    (r"DEPENDS on the catkin package '([^']*)' which must therefore be listed as a run dependency",
     _text('package.xml lacks <exec_depend>{0}</exec_depend>')),
    (r"the catkin package '([^']*)' has been find_package\(\)-ed but is not listed as a build dependency",
     _text('package.xml lacks <depend>{0}</depend>')),
    (r'generate_messages\(\) must be called before catkin_package\(\)',
     _text('generate_messages(...) must stand before catkin_package(...): move it up')),
    (r'generate_messages\(\) must be called after', _text('generate_messages(...) must stand after all add_*_files')),
    (r"Assertion failed: file '([^']*)' does not exist", _missing_file),
    (r"called with non-existing file '([^']*)'", _missing_file),
    (r'Cannot find source file: (\S*)', _text('{0} does not exist: look at the spelling, and hand in this file too')),
    (r"called without 'setup\.py'",
     _text('catkin_python_setup() needs a file setup.py in the package: write it, or delete this line')),
    (r'The source directory (\S*) does not contain a CMakeLists\.txt',
     lambda match: f'{printable(within_copy(match.group(1)) or match.group(1))} has no CMakeLists.txt: hand in the '
                   'whole folder of your package'),
    (r'Parse error\. (.*)', _text('a bracket or a quotation mark is missing or too much: {0}')))
RULES: Sequence[Tuple[Pattern[str], Callable[[Match[str]], str]]] = [
    (re.compile(pattern), tell) for pattern, tell in _NAMED]


# --- the compiler ---


def _compiler(lines: Sequence[str]) -> List[str]:
    """The first error of the compiler: others often follow from it."""
    near = ''  # the last place in the submission: an error in a header of ROS is caused there
    for line in lines:
        for kind in (': fatal error: ', ': error: '):
            head, found, message = line.partition(kind)
            if found:
                place = _compiled(head) or near
                if place:
                    return [f'{place}: {_of_compiler(message, place)}']
        near = _compiled(line.partition(':   required from')[0]) or near
    return []


def _compiled(head: str) -> str:
    """File and line of FILE:LINE:COLUMN in the submission; else empty."""
    path, line, column = (head.rsplit(':', 2) + ['', ''])[:3]
    return _place(path, line) if line.isdigit() and column.isdigit() else ''


def _of_compiler(message: str, place: str) -> str:
    said = f'the compiler says "{printable(message)}"'
    header, found, _ = message.partition(': No such file or directory')
    if found:
        package, slash, _ = header.partition('/')
        name = printable(package)
        if place.startswith(f'{name}/'):
            return (f'there is no {printable(header)} yet: if it is a message of your own, write '
                    'add_dependencies(NODE ${PROJECT_NAME}_generate_messages_cpp) after add_executable(NODE ...)')
        packages = (f', write {name} into find_package(catkin REQUIRED COMPONENTS ...) and <depend>{name}</depend> '
                    'into package.xml,') if slash else ''
        return (f'there is no {printable(header)}: look at the spelling{packages} and write '
                'include_directories(${catkin_INCLUDE_DIRS}) before add_executable')
    if 'was not declared in this scope' in message or 'has no member named' in message:
        return f'{said}: look at the spelling of this name, and whether it is declared before this line'
    if 'expected' in message:
        return f'{said}: look also at the line before: often ; or a bracket is missing there'
    return f'{said}: correct this line first, since other errors may follow from it'


# --- the linker ---


def _linker(lines: Iterable[str]) -> List[str]:
    target, missing, library = '', '', ''
    for line in lines:
        missing = missing or line.partition('undefined reference to `')[2].rstrip("'")
        library = library or line.partition('cannot find -l')[2].partition(':')[0]
        if line.startswith('make') and '***' in line and (missing or library):
            target = line.rpartition('] Error')[0].rpartition('/')[2]
            break
    name = printable(target, 100) or 'the node'
    if library:
        return [f'{name}: there is no library {printable(library)}: look at target_link_libraries in CMakeLists.txt']
    if missing == 'main':
        return [f'{name}: no source has a function main: write "int main(int argc, char** argv)", and name its file in '
                f'add_executable({name} ...)']
    if missing:
        return [f'{name} uses {printable(missing.partition("(")[0], 100)}, but the linker does not find it: write '
                f'target_link_libraries({name} {LIBRARIES}) after add_executable in CMakeLists.txt; if it is a '
                f'function of your own, name its file in add_executable({name} ...)']
    return []
