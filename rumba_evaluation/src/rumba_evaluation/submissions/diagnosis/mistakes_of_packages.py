"""Mistakes in package.xml and CMakeLists.txt, found by looking at them."""

import difflib
import pathlib
import re
from typing import Dict, Iterable, List, Sequence, Set

from rumba_evaluation.submissions.diagnosis import installed_packages
from rumba_evaluation.submissions.diagnosis.quotations import printable, relative
from rumba_evaluation.submissions.diagnosis.submitted_files import Package, text

BUILD = ('build_depend', 'depend')
RUN = ('exec_depend', 'run_depend', 'depend')
ARCHIVES = ('.zip', '.tar', '.gz', '.tgz', '.bz2', '.xz', '.7z', '.rar')
LISTS = {'msg': 'add_message_files', 'srv': 'add_service_files', 'action': 'add_action_files'}
ALWAYS = ('catkin', 'rumba_msg')  # installed where submissions are marked
MOST_SCRIPTS = 100  # that are read for their imports
GENERATION, RUNTIME = 'message_generation', 'message_runtime'
IMPORT = re.compile(r'^[ \t]*(?:from|import)[ \t]+(rospy|\w+(?=\.(?:msg|srv)\b))', re.MULTILINE)


def of_folder(paths: Sequence[pathlib.Path], found: Sequence[Package], folder: pathlib.Path) -> List[str]:
    """Why a submission has no package at all, or one of its package.xml files cannot be read."""
    if not paths:
        return ['the submission is empty: hand in the folder of your package']
    archives = [path for path in paths if path.suffix.lower() in ARCHIVES]
    others = [path for path in paths if path.name.lower() in ('package.xml', 'package.xml.txt', 'package.xlm')]
    if not found and others:
        return [f'{relative(others[0], folder)} must have the name package.xml, exactly so: rename it']
    if not found and archives:
        return [f'there is no package.xml, but {relative(archives[0], folder)}: unpack it, and hand in the folder']
    if not found:
        return ['there is no package.xml: hand in the whole folder of your package, not only the program in it']
    return [f'{_xml(package, folder)} cannot be read: {printable(package.problem)}: each <tag> needs its </tag>, and '
            '& is written &amp;' for package in found if package.problem]


def _xml(package: Package, folder: pathlib.Path) -> str:
    return relative(package.folder / 'package.xml', folder)


def _cmake(package: Package, folder: pathlib.Path) -> str:
    return relative(package.folder / 'CMakeLists.txt', folder)


def of_names(wanted: Iterable[str], found: Sequence[Package], folder: pathlib.Path) -> List[str]:
    """Packages that tests want and that are missing, and those whose name is not the same everywhere."""
    packages = {package.name: package for package in found if package.name}
    told = []
    for name in dict.fromkeys(wanted):
        if packages and name not in packages:
            nearest = max(packages, key=lambda each: difflib.SequenceMatcher(None, name, each[:100]).ratio())
            others = ', '.join(printable(each, 50) for each in list(packages)[:10])
            told.append(f'there is no package {name}, but {others}: write <name>{name}</name> in '
                        f'{_xml(packages[nearest], folder)}, and project({name}) in CMakeLists.txt')
    return told + [f'{_cmake(package, folder)}: project({printable(package.project)}) is not the name in package.xml, '
                   f'{printable(package.name)}: write project({printable(package.name)})' for package in found
                   if package.name and package.project and package.project != package.name]


def of_messages(package: Package, folder: pathlib.Path) -> List[str]:
    """What is missing so that the messages and services of a package are generated."""
    own = [path for path in package.files if path.parent.parent == package.folder and path.parent.name in LISTS
           and path.suffix == f'.{path.parent.name}']
    if not own:
        return []
    return [*_unlisted(package, own, folder), *_ungenerated(package, folder), *_generation(package, folder)]


