"""The launch files explain themselves, and the demo shows a robot that cleans, bumps and drains."""

import re
import time
import xml.etree.ElementTree

import pytest
import yaml
from sockets import wait_for
from workspaces import OURS, ROOT, TIMEOUT, lines

from rumba_viewer.scene.snapshot import Battery, Cleaning, Mission
from rumba_viewer.scene.wording import live_lines

PACKAGE = ROOT / 'rumba_sim'
LAUNCH_FILES = sorted(path for package in OURS for path in package.glob('launch/*.launch'))
DEMO = 'roslaunch rumba_launch demo.launch speed:=10 map:=studio'
BATTERY = re.compile(r'battery +(\d+) %   at \((-?[\d.]+), (-?[\d.]+)\) m')
README = (ROOT / 'README.md').read_text()
LIVE = re.search(r'^.* % swept .* left .*$', README, re.MULTILINE).group(0)
REPORT = re.search(r'^```\n(rumba: .*?)^```$', README, re.MULTILINE | re.DOTALL).group(1)
STATUS = re.search(r'^percentage_battery: .*?^---$', README, re.MULTILINE | re.DOTALL).group(0)
MEANT = len('debug_message: "# V, # A')  # what follows depends on what the robot meets
LINE = r'^[ \d.]+ % swept  '
BARE = 'env -u DISPLAY -u WAYLAND_DISPLAY -u QT_QPA_PLATFORM'
NUMBER = re.compile(r'-?\d[\d.]*(e-\d+)?(:\d+)*')


@pytest.mark.parametrize('path', LAUNCH_FILES, ids=lambda path: path.name)
def test_every_argument_says_what_it_is_for(path):
    for argument in xml.etree.ElementTree.parse(str(path)).getroot().iter('arg'):
        assert 'value' in argument.attrib or len(argument.attrib.get('doc', '')) > 10, argument.attrib


@pytest.mark.parametrize('path', LAUNCH_FILES, ids=lambda path: path.name)
def test_the_page_of_parameters_names_its_arguments(path):
    row = re.search(rf'^\| `{path.name}` \|.*$', (ROOT / 'docs' / 'parameters.md').read_text(), re.MULTILINE).group(0)
    arguments = xml.etree.ElementTree.parse(str(path)).getroot().findall('arg')
    assert re.findall(r'`([\w.]+)`', row.split(';')[0])[1:] == [
        argument.attrib['name'] for argument in arguments if 'value' not in argument.attrib]


def test_the_page_of_the_demo_has_each_argument_with_its_default():
    page = (ROOT / 'docs' / 'demo.md').read_text()
    rows = re.findall(r'^\| `(\w+)` \| (?:`([^`]*)`)?[^|]*\|.*\|$', page, re.MULTILINE)
    arguments = xml.etree.ElementTree.parse(str(ROOT / 'rumba_launch' / 'launch' / 'demo.launch')).getroot()
    declared = [(each.attrib['name'], each.attrib['default']) for each in arguments.findall('arg')
                if 'default' in each.attrib]
    assert [name for name, _ in rows] == [name for name, _ in declared]
    assert [(row, default) for (_, row), (_, default) in zip(rows, declared)
            if '$(' not in default and row != default] == []


@pytest.mark.parametrize('arguments, wanted', [
    ('', {'mapless': False, 'laser': False, 'strategy': 'boustrophedon', 'drain': 10, 'localisation': 'truth'}),
    ('obstacles:=some.yaml', {'mapless': False, 'laser': True, 'strategy': 'boustrophedon', 'drain': 10}),
    ('laser:=none', {'mapless': True, 'laser': False, 'strategy': 'wander', 'drain': 1, 'localisation': 'none'}),
    ('laser:=none strategy:=bounce drain:=2', {'mapless': True, 'strategy': 'bounce', 'drain': 2}),
    ('localisation:=slam', {'mapless': False, 'mapping': True, 'strategy': 'explore_and_clean',
                            'localisation': 'slam'})])
def test_what_the_arguments_of_the_demo_bring(workspace, arguments, wanted):
    told = workspace.space('devel').run(f'roslaunch --dump-params rumba_launch demo.launch {arguments}')
    parameters = {name.rsplit('/', 1)[-1]: value for name, value in yaml.safe_load(told).items()
                  if name.startswith(('/cleaner/', '/simulator/'))}
    assert {name: parameters[name] for name in wanted} == wanted


def shape(line):
    """A line, whatever its numbers are."""
    return NUMBER.sub('#', line).replace('charges', 'charge')


