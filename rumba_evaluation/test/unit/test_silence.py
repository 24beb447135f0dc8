"""Who measured nothing is told what was there instead."""

import pytest

from rumba_evaluation.verdicts.silence import Seen, reason

FIELDS = {'rumba_msg/BatteryStatus': {'percentage_battery': 'uint8', 'location_x': 'float32'},
          'nav_msgs/Odometry': {'pose': 'geometry_msgs/PoseWithCovariance', 'twist': 'geometry_msgs/Twist'},
          'geometry_msgs/PoseWithCovariance': {'pose': 'geometry_msgs/Pose', 'covariance': 'float64[36]'},
          'std_msgs/Float64': {'data': 'float64'}}
SIMULATOR, JUDGE, STUDENT, DRIVER = '/simulator', '/judge', '/student', '/driver'
WANTED = '/student/battery_status'
PATH = f'{WANTED}/percentage_battery'
WORLD = {'/rumba/battery_status': ([SIMULATOR], 'rumba_msg/BatteryStatus'), '/rosout': ([STUDENT], 'rosgraph_msgs/Log'),
         '/rumba/cmd_vel': ([DRIVER], 'geometry_msgs/Twist')}
NODES = [SIMULATOR, JUDGE, STUDENT, DRIVER]


def why(topics=None, path=PATH, expected=(WANTED,), nodes=NODES, ended=(), heard=('/rumba/battery_status',)):
    """What is told if there were more topics, given as pairs of nodes and type."""
    every = {**WORLD, **(topics or {})}
    seen = Seen({topic: nodes for topic, (nodes, _) in every.items()},
                {topic: kind for topic, (_, kind) in every.items()}, nodes, ended, [SIMULATOR, JUDGE], heard)
    return reason([path, '/rumba/battery_status/percentage_battery'], expected, seen,
                  lambda kind: FIELDS.get(kind, {}))


@pytest.mark.parametrize('topic, kind', [
    ('/battery_status', 'rumba_msg/BatteryStatus'), ('/battery_status', 'std_msgs/Float64'),  # the same last part
    ('/student/batery_status', 'std_msgs/Float64'), ('/student/batteryStatus', 'std_msgs/Float64'),  # nearly the same
    ('/student/state', 'rumba_msg/BatteryStatus')])  # the same type
@pytest.mark.parametrize('expected', [(WANTED,), ()])
def test_a_topic_that_may_be_the_wanted_one_is_named(topic, kind, expected):
    words = why({topic: ([STUDENT], kind)}, expected=expected)
    assert words.endswith(f"; {STUDENT} publishes {topic}: is that the topic's wrong name?")
    if topic != '/student/state' or expected:
        assert words.startswith(f'nothing was published on {WANTED};')


def test_another_topic_or_one_of_the_world_is_no_wrong_name():
    assert why({'/student/temperature': ([STUDENT], 'std_msgs/Float64')}) == f'nothing was published on {WANTED}'


def test_a_node_that_ended_is_told_also_if_it_published_under_a_wrong_name():
    assert why(ended=[STUDENT]) == f'nothing was published on {WANTED}: {STUDENT} has ended'
    assert f'{STUDENT} publishes /battery_status before it ended: ' in why(
        {'/battery_status': ([STUDENT], 'rumba_msg/BatteryStatus')}, ended=[STUDENT])


def test_a_node_that_never_came_is_told():
    assert why(nodes=[SIMULATOR, JUDGE, DRIVER]) == (
        f'nothing was published on {WANTED}: no node {STUDENT} came, or it ended at once')


def test_a_missing_field_is_told_with_those_that_there_are():
    assert why({WANTED: ([STUDENT], 'std_msgs/Float64')}) == (
        f'{WANTED} is of type std_msgs/Float64, which has no field percentage_battery; its fields are data')
    assert why({'/student/odom': ([STUDENT], 'nav_msgs/Odometry')}, path='/student/odom/pose/position/x') == (
        '/student/odom is of type nav_msgs/Odometry; geometry_msgs/PoseWithCovariance has no field position; '
        'its fields are pose, covariance')


def test_a_topic_without_messages_is_told():
    topics = {WANTED: ([STUDENT], 'rumba_msg/BatteryStatus')}
    assert why(topics) == f'no message came on {WANTED}, although {STUDENT} is its publisher'
    assert why(topics, ended=[STUDENT]) == f'no message came on {WANTED}: {STUDENT} has ended'
    assert why(topics, heard=(WANTED, '/rumba/battery_status')) == ''
