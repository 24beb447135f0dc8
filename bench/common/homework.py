"""How homework is made: from the starter package or the solution of an exercise, and what is changed in it."""

import pathlib
import shutil
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXERCISES = ROOT / 'rumba_exercises'
STATUS, BUMPER = '1_status', '2_bumper'
GOOD, WRONG, HOSTILE = 'good', 'wrong', 'hostile'
MARKER = 'left_behind_by_a_submission'  # name of files that hostile ones write wherever they can
SLEEP = 43211  # [s] of processes that hostile ones leave behind
MAKERS = {GOOD: [], WRONG: [], HOSTILE: []}
PACKAGES = {STATUS: ('status_exercise', 'status'), BUMPER: ('bumper_exercise', 'cleaner')}

MANIFEST = '''<package format="3">
  <name>{name}</name><version>0.1.0</version><description>Mine.</description>
  <maintainer email="me@example.org">Me</maintainer><license>BSD-3-Clause</license>
  <buildtool_depend>catkin</buildtool_depend>
  {depends}
</package>
'''
CMAKE = '''cmake_minimum_required(VERSION 3.5)
project({name})
find_package(catkin REQUIRED COMPONENTS {components})
{messages}catkin_package({package})
include_directories(${{catkin_INCLUDE_DIRS}})
{rest}
'''


def made(kind, exercise):
    """Register a maker, which gets a folder with the starter package and, if it is to be good, the solution."""
    def register(maker):
        MAKERS[kind].append((exercise, maker))
        return maker
    return register


def script(path):
    """The script of a submission."""
    [found] = path.glob('*/scripts/*')
    return found


def package(path):
    """The package of a submission."""
    [found] = path.glob('*/package.xml')
    return found.parent


def replace(path, old, new):
    """Replace a text in the script of a submission."""
    text = script(path).read_text()
    assert old in text, (path, old)
    script(path).write_text(text.replace(old, new))


def first(path, code):
    """Begin the script of a submission by some code, after its first line."""
    head, _, rest = script(path).read_text().partition('\n')
    script(path).write_text(f'{head}\n{code}\n{rest}')


def cmake(folder, components, messages='', rest='', package_words=''):
    """Write the files of a package that is built."""
    name = folder.name
    (folder / 'CMakeLists.txt').write_text(CMAKE.format(
        name=name, components=components, messages=messages, rest=rest, package=package_words))
    depends = '\n  '.join(f'<depend>{each}</depend>' for each in components.split())
    (folder / 'package.xml').write_text(MANIFEST.format(name=name, depends=depends))


def in_cpp(path, source, node, components):
    """Make a submission one in C++."""
    own = package(path)
    shutil.rmtree(own / 'scripts')
    (own / 'src').mkdir()
    (own / 'src' / f'{node}.cpp').write_text(source)
    cmake(own, components, rest=f'add_executable({node} src/{node}.cpp)\n'
                                f'target_link_libraries({node} ${{catkin_LIBRARIES}})')


def zipped(path, place=''):
    """Put a submission into an archive, in its place."""
    with zipfile.ZipFile(f'{path}.zip', 'w') as archive:
        for each in sorted(path.rglob('*')):
            archive.write(each, pathlib.Path(place) / each.relative_to(path))
    shutil.rmtree(path)


def solved(path, exercise):
    """Put the solution over the starter package."""
    shutil.copytree(EXERCISES / exercise / 'solution', path, dirs_exist_ok=True)
