"""A learner's workspace over ours, with a rumba_msg and a rumba_bringup of its own: his nodes and ours meet in it."""

import math
import re
import subprocess
import xmlrpc.client

import pytest
from workspaces import ROOT, TIMEOUT, clean_environment, last_of, master

BUILDING = (ROOT / 'docs' / 'building.md').read_text()
SECTION = BUILDING.split('\n### A workspace with a `rumba_msg` of its own\n')[1].split('\n#')[0]
SPEED = 2.0  # times real time, of the turtle: a faster one turns too far on a busy machine, and turns once more
THERE = 0.05  # [m], [rad]
# x, y [m], theta [rad]: once round the middle of the field, so that the turtle backs up in all directions.
TARGETS = [(4.3, 5.4, 0.0), (4.6, 4.8, 0.5), (5.3, 4.4, -1.0), (6.1, 4.5, 3.0), (6.7, 5.1, -3.0), (6.7, 6.0, 1.0),
           (6.1, 6.6, 2.0), (5.3, 6.7, -2.0), (4.6, 6.3, 0.0), (4.3, 5.5, 1.5)]
SERVERS = {'server_in_cpp': 'rumba_bringup rumba_kick_off.launch server:=server_cpp',
           'server_in_python': 'rumba_bringup rumba_kick_off.launch server:=server.py',
           'ours': f'rumba_launch turtlesim.launch gui:=false autostart:=false speed:={SPEED}'}


def misses(here, controller, targets):
    """How far from each target [m] the turtle stands once a controller of the lesson says that it is there."""
    process = here.start(f'rosrun rumba_pathway {controller}', stdin=subprocess.PIPE)
    told, _ = process.communicate(''.join(f'{x} {y} {theta}\n' for x, y, theta in targets), 5 * TIMEOUT)
    assert process.returncode == 0
    places = re.findall(r'^at (\S+) (\S+)$', told, re.MULTILINE)
    assert len(places) == len(targets), told
    return [math.hypot(float(x) - target[0], float(y) - target[1]) for (x, y), target in zip(places, targets)]


@pytest.mark.thorough(except_for=[f'{server}-2' for server in SERVERS])
@pytest.mark.parametrize('count', [2, len(TARGETS)])
@pytest.mark.parametrize('server', SERVERS)
def test_controllers_of_the_lesson_in_cpp_and_in_python_reach_their_targets_with_each_server(lesson, server, count):
    environment = clean_environment()
    here = lesson.space('devel', environment)
    with master(environment):
        parameters = xmlrpc.client.ServerProxy(environment['ROS_MASTER_URI'])
        parameters.setParam('/test', '/threshold_parameter', THERE)
        parameters.setParam('/test', '/turtlesim/speed', SPEED)
        with here.running(f'roslaunch {SERVERS[server]}'):
            for controller in ('controller_cpp', 'controller.py'):
                missed = misses(here, controller, TARGETS[:count])
                assert max(missed) < THERE, (controller, missed)
                answer = here.run('rosservice call --wait /go_to_position 4.3 5.4 0')
                assert 'feedback: True' in answer


def test_his_publisher_and_listener_talk_to_ours(lesson):
    here = lesson.space('devel')
    ours, his = 'rosrun rumba_sim battery_status_publisher _percentage:=64', 'rosrun battery_cpp publisher'
    for number, (publisher, charge) in enumerate([(ours, 64), (his, 42)]):
        namespace = f'__ns:=/lesson_{number}'
        with here.running(f'{publisher} {namespace}'):
            told = here.run(f'rosrun battery_python reader {namespace}')
            assert told.startswith(f'{charge}, '), told
            echo = here.run(f'rostopic echo -n1 /lesson_{number}/rumba/battery_status')
            assert echo.startswith(f'percentage_battery: {charge}\n'), echo
            with here.running(f'rosrun rumba_sim battery_status_listener {namespace}') as listener:
                last_of(listener, f'battery  {charge} %')


@pytest.mark.thorough
@pytest.mark.parametrize('command, words', [
    ('rumba_launch demo.launch gui:=false page:=true map:=studio speed:=20 robots:=2 localisation:=mcl '
     'target_coverage:=0.05', ['rumba2: cleaning by boustrophedon', '% of the floor is swept']),
    ('rumba_launch demo.launch gui:=false map:=studio speed:=20 localisation:=slam target_coverage:=0.05',
     ['rumba: cleaning by explore_and_clean', '% of the floor is swept']),
    ('rumba_sim simulator.launch map:=studio', [])], ids=['team', 'slam', 'simulator'])
def test_each_launch_file_of_ours_works_in_it(lesson, command, words):
    environment = clean_environment()
    here = lesson.space('devel', environment)
    with master(environment), here.printing(f'roslaunch {command} 2>&1') as launch:
        for word in words:
            launch.find(word)
        assert here.run('rostopic echo -n1 /rumba/battery_status').startswith('percentage_battery: ')
        assert not [line for line in launch.lines if 'Error' in line or 'process has died' in line]


@pytest.mark.thorough
def test_what_tools_of_ros_say_of_types_that_his_rumba_msg_lacks_and_that_ours_shows_them(lesson, workspace, tmp_path):
    rows = re.findall(r'^\| `([^`]+)` \| `([^`]+)` \|$', SECTION, re.MULTILINE)
    assert len(rows) == 4
    environment = clean_environment()
    here, there = (each.space('install' if each is workspace else 'devel', environment) for each in (lesson, workspace))
    with master(environment), here.running('rosrun rumba_sim simulator _map:=studio'), \
            here.running('rosrun rumba_cleaning cleaner'):
        there.run('rostopic echo -n1 /rumba/mission_status')
        for command, message in rows:
            process = here.start(command, stderr=subprocess.STDOUT)
            assert message in process.communicate(timeout=TIMEOUT)[0], command
            there.run(command)
        works = re.search(r'needs no definition works in both: `([^:]*)`\.', SECTION).group(1)
        for command in works.replace('\n', ' ').split('`, `'):
            here.run(command, cwd=str(tmp_path))