def _unlisted(package: Package, own: Sequence[pathlib.Path], folder: pathlib.Path) -> List[str]:
    told = []
    for kind, command in LISTS.items():
        lists = [call.arguments for call in package.calls if call.name == command]
        if any('FILES' not in each for each in lists):
            continue  # takes all in the folder
        listed = {word for each in lists for word in each}
        missing = [printable(path.name) for path in own if path.suffix == f'.{kind}' and path.name not in listed]
        if missing:
            told.append(f'{_cmake(package, folder)} does not name {", ".join(missing[:10])}, so that Python and C++ do '
                        f'not know it: write {command}(FILES {" ".join(missing[:10])}) before generate_messages')
    return told


def _ungenerated(package: Package, folder: pathlib.Path) -> List[str]:
    if any(call.name == 'generate_messages' for call in package.calls):
        return []
    return [f'{_cmake(package, folder)} has no generate_messages(...), so that no message is made: write '
            'generate_messages(DEPENDENCIES std_msgs) before catkin_package, with all packages whose messages you use']


def _generation(package: Package, folder: pathlib.Path) -> List[str]:
    told = []
    if GENERATION not in _components(package):
        told.append(f'{_cmake(package, folder)} does not find {GENERATION}: write it into '
                    f'find_package(catkin REQUIRED COMPONENTS {GENERATION} ...)')
    lines = [f'<{kind}>{name}</{kind}>' for kind, name, kinds in
             (('build_depend', GENERATION, BUILD), ('exec_depend', RUNTIME, RUN))
             if not package.depends_on(name, *kinds)]
    if lines:
        told.append(f'{_xml(package, folder)} lacks {" and ".join(lines)}: a package with messages needs that')
    return told


def _components(package: Package) -> Set[str]:
    """The packages in find_package(catkin COMPONENTS ...), and those with a find_package of their own."""
    found: Set[str] = set()
    for call in package.calls:
        if call.name == 'find_package' and call.arguments[:1] == ['catkin']:
            found.update(word for word in call.arguments[1:] if word not in ('REQUIRED', 'COMPONENTS', 'QUIET'))
        elif call.name == 'find_package':
            found.update(call.arguments[:1])
    return found


def of_dependencies(package: Package, installed: Set[str], folder: pathlib.Path) -> List[str]:
    """Packages that are used and not declared, or declared and not installed.

    Args:
        package: of the submission.
        installed: the names of all packages that are there, with those of the submission.
        folder: the submission.
    """
    return [*_not_installed(package, installed, folder), *_not_declared(package, folder)]


def _not_installed(package: Package, installed: Set[str], folder: pathlib.Path) -> List[str]:
    if not installed.issuperset(ALWAYS):
        return []  # the environment does not tell what is installed
    declared = {name for kind, names in package.dependencies.items() if kind != 'test_depend' for name in names
                if '_' in name}  # others may be names of packages of the system
    missing = sorted(declared.difference(installed))
    if not missing:
        return []
    near = installed_packages.nearest(missing[0], installed)
    hint = f'did you mean {near}?' if near else 'use only packages that the exercise names'
    return [f'{_xml(package, folder)} names {", ".join(printable(name, 50) for name in missing[:10])}, which '
            f'{"is" if len(missing) == 1 else "are"} not installed here: look at the spelling; {hint}']


def _not_declared(package: Package, folder: pathlib.Path) -> List[str]:
    used: Dict[str, str] = {}
    scripts = [path for path in package.files if path.suffix in ('', '.py')
               and not {'test', 'tests'}.intersection(path.relative_to(package.folder).parts)]
    for path in scripts[:MOST_SCRIPTS]:
        for name in IMPORT.findall(text(path)):
            used.setdefault(name, relative(path, folder))
    missing = [name for name in used if name != package.name and not package.depends_on(name, *RUN)]
    if package.problem or not missing:
        return []
    lines = ' '.join(f'<exec_depend>{printable(name, 50)}</exec_depend>' for name in missing[:10])
    return [f'{_xml(package, folder)} lacks {lines}: {used[missing[0]]} imports that']
