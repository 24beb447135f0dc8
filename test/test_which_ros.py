"""Which ROS 1 ./rumba uses, and what it installs with it: folders that are made up for this, and workspaces."""

import os
import pathlib
import shutil

import pytest
from checkouts import commands, make_checkout, on_system, rumba, write_package
from workspaces import ROOT, UNDERLAY, Workspace, clean_environment, sourced

BOOKWORM = ('bookworm', 'Debian GNU/Linux 12 (bookworm)')
FOCAL = ('focal', 'Ubuntu 20.04.6 LTS')
NOBLE = ('noble', 'Ubuntu 24.04.3 LTS')
FEDORA = ('', 'Fedora Linux 40')
OWN = f'rumba: ROS 1 of {BOOKWORM[1]}'
ELSE = 'or source the setup file of a ROS 1 in another folder'
# As catkin's own setup files do, which leave a folder where it is.
ADDED = 'case :$CMAKE_PREFIX_PATH: in *:{0}:*) ;; *) export CMAKE_PREFIX_PATH={0}:$CMAKE_PREFIX_PATH ;; esac'
CORE = ('catkin', 'roscpp', 'rospy')
EVERY_PACKAGE_OF_ROS = sorted({
    words[2] for words in map(str.split, (ROOT / 'packages.txt').read_text().splitlines())
    if words and words[0] != '#' and words[2] not in ('=', '-')})


@pytest.fixture
def checkout(tmp_path):
    """A checkout with spaces in its path."""
    return make_checkout(tmp_path / 'a checkout')


@pytest.fixture
def opt(tmp_path):
    """An empty folder in the place of /opt/ros."""
    (tmp_path / 'opt').mkdir()
    return tmp_path / 'opt'


def prefix(folder, distribution='', packages=CORE, setup='', over=()):
    """A folder of catkin's kind, whose setup file leads to the ROS of this machine and to the folders below it."""
    for package in packages:
        (folder / 'share' / package).mkdir(parents=True)
    folder.mkdir(exist_ok=True)
    (folder / '.catkin').touch()
    lines = [*(f'. {path}' for path in UNDERLAY), f'export ROS_DISTRO={distribution}' if distribution else '',
             *(ADDED.format(path) for path in (*reversed(over), folder)), setup]
    (folder / 'setup.sh').write_text('\n'.join(lines) + '\n')
    return folder


def choose(checkout, opt, system=BOOKWORM, over=(), command='build'):
    """Exit code, what ./rumba says on stderr, and the packages for which it asks if dpkg has none."""
    folder = opt.parent
    asked = folder / 'asked'
    apt = f'#!/bin/sh\n[ "$1" = update ] || {{ echo "$*" >{asked}; exit 100; }}\n'
    path = commands(folder / 'bin', **{
        'apt-get': apt, 'id': '#!/bin/sh\necho 0\n', 'dpkg-query': '#!/bin/sh\nexit 1\n'})
    environment = {**on_system(folder, *system), 'CMAKE_PREFIX_PATH': ':'.join(map(str, over))}
    code, _, error = rumba(checkout, command, PATH=f'{path}:{os.environ["PATH"]}', **environment)
    lines = [line for line in error.splitlines() if not line.startswith('rumba: cannot install packages: ')]
    return code, lines, set(asked.read_text().split()) if asked.exists() else set()


def of_ros(asked):
    """The packages for ROS in a folder of its own among those that were asked for."""
    return {name for name in asked if name.startswith(('ros-one-', 'ros-noetic-'))}


