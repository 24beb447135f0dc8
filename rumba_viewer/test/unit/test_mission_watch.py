"""What is known of a mission while it goes on, and the report when it has ended."""

from rumba_viewer.scene.mission_watch import MissionWatch
from rumba_viewer.scene.snapshot import Battery, Cleaning, Mission

CLEANING, DOCKING = Mission('cleaning', True, 'boustrophedon', ''), Mission('docking', True, 'boustrophedon', '')
IDLE, GOING = Mission('idle', False, '', 'done'), Mission('going to', True, '', '')


def floor(time, area=0.0):
    """The floor at a time [s], when the robot had driven as many metres."""
    return Cleaning(area / 20.0, area, 20.0, 0.5, time, time)


def watched(*told):
    """A watch that was told missions and floors in this order."""
    watch = MissionWatch('rumba')
    watch.take_battery(Battery(0.8, 15.0, -1.0, 'on battery'))
    for one in told:
        (watch.take_mission if isinstance(one, Mission) else watch.take_cleaning)(one)
    return watch


def test_while_a_robot_cleans_the_times_are_known_and_there_is_no_report():
    watch = watched(IDLE, floor(10.0), CLEANING, floor(11.0), floor(61.0, 5.0))
    assert watch.elapsed == 50.0 and watch.left > 100.0 and watch.report == ()


def test_the_report_comes_with_the_first_figures_after_the_end_and_stays():
    watch = watched(IDLE, floor(10.0), CLEANING, floor(11.0), floor(61.0, 5.0), DOCKING, IDLE, floor(61.0, 5.0))
    assert watch.report == ()
    watch.take_cleaning(floor(62.0, 5.0))
    assert watch.report == ('rumba: 25.0 % of the floor is swept: 5.0 of 20.0 m², 50.0 % of the dirt is left',
                            '0:50, 52.0 m driven, 0 charges, battery 80 %')
    report = watch.report
    watch.take_mission(IDLE)
    watch.take_cleaning(floor(63.0, 5.0))
    assert watch.report is report and (watch.elapsed, watch.left) == (None, None)


def test_the_report_goes_when_another_mission_begins_or_the_world_is_reset():
    ended = (IDLE, floor(10.0), CLEANING, floor(11.0), floor(61.0, 5.0), IDLE, floor(62.0, 5.0))
    assert watched(*ended).report and not watched(*ended, GOING).report and not watched(*ended, floor(0.0)).report


def test_what_is_no_cleaning_has_a_time_but_neither_a_rest_nor_a_report():
    watch = watched(IDLE, floor(10.0), GOING, floor(11.0), floor(31.0))
    assert (watch.elapsed, watch.left) == (20.0, None)
    assert watched(IDLE, floor(10.0), GOING, floor(11.0), floor(31.0), IDLE, floor(32.0)).report == ()


def test_a_mission_that_is_seen_late_has_the_time_since_its_goal_came():
    late = watched(floor(1000.0, 2.0), CLEANING, floor(1001.0, 2.1))
    late.take_goal(300.0)
    assert late.elapsed == 701.0
    late.take_cleaning(floor(1051.0, 7.0))
    assert late.elapsed == 751.0
    late.take_mission(IDLE)
    late.take_cleaning(floor(1052.0, 7.0))
    assert late.elapsed is None and late.report[1] == '12:32, battery 80 %'
    late.take_mission(GOING)  # no cleaning
    late.take_cleaning(floor(1053.0, 7.0))
    assert late.elapsed == 0.0


def test_a_goal_of_another_world_tells_no_time():
    late = watched(floor(10.0, 2.0), CLEANING, floor(11.0, 2.1))
    late.take_goal(300.0)
    assert late.elapsed is None


def test_a_mission_whose_beginning_was_not_seen_has_no_time_but_a_rest():
    late = watched(floor(1000.0, 2.0), CLEANING, floor(1001.0, 2.1), floor(1051.0, 7.0))
    assert late.elapsed is None and late.left > 100.0
    late.take_mission(IDLE)
    late.take_cleaning(floor(1052.0, 7.0))
    assert late.report[1] == 'battery 80 %'
    assert watched(CLEANING, floor(10.0), floor(40.0, 3.0)).elapsed == 30.0  # which has just begun
