"""turtlesim.launch: a turtle cleans, and nodes written for the lesson run beside it as they are."""

import re
import time

import pytest
from workspaces import TIMEOUT, lines

LAUNCH = 'roslaunch rumba_launch turtlesim.launch gui:=false'
CLEAN = "rostopic pub -1 /rumba/clean/goal rumba_msg/CleanActionGoal '{}'"
STUDENT = """
import rospy
from rumba_msg.srv import TargetPosition
rospy.init_node('student')
rospy.Service('go_to_position', TargetPosition, lambda _: (-1.0, 0.25, True, 'mine'))
rospy.spin()
"""


def script(folder, text):
    """The command that runs a program."""
    path = folder / 'program.py'
    path.write_text(text)
    return f'/usr/bin/python3 {path}'


def answered(here, *target):
    """What the service answers, once it does: a cleaner that has just started does not know the pose yet."""
    deadline = time.monotonic() + TIMEOUT
    while True:
        answer = here.run(f'rosservice call --wait /go_to_position {" ".join(map(str, target))}')
        if 'feedback: True' in answer:
            return answer
        assert time.monotonic() < deadline, answer


def number(name, answer):
    """A number of an answer."""
    return float(re.search(rf'{name}: (\S+)', answer).group(1))


@pytest.mark.thorough
def test_a_turtle_cleans_and_comes_home_and_a_server_of_a_student_keeps_its_name(workspace, tmp_path):
    here = workspace.space('devel')
    with here.running(script(tmp_path, STUDENT)):
        answered(here, 1, 1, 0)
        with here.printing(f'{LAUNCH} speed:=5 target_coverage:=0.01 2>&1') as launch:
            launch.find('/go_to_position is served by /student, which keeps it')
            assert 'message: "mine"' in answered(here, 8.5, 5.5, 0)
            place = -1
            for word in ('cleaning by boustrophedon', 'going home', 'docking', 'done after '):
                place = launch.find(f'rumba: {word}', place + 1)
    report = launch.lines[place]
    assert re.search(r'm, 0 charges: 1\.\d % swept$', report), report


@pytest.mark.thorough
def test_the_service_answers_with_a_velocity_if_it_is_told_to_and_a_mission_waits_for_its_turtle(workspace):
    here = workspace.space('devel')
    with here.printing(f'{LAUNCH} speed:=5 autostart:=false answer:=velocity 2>&1') as launch:
        answer = answered(here, 8.5, 5.5, 0)
        assert number('linear_x', answer) > 0.2
        assert abs(number('angular_z', answer)) < 0.3
        assert re.search(r'message: "2\.9\d m to go"', answer), answer
        here.run(CLEAN)
        launch.find('rumba: cleaning by boustrophedon')
        here.run('rosservice call /kill turtle1')
        reason = launch.find('no turtle: nothing publishes /turtle1/pose; turtles that there are: none')
        launch.find('rumba has no body', reason)
        gone = launch.find(r'rumba: given up after .*: the robot is gone')
        here.run('rosservice call /spawn 3 3 0 turtle1')
        back = launch.find('rumba: the robot is back', gone)
        assert 'the robot is back, and waits for a goal' in here.run('rostopic echo -n1 /rumba/mission_status')
        here.run(CLEAN.replace('{}', '{goal: {resume: true}}'))
        launch.find('rumba: cleaning by boustrophedon', back)


@pytest.mark.thorough
def test_the_publisher_of_the_lesson_and_ours_are_heard_by_the_same_listener(workspace, overlay):
    here = workspace.space('devel')
    with here.running(f'{LAUNCH} speed:=5 autostart:=false percentage:=64'), \
            overlay.space('devel').running('$LIB/battery_cpp/publisher'), \
            here.running('$LIB/rumba_sim/battery_status_listener') as listener:
        seen = set()
        for line in lines(listener):
            found = re.match(r'battery +(\d+) % .* brushes (up|down) +(.*)$', line)
            if found:
                seen.add((found.group(1), found.group(2), found.group(3)[-13:]))
            if seen >= {('42', 'up', 'from C++'), ('64', 'down', ', discharging')}:
                return
    raise AssertionError(f'the listener ended, or not: {seen}')