@pytest.mark.parametrize('name, title', [('one', 'ROS One'), ('noetic', 'ROS Noetic')])
@pytest.mark.parametrize('system', [BOOKWORM, NOBLE, FEDORA], ids=str)
def test_ros_in_opt_is_taken_on_any_system_and_its_packages_bear_its_name(checkout, opt, name, title, system):
    prefix(opt / name, name)
    code, said, asked = choose(checkout, opt, system)
    assert (code, said) == (1, [f'rumba: {title} in {opt / name}'])
    assert {'cmake', 'python3-numba', f'ros-{name}-tf2-ros', f'ros-{name}-robot-state-publisher'} <= asked
    assert all(package.startswith(f'ros-{name}-') for package in of_ros(asked))
    # Those of the system, and those that are in the folder, are not asked for.
    assert not {'python3-rospy', 'libroscpp-dev', 'python3-tf2-msgs', 'catkin', '-', '=',
                *(f'ros-{name}-{package}' for package in CORE)} & asked


def test_ros_one_goes_before_noetic_and_what_is_sourced_before_both(checkout, opt, tmp_path):
    for name in ('one', 'noetic'):
        prefix(opt / name, name)
    assert choose(checkout, opt)[1] == [f'rumba: ROS One in {opt / "one"}']
    shutil.rmtree(str(tmp_path / 'bin'))
    mine = prefix(tmp_path / 'mine', packages=())  # which knows nothing of Noetic by itself, as after --extend
    code, said, asked = choose(checkout, opt, over=[mine, opt / 'noetic'])
    assert (code, said) == (1, [f'rumba: ROS Noetic in {mine} over {opt / "noetic"}, which is sourced'])
    assert 'ros-noetic-tf2-ros' in asked and 'ros-one-tf2-ros' not in asked and 'ros-noetic-rospy' not in asked


def test_without_another_the_ros_of_the_system_is_taken(checkout, opt):
    code, said, asked = choose(checkout, opt)
    assert (code, said) == (1, [OWN])
    assert {'catkin', 'python3-rospy', 'libroscpp-dev', 'python3-tf2-msgs'} <= asked and not of_ros(asked)


def test_a_sourced_workspace_over_the_ros_of_the_system_is_below_ours(checkout, opt, tmp_path):
    mine = prefix(tmp_path / 'mine', 'Debian', packages=['turtlesim'])
    code, said, asked = choose(checkout, opt, over=[mine])
    assert (code, said) == (1, [f'{OWN} below {mine}, which is sourced'])
    assert {'catkin', 'python3-rospy'} <= asked and not of_ros(asked)


@pytest.mark.parametrize('made, reason', [
    ({}, 'it has no setup.sh'),
    ({'packages': ['catkin', 'roscpp']}, 'it has no rospy'),
    ({'packages': []}, 'it has no catkin'),
    ({'setup': 'return 22'}, 'a setup file fails'),
    ({'setup': 'if ('}, 'a setup file fails'),
    ({'distribution': 'melodic'}, 'it is neither ROS One nor ROS Noetic, but ROS melodic')], ids=str)
def test_a_folder_without_ros_is_passed_over(checkout, opt, made, reason):
    if made:
        prefix(opt / 'noetic', **made)
    else:
        (opt / 'noetic').mkdir()
    code, said, asked = choose(checkout, opt)
    assert (code, said) == (1, [f'rumba: {opt / "noetic"} is passed over: {reason}', OWN])
    assert 'python3-rospy' in asked and not of_ros(asked)


def test_what_is_sourced_but_leads_to_no_ros_is_passed_over(checkout, opt, tmp_path):
    mine = prefix(tmp_path / 'mine', packages=['turtlesim'])
    prefix(opt / 'noetic')
    _, said, _ = choose(checkout, opt, FOCAL, over=[mine])
    assert said == [f'rumba: {mine}, which is sourced, is passed over: it has no catkin',
                    f'rumba: ROS Noetic in {opt / "noetic"}']


def test_neither_folders_of_others_nor_workspaces_over_one_of_rumba_are_below_ours(checkout, opt, tmp_path):
    conda = tmp_path / 'conda'
    conda.mkdir()
    ours = prefix(tmp_path / 'clone' / '.ws' / 'devel')
    (tmp_path / 'clone' / '.ws' / 'checkout').touch()
    lesson = prefix(tmp_path / 'lesson', packages=[], over=[ours])
    noetic = prefix(opt / 'noetic', 'noetic')
    _, said, _ = choose(checkout, opt, over=[conda, lesson, ours, noetic])
    assert said == [f'rumba: ROS Noetic in {noetic}, which is sourced']


