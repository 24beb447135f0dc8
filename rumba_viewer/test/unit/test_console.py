"""What the console prints of the missions of one robot or several, without a master."""

import pytest
from sensor_msgs.msg import BatteryState

from rumba_msg.msg import CleaningStatus, MissionStatus
from rumba_sim.model.common.errors import ConfigError
from rumba_viewer.ros.console import console

pytestmark = pytest.mark.usefixtures('topics')


def tell(topics, robot, time, state, distance):
    """A robot tells its state, and what is swept, at a time [s]; it has driven a distance [m]."""
    topics[f'{robot}/battery_state'].callback(BatteryState(percentage=0.64))
    topics[f'{robot}/mission_status'].callback(MissionStatus(state=state, strategy='bounce' if state else ''))
    message = CleaningStatus(coverage=0.5, cleaned_area=5.0, reachable_area=10.0, distance=distance)
    message.header.stamp.secs = time
    topics[f'{robot}/cleaning_status'].callback(message)


def clean(topics, robot, begin, end):
    """A mission of a robot from its beginning [s] to its end, in which it drives a metre a second."""
    tell(topics, robot, begin - 1, MissionStatus.IDLE, begin - 1)
    for time in range(begin, end + 1):
        tell(topics, robot, time, MissionStatus.CLEANING, time)
    for time in (end + 1, end + 2):
        tell(topics, robot, time, MissionStatus.IDLE, time)


def test_a_mission_is_reported_once_with_what_to_do_next(topics):
    shown = console.Console(['rumba'], 0.99)
    clean(topics, 'rumba', 10, 70)
    report = shown.report()
    assert report[0].startswith('rumba: 50.0 % of the floor is swept: 5.0 of 10.0 m²') and report[2:] == console.NEXT
    assert shown.report() == []


def test_the_missions_of_all_robots_are_reported_and_what_to_do_next_after_the_last(topics):
    shown = console.Console(['rumba', 'rumba2'], 0.99)
    tell(topics, 'rumba2', 9, MissionStatus.IDLE, 0)
    tell(topics, 'rumba2', 10, MissionStatus.CLEANING, 0)
    clean(topics, 'rumba', 10, 70)
    first = shown.report()
    assert [line.partition(':')[0] for line in first] == ['rumba', '1'] and '62.0 m driven' in first[1]
    clean(topics, 'rumba2', 80, 90)
    second = shown.report()
    assert second[0].startswith('rumba2: ') and second[2:] == console.NEXT
    assert shown.lines()[0] == '50.0 % swept  battery 64 %  idle'


def test_a_name_that_is_no_name_of_a_topic_is_refused():
    with pytest.raises(ConfigError, match="^others is 'rumba2, rumba3': must be names of robots, with spaces between$"):
        console.Settings(others='rumba2, rumba3')
