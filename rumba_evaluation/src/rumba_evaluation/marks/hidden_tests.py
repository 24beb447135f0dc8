"""What hidden .test files ask, read before anything runs: a submission that breaks loses those points."""

import pathlib
import re
import xml.etree.ElementTree as ElementTree
from typing import Any, Dict, List, Mapping, NamedTuple, Sequence

from rumba_evaluation.marks.scheme import Scheme
from rumba_evaluation.verdicts.mission_requirements import Requirements
from rumba_sim.model.common.config import names, updated
from rumba_sim.model.common.errors import ConfigError

MISSION_TEST = 'mission_test'
START = 90.0  # [s] of the wall clock that a world, a judge and a submission need to start and to end
USUAL_LIMIT = 60.0  # [s] time-limit of rostest if a test gives none


class HiddenTest(NamedTuple):
    """One .test file."""

    path: str
    arguments: Dict[str, str]  # of roslaunch: those that were given, and that the file declares
    points: Dict[str, Dict[str, float]]  # by the name of each mission_test in the file, and by that of a condition
    patience: float  # [s] of the wall clock, until a run is ended

    @property
    def name(self) -> str:
        """The name of the file without its ending."""
        return pathlib.Path(self.path).stem


def load(folder: str, given: Mapping[str, str]) -> List[HiddenTest]:
    """The .test files of a folder, in the order of their names.

    Args:
        folder: path.
        given: arguments for the files, by their names.

    Raises:
        ConfigError: a file cannot be read, or marks nothing, or no file declares an argument.
    """
    paths = sorted(pathlib.Path(folder).glob('*.test'))
    if not paths:
        raise ConfigError(f'{folder}: has no .test file: give the folder of the hidden tests')
    tests = [_load(path, given) for path in paths]
    for name in given:
        if not any(name in test.arguments for test in tests):
            raise ConfigError(f'{name}:= is no argument of any .test file in {folder}')
    return tests


def _load(path: pathlib.Path, given: Mapping[str, str]) -> HiddenTest:
    try:
        root = ElementTree.parse(str(path)).getroot()
    except (OSError, ElementTree.ParseError) as error:
        raise ConfigError(f'{path}: {error}') from error
    declared = {arg.attrib['name']: arg.attrib.get('value', arg.attrib.get('default', '')) for arg in root.iter('arg')
                if 'name' in arg.attrib and arg in list(root)}
    arguments = {name: value for name, value in given.items() if name in declared}
    values = {**declared, **arguments}
    tests = [test for test in root.iter('test') if test.attrib.get('type') == MISSION_TEST]
    points = {_resolved(test.attrib.get('test-name', ''), values): _points(path, test, values) for test in tests}
    if not points:
        raise ConfigError(f'{path}: has no <test pkg="rumba_evaluation" type="{MISSION_TEST}">: nothing earns points')
    limit = sum(float(_resolved(test.attrib.get('time-limit', str(USUAL_LIMIT)), values)) for test in root.iter('test'))
    return HiddenTest(str(path.resolve()), arguments, points, START + limit)


def _points(path: pathlib.Path, test: ElementTree.Element, values: Mapping[str, str]) -> Dict[str, float]:
    known = names(Requirements)
    parameters: Dict[str, Any] = {}
    for param in test.iter('param'):
        if param.attrib.get('name') in known and 'value' in param.attrib:
            parameters[param.attrib['name']] = _typed(_resolved(param.attrib['value'], values), param.attrib['name'])
    where = f'{path}: {test.attrib.get("test-name", "test")}'
    try:
        requirements = updated(Requirements(), parameters, where)
        return Scheme(requirements.conditions(), requirements.points, requirements.partial).points
    except ConfigError as error:
        raise ConfigError(f'{error}' if where in f'{error}' else f'{where}: {error}') from None


def _typed(text: str, name: str) -> Any:
    """A value as roslaunch would read it."""
    usual = getattr(Requirements(), name)
    if isinstance(usual, str):
        return text
    if text.lower() in ('true', 'false'):
        return text.lower() == 'true'
    try:
        return int(text) if re.fullmatch(r'[+-]?\d+', text.strip()) else float(text)
    except ValueError:
        return text


def _resolved(text: str, values: Mapping[str, str]) -> str:
    """A text of a launch file with the values of its arguments."""
    return re.sub(r'\$\(arg (\w+)\)', lambda match: values.get(match.group(1), match.group(0)), text)


def all_points(tests: Sequence[HiddenTest]) -> Dict[str, float]:
    """Points by the names of test and condition, with a dot between them."""
    return {f'{name}.{condition}': points for test in tests for name, each in test.points.items()
            for condition, points in each.items()}
