"""The workspace of a submission: its packages, built if they need that, and the nodes that a test starts from it."""

import os
import pathlib
import re
import sys
from typing import Dict, List, Mapping, Optional, Sequence, Union

from rumba_evaluation.submissions import intake, sandbox, supervised
from rumba_evaluation.submissions.diagnosis.mistakes import Wanted
from rumba_evaluation.submissions.sandbox import Bubblewrap, Plain
from rumba_evaluation.submissions.supervised import Limits, Run, Stop

BUILT = re.compile(r'^\s*(add_executable|add_library|add_(message|service|action)_files|catkin_python_setup)\s*\(',
                   re.MULTILINE)
BUILD_PATIENCE = 300.0  # [s] of the wall clock
ENDS_WITHIN = 60.0  # [s] of the wall clock, of a shell that reads setup.bash
OWN = ('src', 'home', 'tmp', 'shm', 'log', 'ros')  # folders of a submission, beside what is built
PASSED_ON = re.compile(r'PATH|LANG|LC_\w+|TERM|PYTHONPATH|PYTHON\w+|CMAKE_PREFIX_PATH|LD_LIBRARY_PATH|PKG_CONFIG_PATH|'
                       r'ROS_\w+|ROSLISP_PACKAGE_DIRECTORIES|NUMBA_CACHE_DIR')
OF_THE_RUN = ('ROS_MASTER_URI', 'ROS_NAMESPACE')  # what roslaunch tells a node


class Problem(Exception):
    """A submission cannot run, in words."""


class Workspace:
    """A submission that was taken, in a folder of its own.

    Attributes:
        packages: their folders by their names.
        notes: what was left out, in words.
        log: what the build printed.
    """

    def __init__(self, folder: pathlib.Path, box: Union[Plain, Bubblewrap], stop: Stop = None) -> None:
        """Use a folder that may not exist yet."""
        self._folder, self._box, self._stop = folder, box, stop
        self.packages: Dict[str, pathlib.Path] = {}
        self.notes: List[str] = []
        self.log = ''
        for name in OWN:
            (folder / name).mkdir(parents=True)
        self._environment = self._passed_on(os.environ)

    @property
    def source(self) -> pathlib.Path:
        """Where the submission was copied to."""
        return self._folder / 'src' / 'submission'

    def take(self, source: str, wanted: Sequence[Wanted]) -> None:
        """Copy a submission, and build it if it needs that.

        Raises:
            Problem: it cannot be taken, has no package, or cannot be built.
        """
        try:
            self.notes += intake.take(source, self.source)
        except (intake.Refused, OSError) as error:
            raise Problem(str(error)) from error
        found = intake.packages(self.source)
        if not found and len(set(wanted)) == 1 and intake.as_package(self.source, *wanted[0]):
            found = intake.packages(self.source)
        if not found:
            raise Problem('the submission has no package.xml: it must hold a catkin package')
        for name, folder in found:
            self.packages.setdefault(name, folder)
        _make_executable(self.source)
        if any(path.is_file() and BUILT.search(path.read_text(errors='replace'))
               for path in self.source.rglob('CMakeLists.txt')):
            self._build()
        self._environment['ROS_PACKAGE_PATH'] = os.pathsep.join(
            [str(self.source), self._environment.get('ROS_PACKAGE_PATH', '')])

    def _build(self) -> None:
        python = sys.executable
        build = self._run(['catkin_make', '-j2', f'-DPYTHON_EXECUTABLE={python}', f'-DPython_EXECUTABLE={python}'],
                          BUILD_PATIENCE)
        self.log = build.output
        if build.code != 0 or build.stopped:
            raise Problem(f'it cannot be built: {build.stopped}' if build.stopped else 'it cannot be built')
        shell = self._run(['bash', '-c', '. devel/setup.bash && exec env -0'], ENDS_WITHIN)
        found = dict(line.split('=', 1) for line in shell.output.split('\0') if '=' in line)
        if 'PATH' not in found:
            raise Problem('its workspace cannot be sourced: see the log')
        self._environment = self._passed_on(found)

    def _run(self, command: Sequence[str], patience: float) -> Run:
        """Run a command in the folder of the submission, and in its environment."""
        return supervised.run(self._box.around_build(sandbox.clean(self._environment, command), str(self._folder)),
                              os.environ, str(self._folder.parent), Limits(patience), self._stop)

    def _passed_on(self, environment: Mapping[str, str]) -> Dict[str, str]:
        """What of an environment a submission gets: its own folders, and nothing that is secret."""
        kept = {name: value for name, value in environment.items() if PASSED_ON.fullmatch(name)}
        for name in (*OF_THE_RUN, 'ROS_IP'):
            kept.pop(name, None)
        own = self._folder
        return {**kept, 'PWD': str(own), 'HOME': str(own / 'home'),
                'TMPDIR': '/tmp' if self._box.is_closed else str(own / 'tmp'), 'ROS_HOME': str(own / 'ros'),
                'ROS_LOG_DIR': str(own / 'log'), 'ROS_HOSTNAME': 'localhost'}

    def executable(self, node: Wanted) -> Optional[pathlib.Path]:
        """The program of a node, as rosrun finds it; none if there is none."""
        built = self._folder / 'devel' / 'lib' / node.package / node.type
        if built.is_file():
            return built
        folder = self.packages.get(node.package)
        found = sorted(folder.rglob(node.type)) if folder is not None and '/' not in node.type else []
        return next((path for path in found if path.is_file() and os.access(str(path), os.X_OK)), None)

    def install(self, nodes: Sequence[Wanted], prefix: pathlib.Path) -> Dict[str, str]:
        """Make a prefix whose programs run nodes of the submission, as far as they are there, in the sandbox.

        Returns the paths of the nodes themselves, by those of the programs.
        """
        found = {}
        prefix.mkdir(parents=True)
        (prefix / '.catkin').write_text('')
        for node in nodes:
            manifest = prefix / 'share' / node.package / intake.MANIFEST
            manifest.parent.mkdir(parents=True, exist_ok=True)
            manifest.write_text(f'<package format="3"><name>{node.package}</name></package>\n')
            program = self.executable(node)
            if program is not None:
                path = prefix / 'lib' / node.package / node.type
                path.parent.mkdir(parents=True, exist_ok=True)
                command = self._box.around_node(sandbox.clean(self._environment, [str(program)]), str(self._folder))
                path.write_text(sandbox.script(command, OF_THE_RUN))
                path.chmod(0o755)
                found[str(path)] = str(program)
        return found


def _make_executable(folder: pathlib.Path) -> None:
    """Make scripts executable: archives and some file systems lose that."""
    for path in folder.rglob('*'):
        if path.is_file() and not path.is_symlink():
            with open(path, 'rb') as file:
                is_script = file.read(2) == b'#!'
            if is_script:
                path.chmod(0o755)
