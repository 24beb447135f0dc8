"""The launch files explain themselves, and the demo shows a robot that cleans, bumps and drains."""

import re
import time
import xml.etree.ElementTree

import pytest
from sockets import wait_for
from workspaces import OURS, ROOT, TIMEOUT, last_of, lines

from rumba_viewer.scene.snapshot import Battery, Cleaning, Mission
from rumba_viewer.scene.wording import live_line

PACKAGE = ROOT / 'rumba_sim'
LAUNCH_FILES = sorted(path for package in OURS for path in package.glob('launch/*.launch'))
DEMO = 'roslaunch rumba_bringup demo.launch speed:=10 map:=studio'
BATTERY = re.compile(r'battery +(\d+) %   at \((-?[\d.]+), (-?[\d.]+)\) m')
README = (ROOT / 'README.md').read_text()
LIVE = re.search(r'^.* % swept .* left$', README, re.MULTILINE).group(0)
REPORT = re.search(r'^```\n(rumba: .*?)^```$', README, re.MULTILINE | re.DOTALL).group(1)
LINE = re.compile(r'[ \d.]+ % swept   ')
NUMBER = re.compile(r'[\d.:]+')


@pytest.mark.parametrize('path', LAUNCH_FILES, ids=lambda path: path.name)
def test_every_argument_says_what_it_is_for(path):
    for argument in xml.etree.ElementTree.parse(str(path)).getroot().iter('arg'):
        assert 'value' in argument.attrib or len(argument.attrib.get('doc', '')) > 10, argument.attrib


@pytest.mark.parametrize('path', LAUNCH_FILES, ids=lambda path: path.name)
def test_the_page_of_interfaces_names_its_arguments(path):
    row = re.search(rf'^\| `{path.name}` \|.*$', (ROOT / 'docs' / 'interfaces.md').read_text(), re.MULTILINE).group(0)
    arguments = xml.etree.ElementTree.parse(str(path)).getroot().findall('arg')
    assert re.findall(r'`([\w.]+)`', row.split(';')[0])[1:] == [
        argument.attrib['name'] for argument in arguments if 'value' not in argument.attrib]


def test_the_robot_in_the_demo_moves_bumps_and_drains(workspace):
    here = workspace.space('devel')
    with here.running(f'{DEMO} drain:=100 strategy:=bounce'), \
            here.running('rosrun rumba_sim battery_status_listener') as listener:
        seen, bumped = [], False
        for line in lines(listener):
            if BATTERY.match(line):
                seen.append([float(figure) for figure in BATTERY.match(line).groups()])
                bumped = bumped or 'bumper pressed' in line
                places = {(round(x), round(y)) for _, x, y in seen}
                if bumped and len(places) > 3 and seen[-1][0] < seen[0][0] - 2:
                    return
    raise AssertionError(f'the demo ended, or not: {seen[-1:]}')


def test_the_demo_shows_a_mission_from_dock_to_dock_and_reports(workspace):
    with workspace.space('devel').running(f'{DEMO} target_coverage:=0.1') as demo:
        report = last_of(demo, 'rumba: undocking', 'rumba: cleaning by boustrophedon', 'rumba: going home',
                         'rumba: docking', 'rumba: done after ')
        first, *rest = REPORT.splitlines()
        told = next(line for line in lines(demo) if line.startswith('rumba: '))
        for line in [first, *rest]:
            assert NUMBER.sub('#', told).rstrip('\n').replace('charges', 'charge') == NUMBER.sub('#', line).replace(
                'charges', 'charge')
            told = next(lines(demo), '')
    assert re.search(r'm, 0 charges; the floor is 1\d\.\d % clean: 10\.\d % swept$', report), report


def test_the_live_line_of_the_readme_is_one_of_a_mission():
    """Whether the node prints such lines is tested with the others of the demo."""
    cleaning, battery = Cleaning(0.546, 15.3, 28.0, 0.5, 120.0, 438.0), Battery(0.256, 15.0, -1.5, 'on battery')
    assert LIVE == live_line(Mission('cleaning', True, 'boustrophedon', ''), cleaning, battery, 438.0, 1310.0)


@pytest.mark.parametrize('gui, line', [
    ('auto', r'the simulation runs without a window: there is no display'),
    ('true', r'^viewer: no window: there is no display')])
def test_without_a_display_the_demo_says_so_in_a_line_and_goes_on(workspace, gui, line):
    bare = 'env -u DISPLAY -u WAYLAND_DISPLAY -u QT_QPA_PLATFORM'
    with workspace.space('devel').running(f'{bare} {DEMO} gui:={gui} 2>&1') as demo:
        assert any(re.search(line, text) for text in lines(demo)), 'the demo ended'
        assert any(LINE.match(text) for text in lines(demo)), 'the demo ended'


def test_the_demo_opens_the_window_if_it_can_and_goes_on_when_the_window_is_closed(workspace):
    here = workspace.space('devel')
    with here.running(f'env QT_QPA_PLATFORM=offscreen {DEMO}') as demo:
        assert any(LINE.match(text) for text in lines(demo))
        deadline = time.monotonic() + TIMEOUT
        while '/viewer/save_png' not in here.run('rosservice list'):
            assert time.monotonic() < deadline, 'no viewer'
        here.run('rosnode kill /viewer')
        assert any(LINE.match(text) for text in lines(demo)), 'the demo ended'


def test_what_the_demo_starts_cannot_be_reached_from_other_machines_unless_an_address_is_given(workspace):
    for address, reachable in (('', 0), ('ROS_IP=127.0.0.1', 0), ('ROS_IP=0.0.0.0', 2)):
        with workspace.space('devel').running(f'env -u ROS_HOSTNAME {address} {DEMO} gui:=false') as demo:
            wait_for(demo, {'simulator': reachable, 'cleaner': reachable, 'console': reachable,
                            'robot_state_publisher': max(1, reachable)})


def test_the_configuration_file_is_what_the_simulator_prints(workspace):
    printed = workspace.space('devel').run('rosrun rumba_sim simulator --config')
    assert printed == (PACKAGE / 'config' / 'rumba.yaml').read_text()


def test_the_description_of_the_robot_has_its_size(workspace):
    robot = xml.etree.ElementTree.parse(str(PACKAGE / 'urdf' / 'rumba.urdf')).getroot()
    body = robot.find("link[@name='base_link']/visual/geometry/cylinder")
    config = (PACKAGE / 'config' / 'rumba.yaml').read_text()
    assert f'radius: {body.attrib["radius"]}\n' in config
    wheels = [float(robot.find(f"joint[@name='{side}_wheel_joint']/origin").attrib['xyz'].split()[1])
              for side in ('left', 'right')]
    assert f'wheel_base: {wheels[0] - wheels[1]:g}\n' in config and wheels[0] > 0.0
    links = {link.attrib['name'] for link in robot.iter('link')}
    assert {parent.attrib['link'] for parent in robot.iter('parent')} <= links
