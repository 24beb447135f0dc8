"""turtlesim.launch: a turtle cleans, and nodes written for the lesson run beside it as they are."""

import re
import time

from workspaces import TIMEOUT, last_of, lines

LAUNCH = 'roslaunch rumba_bringup turtlesim.launch gui:=false'


def test_a_turtle_cleans_and_comes_home(workspace):
    with workspace.space('devel').running(f'{LAUNCH} speed:=5 target_coverage:=0.01') as launch:
        report = last_of(launch, 'rumba: cleaning by boustrophedon', 'rumba: going home', 'rumba: docking',
                         'rumba: done after ')
    assert re.search(r'm, 0 charges; the floor is 1\.\d % clean: 1\.\d % swept$', report), report


def test_the_lessons_publisher_and_ours_are_heard_by_the_same_listener(workspace):
    here = workspace.space('devel')
    with here.running(f'{LAUNCH} autostart:=false percentage:=64'), here.running('rosrun battery_cpp publisher'), \
            here.running('rosrun rumba_sim battery_status_listener') as listener:
        seen = set()
        for line in lines(listener):
            found = re.match(r'battery +(\d+) % .* brushes (up|down) +(.*)$', line)
            if found:
                seen.add((found.group(1), found.group(2), found.group(3)[-13:]))
            if seen >= {('42', 'up', 'from C++'), ('64', 'down', ', discharging')}:
                return
    raise AssertionError(f'the listener ended, or not: {seen}')


def test_the_lessons_service_leads_the_turtle_to_a_place(workspace):
    here = workspace.space('devel')
    with here.running(f'{LAUNCH} autostart:=false'):
        deadline = time.monotonic() + TIMEOUT
        while True:
            answer = here.run('rosservice call --wait /go_to_position 8.5 5.5 0')
            if 'feedback: True' in answer:
                break
            assert time.monotonic() < deadline, answer
        assert float(re.search(r'linear_x: (\S+)', answer).group(1)) > 0.2
        assert abs(float(re.search(r'angular_z: (\S+)', answer).group(1))) < 0.3
        assert re.search(r'message: "2\.9\d m to go"', answer), answer
