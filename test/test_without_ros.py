"""What pip installs runs without ROS: the page that says so, in an environment in which no module of ROS can be found.

Nothing is fetched: the libraries and setuptools are those of the system. Ubuntu 22.04 has a setuptools that knows
nothing of pyproject.toml; there, pip would fetch a newer one.
"""

import os
import re
import shutil
import subprocess
import sys
import tarfile

import pytest
from consoles import play
from workspaces import ROOT, Space

pytest.importorskip('setuptools', minversion='61.2')

PAGE = ROOT / 'docs' / 'without_ros.md'
PURE = ('rumba_sim', 'rumba_localisation', 'rumba_cleaning', 'rumba_evaluation')
NEEDED = (*PURE, 'pyproject.toml', 'setup.py', 'MANIFEST.in', 'docs/without_ros.md', 'LICENSE')
NO_ROS = """
import re, sys
ROS = re.compile('(rospy|roslib|rospkg|rosgraph|rosbag|rostopic|genpy|catkin_pkg|actionlib|tf2_ros|.*_msgs?|PyQt5)$')
class NoRos:
    def find_spec(self, name, path=None, target=None):
        if ROS.match(name):
            raise ModuleNotFoundError(f'{name} is of ROS', name=name)
sys.meta_path.insert(0, NoRos())
"""


@pytest.fixture(scope='module')
def sources(tmp_path_factory):
    """A copy of the sources, since pip builds in their folder."""
    sources = tmp_path_factory.mktemp('sources')
    for name in NEEDED:
        (sources / name).parent.mkdir(exist_ok=True)
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, sources / name, ignore=shutil.ignore_patterns('__pycache__'))
        else:
            shutil.copy(ROOT / name, sources / name)
    return sources


@pytest.fixture(scope='module')
def venv(tmp_path_factory, sources):
    """A virtual environment with what pip installs from the sources, without a network, and without ROS."""
    venv = tmp_path_factory.mktemp('without_ros') / 'venv'
    subprocess.check_call([sys.executable, '-m', 'venv', '--system-site-packages', str(venv)], env=environment())
    subprocess.check_call([f'{venv}/bin/pip', 'install', '-q', '--no-index', '--no-deps', '--no-build-isolation', '.'],
                          cwd=sources, env=environment())
    [packages] = venv.glob('lib/python3*/site-packages')
    for name in PURE:  # what ./rumba has compiled of the same sources, which takes pip's users a minute
        for path in (ROOT / name / 'src').rglob('*.nb[ci]'):
            shutil.copy(path, packages / path.relative_to(ROOT / name / 'src'))
    (packages / 'no_ros.py').write_text(NO_ROS)
    (packages / 'no_ros.pth').write_text('import no_ros\n')
    return venv


def environment():
    """The environment of somebody who has never heard of ROS."""
    return {name: value for name, value in os.environ.items()
            if 'ROS' not in name and name not in ('PYTHONPATH', 'CMAKE_PREFIX_PATH')}


LICENSE = """
from importlib.metadata import metadata
rumba = metadata('rumba')
print(rumba.get('License-Expression') or rumba['License'])
"""
IMPORTS = """
import importlib, sys
for name in sys.argv[1:]:
    try:
        importlib.import_module(name)
    except ImportError as error:  # of the extra `gym`, or stable-baselines3, which need not be installed
        assert name.startswith('rumba_evaluation.learning.') and 'needs' in str(error), name
        assert "pip install 'gymnasium" in str(error) or 'pip install stable-baselines3' in str(error), name
try:
    import rospy
except ImportError:
    print(len(sys.argv) - 1)
"""


def modules(folder):
    """The Python files below a folder, by their path in it, but those that need ROS."""
    return {str(path.relative_to(folder)) for path in folder.glob('**/*.py')
            if 'ros' not in path.relative_to(folder).parts[:-1]}


def run(venv, *command, **options):
    """What a command of the environment prints; it must succeed."""
    return subprocess.run([str(venv / 'bin' / command[0]), *command[1:]], env=environment(), check=True,
                          stdout=subprocess.PIPE, universal_newlines=True, **options).stdout


def programs():
    """The Python programs on the page."""
    return re.findall(r'^```python\n(.*?)^```$', PAGE.read_text(), re.MULTILINE | re.DOTALL)


