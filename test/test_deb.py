"""./rumba deb: what is in the packages, and that nothing in them comes from the machine that built them."""

import os
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import pytest
from workspaces import BELOW, BUILD_TIMEOUT, OURS, ROOT, WS, clean_environment

sys.path.insert(0, str(ROOT / 'packaging'))
import debian_names  # noqa: E402
from catkin_pkg.package import parse_package_string  # noqa: E402

DATE = '1700000000'
MODULES = './usr/lib/python3/dist-packages/'
OF_WORKSPACES = {'setup.sh', 'setup.bash', 'setup.zsh', 'local_setup.sh', 'env.sh', '_setup_util.py', '.catkin',
                 '.rosinstall'}
ON_REQUEST = pytest.mark.skipif(
    'RUMBA_TRY_DEBS' not in os.environ,
    reason='takes root, debootstrap, the network and minutes: RUMBA_TRY_DEBS=MIRROR asks for it')


def run(*command, **options):
    """Exit code, output and error output of a command."""
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          universal_newlines=True, timeout=BUILD_TIMEOUT, **options)
    return done.returncode, done.stdout, done.stderr


def make(checkout, folder, **environment):
    """The packages of a checkout by the name of the package of ROS."""
    code, out, error = run(checkout / 'rumba', 'deb', folder,
                           env={**clean_environment(), 'SOURCE_DATE_EPOCH': DATE, **environment})
    assert code == 0, error
    debs = {path.name: path for path in folder.iterdir()}
    assert sorted(line for line in out.splitlines() if line.endswith('.deb')) == sorted(map(str, debs.values()))
    return {name.split('_')[0][len('ros-'):].replace('-', '_'): path for name, path in debs.items()}


@pytest.fixture(scope='module')
def debs(tmp_path_factory):
    """The packages of this checkout, beside those of another release."""
    if BELOW:
        pytest.skip('Debian packages are made for the ROS of the system')
    folder = tmp_path_factory.mktemp('debs')
    (folder / 'ros-rumba-msg_0.0.1_all.deb').touch()
    return make(ROOT, folder)


def control(deb):
    """The fields for dpkg."""
    lines = run('dpkg-deb', '-f', deb)[1].replace('\n ', ' ').splitlines()
    return dict(line.split(': ', 1) for line in lines)


def names(field):
    """The names in a field of dependencies, without versions."""
    return [name.split()[0] for name in field.split(', ')] if field else []


def contents(deb):
    """Permissions, owner and path of all that is in a package."""
    for line in run('dpkg-deb', '-c', deb)[1].splitlines():
        mode, owner, *_, path = line.split()
        yield mode, owner, path


@pytest.mark.thorough
def test_each_package_becomes_one_with_its_name_version_and_words(debs):
    assert sorted(debs) == [path.name for path in OURS]
    for package in OURS:
        root = ElementTree.parse(str(package / 'package.xml')).getroot()
        fields, version = control(debs[package.name]), root.findtext('version')
        name = 'ros-' + package.name.replace('_', '-')
        assert debs[package.name].name == f'{name}_{version}_all.deb'
        assert (fields['Package'], fields['Version'], fields['Architecture']) == (name, version, 'all')
        assert fields['Description'].endswith(root.findtext('description'))
        assert fields['Maintainer'] == f'{root.findtext("maintainer")} <{root.find("maintainer").get("email")}>'


@pytest.mark.thorough
def test_packages_need_what_they_declare_under_its_name_in_debian(debs):
    # Messages come with their modules and, for those who compile against them, with headers.
    assert names(control(debs['rumba_msg'])['Depends']) == [
        'libactionlib-msgs-dev', 'libgeometry-msgs-dev', 'libstd-msgs-dev', 'python3', 'python3-actionlib-msgs',
        'python3-geometry-msgs', 'python3-std-msgs', 'ros-actionlib-msgs', 'ros-geometry-msgs', 'ros-message-runtime',
        'ros-std-msgs']
    versions = {name: control(deb)['Version'] for name, deb in debs.items()}
    assert control(debs['rumba_launch'])['Depends'] == ', '.join([
        'python3', 'python3-roslaunch', 'ros-robot-state-publisher',
        *(f'ros-{name.replace("_", "-")} (= {version})' for name, version in sorted(versions.items())
          if name != 'rumba_launch')])
    # What users type, beside what the nodes import; what is optional.
    assert {'rosbash', 'python3-rostopic', 'python3-rosmsg'} <= {*names(control(debs['rumba_sim'])['Recommends'])}
    assert {control(deb).get('Suggests', '') for deb in debs.values()} == {'', 'rviz'}