@pytest.mark.parametrize('system, error', [
    (FOCAL, f'Ubuntu 20.04.6 LTS has no ROS 1 of its own: install ROS Noetic, ros-noetic-ros-base, {ELSE}'),
    (NOBLE, f'Ubuntu 24.04.3 LTS has no ROS 1 of its own: install ROS One, ros-one-ros-base, {ELSE}'),
    (FEDORA, 'Fedora Linux 40 is not supported: Debian 12 and 13 and Ubuntu 22.04 are with ROS 1 of their own, '
             f'Ubuntu 20.04 with ROS Noetic, Ubuntu 24.04 with ROS One; {ELSE}')])
def test_a_system_without_ros_is_told_what_would_do(checkout, opt, system, error):
    assert choose(checkout, opt, system) == (2, [f'rumba: {error}'], set())
    assert not (checkout / '.ws').exists()


def test_debian_packages_are_made_for_the_ros_of_the_system_alone(checkout, opt):
    prefix(opt / 'one')
    code, said, asked = choose(checkout, opt, command='deb')
    assert (code, asked, said[1:]) == (2, set(), [
        'rumba: Debian packages are made for the ROS 1 of Debian 12 and 13 and Ubuntu 22.04, not for ROS One in '
        f'{opt / "one"}'])


def test_a_ros_that_was_built_from_source_serves_without_packages(checkout, opt, tmp_path):
    one = prefix(opt / 'one', 'one', EVERY_PACKAGE_OF_ROS)
    environment = {'RUMBA_OPT_ROS': str(opt), 'CMAKE_PREFIX_PATH': '', 'XDG_CACHE_HOME': str(tmp_path / 'cache')}
    command = 'rospack find sample; echo $CMAKE_PREFIX_PATH'
    code, out, error = rumba(checkout, 'shell', 'sh', '-c', command, **environment)
    assert code == 0, error
    workspace = (checkout / '.ws').resolve()
    found, path = out.splitlines()
    assert (found, path.split(':')[:2]) == (str(workspace / 'src' / 'sample'), [str(workspace / 'devel'), str(one)])
    assert f'rumba: ROS One in {one}' in error.splitlines()


@pytest.mark.thorough
def test_a_package_of_a_sourced_workspace_is_used_and_without_it_all_is_built_again(checkout, tmp_path):
    write_package(tmp_path / 'original' / 'lacking')
    mine = Workspace(tmp_path / 'mine', [tmp_path / 'original' / 'lacking'], clean_environment())
    mine.make()
    command = mine.path / 'devel' / 'bin' / 'rosclean'
    command.parent.mkdir()
    command.write_text('#!/bin/sh\n')
    command.chmod(0o755)
    write_package(checkout / 'compat' / 'lacking')
    (checkout / 'compat' / 'CATKIN_IGNORE').touch()
    cache = {'XDG_CACHE_HOME': str(tmp_path / 'cache')}

    def found(**environment):
        code, out, error = rumba(checkout, 'shell', 'sh', '-c', 'rospack find lacking; command -v rosclean',
                                 **cache, **environment)
        assert code == 0, error
        assert ('rumba: building' in error, 'which is sourced' in error) == (True, bool(environment))
        return out.splitlines()

    here = sourced((mine.setup('devel'),), clean_environment())
    # What is sourced stands in PATH; behind the folder of the system, it would be hidden by that.
    assert found(**{**here, 'PATH': f'/usr/bin:{here["PATH"]}'}) == [str(mine.path / 'src' / 'lacking'), str(command)]
    source = pathlib.Path(found()[0])
    assert source == (checkout / '.ws').resolve() / 'src' / 'lacking'
    assert not (source.parents[1] / 'devel' / 'bin').exists()