def fields(status):
    """A message as rostopic prints it, whatever the robot does."""
    return [shape(line.replace('True', 'False'))[:MEANT] for line in status.splitlines()]


def open_sockets(reachable):
    """How many sockets of each node other machines can reach; roscpp has one that is always open."""
    return {**dict.fromkeys(('simulator', 'cleaner', 'console'), reachable),
            'robot_state_publisher': max(1, reachable)}


@pytest.fixture(scope='class')
def demo(request, workspace):
    """What the demo of a class of tests prints."""
    with workspace.space('devel').printing(request.cls.COMMAND) as printed:
        yield printed


class TestWithoutADisplayAndAnAddress:
    """A demo as it is started on a machine without a display, with half of its charge."""

    COMMAND = f'{BARE} -u ROS_HOSTNAME {DEMO} percentage:=50 drain:=0 2>&1'

    def test_it_says_in_a_line_that_there_is_no_window_and_goes_on(self, demo):
        demo.find('the simulation runs without a window: there is no display')
        demo.fresh(LINE)

    def test_it_shows_live_status_and_publishes_at_the_name_of_the_lesson(self, workspace, demo):
        demo.find('  battery 50 %')
        status = workspace.space('devel').run('rostopic echo -n1 /rumba/battery_status')
        assert status.startswith('percentage_battery: 50\n')
        assert fields(status) == fields(STATUS)

    def test_other_machines_cannot_reach_it(self, demo):
        wait_for(demo.process, open_sockets(0))


@pytest.mark.thorough
class TestAWindowWithoutADisplay:
    """A demo that shall open the window but cannot, at an address of this machine. Its robot bounces, drained fast."""

    COMMAND = f'{BARE} ROS_IP=127.0.0.1 {DEMO} gui:=true drain:=100 strategy:=bounce 2>&1'

    def test_it_says_so_in_a_line_and_goes_on(self, demo):
        demo.find('^viewer: no window: there is no display')
        demo.fresh(LINE)

    def test_the_robot_moves_bumps_and_drains(self, workspace, demo):
        demo.find(LINE)
        with workspace.space('devel').running('$LIB/rumba_sim/battery_status_listener') as listener:
            seen, bumped = [], False
            for line in lines(listener):
                if BATTERY.match(line):
                    seen.append([float(figure) for figure in BATTERY.match(line).groups()])
                    bumped = bumped or 'bumper pressed' in line
                    places = {(round(x), round(y)) for _, x, y in seen}
                    if bumped and len(places) > 3 and seen[-1][0] < seen[0][0] - 2:
                        return
        raise AssertionError(f'the demo ended, or not: {seen[-1:]}')

    def test_other_machines_cannot_reach_it(self, demo):
        wait_for(demo.process, open_sockets(0))


class TestWithAWindow:
    """A demo with a window, with an address of all interfaces, until a part of the floor is clean, and then."""

    COMMAND = f'env -u ROS_HOSTNAME ROS_IP=0.0.0.0 QT_QPA_PLATFORM=offscreen {DEMO} target_coverage:=0.03'

    def test_it_opens_the_window_and_goes_on_when_the_window_is_closed(self, workspace, demo):
        here = workspace.space('devel')
        deadline = time.monotonic() + TIMEOUT
        while '/viewer/save_png' not in here.run('rosservice list'):
            assert time.monotonic() < deadline, 'no viewer'
        here.run('rosnode kill /viewer')
        demo.fresh(LINE)

    def test_other_machines_can_reach_it(self, demo):
        wait_for(demo.process, open_sockets(2))

    def test_it_shows_a_mission_from_dock_to_dock_and_reports(self, demo):
        number = -1
        for word in ('undocking', 'cleaning by boustrophedon', 'going home', 'docking', 'done after '):
            number = demo.find(f'rumba: {word}', number + 1)
        told = demo.lines[number]
        assert re.search(r'm, 0 charges: 3\.\d % swept$', told), told
        number = demo.find('^rumba: ', number + 1)
        wanted = REPORT.splitlines()
        demo.find('', number + len(wanted) - 1)
        for line, promised in zip(demo.lines[number:], wanted):
            assert shape(line.rstrip('\n')) == shape(promised)


def test_the_live_line_of_the_readme_is_one_of_a_mission():
    """Whether the node prints such lines is tested with the others of the demo."""
    cleaning, battery = Cleaning(0.585, 16.4, 28.0, 0.5, 120.0, 439.0), Battery(0.276, 15.0, -1.5, 'on battery')
    assert LIVE == live_lines(Mission('cleaning', True, 'boustrophedon', ''), cleaning, battery, 439.0, 1250.0)[0]


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