@pytest.mark.thorough
def test_apt_knows_all_that_the_packages_need(debs):
    found = [control(deb) for deb in debs.values()]
    needed = {name for fields in found for name in names(fields['Depends']) + names(fields.get('Recommends', ''))}
    code, out, error = run('apt-cache', 'show', '--no-all-versions',
                           *(needed - {fields['Package'] for fields in found}))
    assert code == 0 and 'N: Unable to locate' not in error, error
    assert {line[len('Package: '):] for line in out.splitlines() if line.startswith('Package: ')} == {
        *needed} - {fields['Package'] for fields in found}


@pytest.mark.thorough
def test_each_file_is_root_s_below_usr_and_in_a_place_that_bears_the_name_of_its_package(debs):
    for name, deb in debs.items():
        for mode, owner, path in contents(deb):
            assert owner == 'root/root' and path.startswith(('./', './usr/')), path
            if not path.endswith('/'):
                assert mode in ('-rw-r--r--', '-rwxr-xr-x'), path
                assert f'/{name}' in path or f'/ros-{name.replace("_", "-")}/' in path, path
                assert path.rsplit('/', 1)[1] not in OF_WORKSPACES and not path.endswith(('.pyc', '.nbi', '.nbc'))
            else:
                assert mode == 'drwxr-xr-x' and not path.endswith('__pycache__/'), path


@pytest.mark.thorough
def test_scripts_modules_messages_headers_and_maps_are_where_ros_of_debian_looks(debs):
    files = {name: {path: mode for mode, _, path in contents(deb)} for name, deb in debs.items()}
    for package in OURS:
        assert f'./usr/share/{package.name}/package.xml' in files[package.name]
        assert f'./usr/share/doc/ros-{package.name.replace("_", "-")}/copyright' in files[package.name]
        for script in package.glob('scripts/*'):
            assert files[package.name][f'./usr/lib/{package.name}/{script.name}'] == '-rwxr-xr-x'
        for module in package.glob('src/**/*.py'):
            assert MODULES + str(module.relative_to(package / 'src')) in files[package.name]
    assert {f'{MODULES}rumba_msg/msg/_BatteryStatus.py', './usr/share/rumba_msg/msg/BatteryStatus.msg',
            './usr/include/rumba_msg/BatteryStatus.h'} <= {*files['rumba_msg']}
    assert './usr/share/rumba_sim/maps/apartment.yaml' in files['rumba_sim']
    assert './usr/share/rumba_launch/launch/demo.launch' in files['rumba_launch']


@pytest.mark.thorough
def test_no_file_names_a_folder_of_the_machine_and_all_have_their_sums(debs, tmp_path):
    for name, deb in debs.items():
        assert run('dpkg-deb', '-R', deb, tmp_path / name)[0] == 0
        files = [path for path in (tmp_path / name).glob('**/*') if path.is_file()]
        for path in files:
            for folder in (ROOT, WS, os.path.expanduser('~') + '/', '/.ws'):
                assert str(folder).encode() not in path.read_bytes(), path
        assert run('md5sum', '--check', '--strict', 'DEBIAN/md5sums', cwd=tmp_path / name)[0] == 0
        assert len((tmp_path / name / 'DEBIAN' / 'md5sums').read_text().splitlines()) == len(
            [path for path in files if path.parent.name != 'DEBIAN'])


@pytest.mark.thorough
def test_modules_are_compiled_by_the_python_that_runs_them_and_that_is_undone(debs, tmp_path):
    run('dpkg-deb', '-e', debs['rumba_sim'], tmp_path / 'sim')
    assert 'py3compile -p ros-rumba-sim\n' in (tmp_path / 'sim' / 'postinst').read_text()
    assert 'find /usr/lib/python3/dist-packages/rumba_sim ' in (tmp_path / 'sim' / 'prerm').read_text()
    run('dpkg-deb', '-e', debs['rumba_launch'], tmp_path / 'launch')
    assert sorted(os.listdir(str(tmp_path / 'launch'))) == ['control', 'md5sums']