@pytest.mark.thorough
def test_pip_installs_the_same_modules_as_catkin_and_nothing_that_needs_ros(venv):
    [packages] = venv.glob('lib/python3*/site-packages')
    for name in PURE:
        installed = {str(path.relative_to(packages / name)) for path in (packages / name).glob('**/*.py')}
        assert installed - {'maps/make_maps.py'} == modules(ROOT / name / 'src' / name) and len(installed) > 3
    version = re.search(r'<version>(.*)</version>', (ROOT / 'rumba_evaluation' / 'package.xml').read_text()).group(1)
    assert f'Version: {version}\n' in run(venv, 'pip', 'show', 'rumba')
    assert run(venv, 'python', '-c', LICENSE) == 'BSD-3-Clause\n'


def test_the_source_distribution_holds_what_it_is_built_from_and_no_tests(sources, tmp_path):
    (sources / 'test').mkdir()
    (sources / 'test' / 'test_of_rumba.py').touch()
    program = 'import sys; from setuptools import build_meta; build_meta.build_sdist(sys.argv[1])'
    subprocess.check_call([sys.executable, '-c', program, str(tmp_path)], cwd=sources, env=environment(),
                          stdout=subprocess.DEVNULL)
    [path] = tmp_path.iterdir()
    with tarfile.open(str(path)) as archive:
        names = {name.partition('/')[2] for name in archive.getnames()}
    assert {*NEEDED[len(PURE):], 'rumba_evaluation/package.xml', 'rumba_sim/maps/studio.yaml'} <= names
    assert sorted(name for name in names if name.split('/')[0] == 'test') == []
    of_packages = {f'{name}/src/{name}/{path}' for name in PURE for path in modules(ROOT / name / 'src' / name)}
    assert of_packages <= names


def test_every_module_can_be_imported_without_ros(venv):
    [packages] = venv.glob('lib/python3*/site-packages')
    names = sorted(path[:-3].replace('/', '.').replace('.__init__', '')
                   for name in PURE for path in (f'{name}/{module}' for module in modules(packages / name)))
    assert run(venv, 'python', '-c', IMPORTS, *names) == f'{len(names)}\n'


@pytest.mark.thorough
def test_the_commands_of_the_page_print_what_it_shows(venv, tmp_path):
    play(PAGE, Space([], environment(), f'cd {tmp_path}; PATH={venv}/bin:$PATH;'))


@pytest.mark.thorough
def test_the_map_becomes_a_picture_in_ten_lines(venv, tmp_path):
    program, _ = programs()
    promised, picture = re.search(r'It prints `(.*)`, and the picture is `(.*)`\.', PAGE.read_text()).groups()
    assert len(program.splitlines()) <= 10
    printed = run(venv, 'python', '-c', program, cwd=tmp_path)
    assert re.fullmatch('.*'.join(map(re.escape, promised.split('...'))) + '\n', printed)
    assert [path.name for path in tmp_path.iterdir()] == [picture]


def test_many_worlds_advance_as_the_page_shows(venv, tmp_path):
    _, program = programs()
    assert 'range(1000)' in program
    printed = run(venv, 'python', '-c', program.replace('range(1000)', 'range(20)'), cwd=tmp_path)
    mean, most = map(float, re.fullmatch(r'(.*) % swept on average, (.*) % at most\n', printed).groups())
    assert 5.0 < mean < most < 50.0


def test_the_public_module_is_there(venv):
    assert run(venv, 'python', '-c', 'import rumba; print(rumba.load_map("studio").columns > 0)') == 'True\n'
    [packages] = venv.glob('lib/python3*/site-packages')
    assert all((packages / name / 'py.typed').exists() for name in ('rumba', *PURE))


def test_a_bag_is_refused_in_one_line(venv, tmp_path):
    (tmp_path / 'path.bag').write_bytes(b'#ROSBAG V2.0\n')
    process = subprocess.run([str(venv / 'bin' / 'rumba-evaluate'), '--maps', 'studio', '--path', 'path.bag'],
                             env=environment(), cwd=tmp_path, stderr=subprocess.PIPE, universal_newlines=True)
    assert (process.returncode, process.stderr.count('\n')) == (2, 1) and 'to read bags needs ROS' in process.stderr


def test_the_versions_of_the_packages_are_one():
    versions = {re.search(r'<version>(.*)</version>', (ROOT / name / 'package.xml').read_text()).group(1)
                for name in PURE}
    assert len(versions) == 1
