"""What others expect of a project: hosted CI tests systems that are supported, and rosdep knows the keys."""

import re
import xml.etree.ElementTree

import pytest
import yaml
from catkin_pkg.package import parse_package
from workspaces import OURS, ROOT, STAND_INS, TUTORIALS

KEYS = yaml.safe_load((ROOT / 'packaging' / 'rosdep_keys.yaml').read_text())
WORKFLOW = yaml.safe_load((ROOT / '.github' / 'workflows' / 'test.yml').read_text())
WHICH_ROS = (ROOT / 'packaging' / 'which_ros.sh').read_text()
INSTALLED = [line.split()[1:] for line in (ROOT / 'packages.txt').read_text().splitlines() if re.match(r'\w', line)]
OF_PACKAGE = pytest.mark.parametrize('package', OURS + TUTORIALS, ids=lambda path: path.name)
# Packages of ROS have no entry in the lists: rosdep knows them by their release.
OF_ROS = {name for _, name in INSTALLED if name not in ('=', '-')}


def depends(package):
    """The keys of a package.xml, without those of this repository."""
    tags = xml.etree.ElementTree.parse(str(package / 'package.xml')).iter()
    keys = {tag.text for tag in tags if tag.tag == 'depend' or tag.tag.endswith('_depend')}
    return keys - {path.name for path in OURS + TUTORIALS}


@OF_PACKAGE
def test_rosdep_knows_each_key(package):
    of_base = {'genmsg'}  # of ROS too, and installed with the others
    known = OF_ROS | of_base | {*KEYS['read'], *KEYS['assumed']}
    assert depends(package) - known == set()


def test_what_rosdep_installs_is_what_rumba_installs_and_no_key_is_left_over():
    every = {**KEYS['read'], **KEYS['assumed']}
    # python3-rospkg brings its modules.
    assert {debian for debian in every.values()} <= {debian for debian, _ in INSTALLED}
    assert {*every} == {key for package in OURS + TUTORIALS for key in depends(package)} & {*every}


def test_hosted_ci_does_what_the_local_one_does_on_systems_that_have_a_ros_of_their_own():
    job = WORKFLOW['jobs']['test']
    assert '.ci/run' in commands(job)
    own = re.search(r'^ +(\w+(?: \| \w+)+)\) ;;$', WHICH_ROS, re.MULTILINE).group(1)
    names = {'debian:12': 'bookworm', 'debian:13': 'trixie', 'ubuntu:22.04': 'jammy'}
    assert {names[image] for image in job['strategy']['matrix']['image']} == set(own.split(' | '))


def test_hosted_ci_tests_on_the_others_with_the_ros_that_serves_them():
    job = WORKFLOW['jobs']['ros_in_opt']
    assert './rumba test' in commands(job)
    names = {'ros:noetic': 'focal', 'ubuntu:24.04': 'noble'}
    assert {names[image] for image in job['strategy']['matrix']['image']} == {
        *re.findall(r'^ +(\w+)\) fail 2 .*: install ROS ', WHICH_ROS, re.MULTILINE)}


def commands(job):
    """The commands of a job of the workflow."""
    return [step.get('run') for step in job['steps']]


@pytest.mark.parametrize('distribution, is_needed', [('noetic', True), ('one', True), ('Debian', False), ('', False)])
def test_turtlesim_is_needed_only_with_a_ros_that_has_it_or_else_rosdep_stops(distribution, is_needed):
    for name in ('rumba_launch', 'rumba_viewer'):
        package = parse_package(str(ROOT / name))
        package.evaluate_conditions({'ROS_DISTRO': distribution})
        needed = [depend.evaluated_condition for depend in package.exec_depends + package.test_depends
                  if depend.name == 'turtlesim']
        assert needed == [is_needed]


@OF_PACKAGE
def test_one_version_and_no_address_that_was_made_up(package):
    root = xml.etree.ElementTree.parse(str(package / 'package.xml')).getroot()
    assert root.find('version').text == '0.1.0'
    assert root.find('url') is None, 'an address: then say it in CONTRIBUTING.md too, and give a .rosinstall'


def test_tests_with_nodes_have_no_subtests():
    """rosunit counts the failures of subtests, but names the whole test as passed, and does not say what failed."""
    files = [path for folder in OURS + STAND_INS for path in folder.glob('test/ros/*.py')]
    files += [path for folder in TUTORIALS for path in folder.glob('test/*.py')]
    assert len(files) > 50
    assert [str(path) for path in files if 'subTest' in path.read_text()] == []