@pytest.mark.thorough
def test_nodes_find_our_definitions_below_a_rumba_msg_of_a_lesson(debs, tmp_path):
    for deb in debs.values():
        assert run('dpkg-deb', '-x', deb, tmp_path)[0] == 0
    for folder in ('', 'msg', 'srv'):
        (tmp_path / 'lesson' / 'rumba_msg' / folder).mkdir(parents=True, exist_ok=True)
        (tmp_path / 'lesson' / 'rumba_msg' / folder / '__init__.py').touch()
    environment = {**clean_environment(), 'PYTHONPATH': f'{tmp_path}/lesson:{tmp_path}/{MODULES}'}
    for node in ('rumba_sim/simulator', 'rumba_localisation/localiser', 'rumba_cleaning/cleaner', 'rumba_viewer/page',
                 'rumba_evaluation/mission_report'):
        code, out, error = run(tmp_path / 'usr' / 'lib' / node, '--help', env=environment)
        assert code == 0 and out, error


@pytest.mark.thorough
def test_another_checkout_gives_the_same_bytes(debs, tmp_path):
    checkout = tmp_path / 'a checkout'
    for name in ('packaging', 'rumba_msg', 'rumba_sim'):
        shutil.copytree(str(ROOT / name), str(checkout / name), copy_function=shutil.copyfile)
    for name in ('LICENSE', 'packages.txt', 'rumba'):
        shutil.copyfile(str(ROOT / name), str(checkout / name))
    for path in (checkout / 'rumba', *checkout.glob('*/scripts/*')):
        path.chmod(0o700)
    again = make(checkout, tmp_path / 'debs', XDG_CACHE_HOME=str(tmp_path / 'cache'), TZ='Asia/Tokyo', LC_ALL='C')
    assert sorted(again) == ['rumba_msg', 'rumba_sim']
    assert [name for name, deb in again.items() if deb.read_bytes() != debs[name].read_bytes()] == []


def test_a_folder_that_cannot_be_written_and_two_folders_are_refused(tmp_path):
    (tmp_path / 'file').touch()
    for folder in (tmp_path / 'file', tmp_path / 'file' / 'below', '/proc/debs'):
        assert run(ROOT / 'rumba', 'deb', folder) == (
            2, '', f'rumba: cannot write to {folder}: give a folder that exists or can be made\n')
    assert run(ROOT / 'rumba', 'deb', 'a', 'b') == (2, '', 'rumba: deb takes one folder for the packages: a b\n')


def test_a_dependency_without_a_name_in_debian_is_refused():
    text = (ROOT / 'rumba_launch' / 'package.xml').read_text().replace('turtlesim', 'turtlsim')
    package = parse_package_string(text)
    package.filename = 'package.xml'
    with pytest.raises(ValueError, match='package.xml: no Debian package is known for turtlsim: add it to p'):
        debian_names.DebianNames({path.name: '0.1.0' for path in OURS}).relations(package)


@pytest.mark.parametrize('arguments, message', [
    ([], 'give the folder for a new Debian 12, which must not exist'),
    (['/tmp'], '/tmp exists: give a folder that does not')])
@pytest.mark.parametrize('script', [
    'packaging/try_debs', 'packaging/try_first_minutes', 'rumba_exercises/ci/try_dockerfile'])
def test_a_bare_debian_is_made_only_where_nothing_is(script, arguments, message):
    assert run(ROOT / script, *arguments) == (2, '', f'{script.rpartition("/")[2]}: {message}\n')


@ON_REQUEST
def test_the_packages_serve_in_a_bare_debian_and_leave_nothing_behind(tmp_path):
    folder = tmp_path / 'debian'
    done = subprocess.run([str(ROOT / 'packaging' / 'try_debs'), str(folder), os.environ['RUMBA_TRY_DEBS']],
                          timeout=4 * BUILD_TIMEOUT)
    assert done.returncode == 0
    shutil.rmtree(str(folder))
