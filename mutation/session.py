"""One module under cosmic-ray: its faults are planted one after another in a copy of the checkout, and judged there."""

import json
import os
import pathlib
import subprocess
import sys
from typing import Any, Dict, Iterable, Iterator, List, NamedTuple, Optional

from mutation.judges import Judged

# Seconds that the tests of one fault may take, as a multiple of what they take without one, and beside it: an endless
# loop is a fault that is found.
SLOWER, START = 3.0, 20.0
CONFIG = """\
[cosmic-ray]
module-path = {module!r}
timeout = {timeout:.0f}
excluded-modules = []
test-command = {command!r}

[cosmic-ray.distributor]
name = "local"

[cosmic-ray.filters.operators-filter]
exclude-operators = {excluded}
"""
# Of the operators of cosmic-ray: one opposite for each sign and each comparison. The others plant the same again,
# or such as fail at once, as a shift of a float, or such as no test can find, as > for >= between measured numbers.
EXCLUDED = [
    r'core/ReplaceBinaryOperator_(?!(Add_Sub|Sub_Add|Mul_Div|Div_Mul|FloorDiv_Mul|Mod_Mul|BitAnd_BitOr|BitOr_BitAnd'
    r'|LShift_RShift|RShift_LShift)$)',
    r'core/ReplaceComparisonOperator_(?!(Eq_NotEq|NotEq_Eq|Lt_GtE|LtE_Gt|Gt_LtE|GtE_Lt|Is_IsNot|IsNot_Is)$)',
    r'core/ReplaceUnaryOperator_(USub_Invert|USub_Not|Invert_)',
    r'core/RemoveDecorator',
]


class Fault(NamedTuple):
    """A fault that was planted: where, which, and whether a test failed (None: not planted yet)."""

    line: int
    operator: str
    is_found: Optional[bool]
    change: str  # the lines that differ, as a unified diff


class Session:
    """The faults of one module."""

    def __init__(self, judged: Judged, copy: pathlib.Path, tools: pathlib.Path) -> None:
        """`copy` is a checkout that may be changed, `tools` the folder of cosmic-ray's commands."""
        self._judged = judged
        self._copy = copy
        self._tools = tools
        self._config = copy / f'{judged.name}.toml'
        self._data = copy / f'{judged.name}.sqlite'

    def draw(self, most: int, seed: int, usual: float) -> None:
        """Find the faults that can be planted, and draw at most so many; the tests take `usual` [s] without one."""
        self._config.write_text(CONFIG.format(
            module=str(self._copy / self._judged.path), timeout=SLOWER * usual + START,
            command=' '.join(tests(self._judged, self._copy)), excluded=json.dumps(EXCLUDED)))
        self._run('cosmic-ray', 'init', self._config, self._data)
        self._run('cr-filter-operators', self._data, self._config)
        self._run('python', pathlib.Path(__file__).with_name('draw.py'), self._data, most, seed)

    def start(self) -> 'subprocess.Popen[bytes]':
        """Plant one fault after another, in the background."""
        return subprocess.Popen([self._tools / 'cosmic-ray', 'exec', self._config, self._data], cwd=self._copy,
                                env=_environment(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def faults(self) -> List[Fault]:
        """Those that were drawn."""
        shown = self._run('cosmic-ray', 'dump', self._data)
        return list(faults_of(shown.splitlines()))

    def _run(self, command: str, *arguments: Any) -> str:
        return subprocess.run([self._tools / command, *map(str, arguments)], cwd=self._copy, env=_environment(),
                              check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, universal_newlines=True
                              ).stdout


def tests(judged: Judged, copy: pathlib.Path) -> List[str]:
    """The command that runs the tests of a module in a copy of the checkout, with the sources of the copy."""
    sources = [str(path) for path in sorted(copy.glob('rumba_*/src'))]
    # No bytecode: a fault may leave the size of the source as it was, and the second in which it was written.
    return ['env', 'PYTHONDONTWRITEBYTECODE=1', f"PYTHONPATH={os.pathsep.join([*sources, os.environ['PYTHONPATH']])}",
            sys.executable, '-m', 'pytest', '-xq', '-n0', '-p', 'no:cacheprovider', *judged.test_paths]


def _environment() -> Dict[str, str]:
    """That of cosmic-ray, which would find older libraries on the path of ROS."""
    return {name: value for name, value in os.environ.items() if name != 'PYTHONPATH'}


def faults_of(lines: Iterable[str]) -> Iterator[Fault]:
    """The faults in lines of `cosmic-ray dump`, without those that were not drawn."""
    for item, result in map(json.loads, lines):
        result = result or {}
        if result.get('worker_outcome') == 'skipped':
            continue
        mutation = item['mutations'][0]
        outcome = result.get('test_outcome')
        yield Fault(mutation['start_pos'][0], mutation['operator_name'].split('/')[-1],
                    None if outcome is None else outcome != 'survived', result.get('diff') or '')
