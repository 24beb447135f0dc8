"""The parts of the cleaner's node that need no master: settings, map and robot, actuators, goals, go_to_position."""

import math
import queue
import threading
import time
import types

import numpy as np
import pytest
import rospy
from drivers import Later
from geometry_msgs.msg import Pose2D, Twist
from rooms import crooked, quiet, room
from std_msgs.msg import Header

from rumba_cleaning.behaviour import Command, Observation
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.mission.stages import State
from rumba_cleaning.ros.cleaner import activities, actuators, executor, teleop, workplace
from rumba_cleaning.ros.cleaner.go_to_position import heading_toward, velocity_toward
from rumba_cleaning.ros.cleaner.settings import Settings
from rumba_msg.msg import CleanGoal, CleaningStatus, DockGoal, GoToGoal, MissionStatus, SimulatorState, UndockGoal
from rumba_sim.model.config import from_mapping
from rumba_sim.model.errors import ConfigError, MapError
from rumba_sim.model.geometry import Pose, compose
from rumba_sim.model.robot_config import RobotConfig
from rumba_sim.ros.common.maps import map_path

TARGET = Pose(3.5, 2.4, -2.0)


def context(plan, **config):
    """A context of a quiet robot."""
    return Context(plan, quiet(), CleaningConfig(**config))


# --- settings -------------------------------------------------------------------------------------------------------

def test_settings_hold_those_of_cleaning():
    settings = Settings(speed=0.2, strategy='bounce', robot='rumba2')
    assert settings.cleaning == CleaningConfig(speed=0.2, strategy='bounce')


@pytest.mark.parametrize('robot', ['', '/rumba', 'a/b', '2', 'a b'])
def test_an_invalid_name_of_a_robot_is_refused(robot):
    with pytest.raises(ConfigError, match=r'^robot is .*: must be letters, digits and _, beginning with a letter$'):
        Settings(robot=robot)


@pytest.mark.parametrize('team', ['rumba2 rumba3', 'rumba rumba', 'rumba /rumba2', 'rumba 2'])
def test_a_team_without_the_robot_or_with_wrong_names_is_refused(team):
    with pytest.raises(ConfigError, match=r"^team is .*: must be names of robots, each of them once, and 'rumba' among "
                                          'them$'):
        Settings(team=team)


def test_robots_that_make_their_own_maps_are_no_team():
    Settings(team='rumba', mapping=True)
    with pytest.raises(ConfigError, match='^team is .rumba rumba2.: must be empty with mapping: '):
        Settings(team='rumba rumba2', mapping=True)


def test_a_cleaner_without_a_map_works_alone_and_by_its_bumper():
    Settings(team='rumba', mapless=True)
    with pytest.raises(ConfigError, match='^team is .rumba rumba2.: must be empty with mapless: '):
        Settings(team='rumba rumba2', mapless=True)
    for other in ('mapping', 'laser'):
        with pytest.raises(ConfigError, match=f'^{other} is true: must be false with mapless$'):
            Settings(mapless=True, **{other: True})


def test_an_unknown_answer_of_go_to_position_is_refused():
    with pytest.raises(ConfigError, match="^it: go_to_position/answer is 'speed': must be velocity or heading$"):
        from_mapping(Settings, {'go_to_position': {'answer': 'speed'}}, 'it')


# --- map and robot --------------------------------------------------------------------------------------------------

class Simulator:
    """The state of a simulator, without ROS."""

    def __init__(self, monkeypatch, map=None):
        self.state = map and SimulatorState(node='/sim2', map=map)
        self.robots = {'/sim2': quiet(), '/sim3': quiet(drive={'max_speed': 0.3})}
        monkeypatch.setattr(workplace, 'SimulatorClient', self._listen)
        monkeypatch.setattr(workplace, 'robot_config', self._robot)

    def _listen(self, on_state):
        self._on_state = on_state
        return self

    def _robot(self, node):
        found = self.robots[node]
        if isinstance(found, Exception):
            raise found
        return found

    def tells(self, map, node='/sim2', run='', resets=0, seconds=0):
        """Publish a state."""
        header = Header(stamp=rospy.Time(seconds))
        self.state = SimulatorState(header=header, node=node, map=map, run=run, resets=resets)
        self._on_state(self.state)

    def wait(self):
        """The state, or the error that there is none."""
        if self.state is None:
            raise MapError('no simulator publishes /simulator/state')
        return self.state


def test_map_and_robot_are_those_of_the_simulator_whatever_its_name(monkeypatch):
    simulator = Simulator(monkeypatch, map_path('studio'))
    plan, robot = workplace.Workplace('').look()
    assert (plan.name, robot) == (map_path('studio'), simulator.robots['/sim2'])


def test_a_simulator_that_is_started_again_may_have_another_map_and_another_robot(monkeypatch):
    simulator = Simulator(monkeypatch, map_path('studio'))
    place = workplace.Workplace('')
    plan, robot = place.look()
    assert place.look()[0] is plan
    simulator.robots['/sim2'] = quiet(drive={'max_speed': 0.1})
    simulator.tells(map_path('studio'))
    assert place.look() == (plan, simulator.robots['/sim2'])
    simulator.tells(map_path('field'), '/sim3', run='second')
    assert (place.look()[0].name, place.look()[1]) == (map_path('field'), simulator.robots['/sim3'])


def test_settings_of_the_simulator_that_became_invalid_are_an_error_until_they_are_valid_again(monkeypatch):
    simulator = Simulator(monkeypatch, map_path('studio'))
    place = workplace.Workplace('')
    valid, simulator.robots['/sim2'] = simulator.robots['/sim2'], ConfigError('drive/radius is -1')
    simulator.tells(map_path('studio'))
    with pytest.raises(ConfigError, match='^drive/radius is -1$'):
        place.look()
    simulator.robots['/sim2'] = valid
    simulator.tells(map_path('studio'))
    assert place.look()[1] == valid


def test_a_map_is_read_again_for_a_simulator_that_was_started_again_since_the_file_may_have_changed(monkeypatch):
    simulator = Simulator(monkeypatch, map_path('studio'))
    place = workplace.Workplace('')
    plan = place.look()[0]
    simulator.tells(map_path('studio'), run='second')
    assert place.look()[0] is not plan


def test_each_new_world_is_told_once_with_the_stamp_that_it_began_at(monkeypatch):
    simulator, told = Simulator(monkeypatch, map_path('studio')), []
    place = workplace.Workplace('', lambda: told.append(place.world))
    for run, resets, seconds in (('a', 0, 5), ('a', 0, 6), ('a', 1, 7), ('a', 1, 8), ('b', 1, 2)):
        simulator.tells(map_path('studio'), run=run, resets=resets, seconds=seconds)
    assert told == [('a', 0, rospy.Time(5)), ('a', 1, rospy.Time(7)), ('b', 1, rospy.Time(2))]


def test_settings_are_kept_while_the_master_is_away(monkeypatch):
    simulator = Simulator(monkeypatch, map_path('studio'))
    place = workplace.Workplace('')
    simulator.tells(map_path('studio'))
    known, simulator.robots['/sim2'] = simulator.robots['/sim2'], ConnectionRefusedError(111, 'Connection refused')
    simulator.tells(map_path('studio'))
    assert place.look()[1] == known


def test_a_map_that_is_named_goes_before_that_of_the_simulator_and_needs_none(monkeypatch):
    simulator = Simulator(monkeypatch)
    place = workplace.Workplace('studio')
    assert place.look()[0].name == map_path('studio')
    assert place.look()[1] == RobotConfig()
    simulator.tells(map_path('field'))
    assert (place.look()[0].name, place.look()[1]) == (map_path('studio'), simulator.robots['/sim2'])


def test_without_a_simulator_a_map_must_be_named(monkeypatch):
    Simulator(monkeypatch)
    with pytest.raises(MapError, match='^no simulator publishes /simulator/state'):
        workplace.Workplace('')


# --- threads ----------------------------------------------------------------------------------------------------------

def test_functions_run_beside_their_caller_in_so_many_threads():
    gate, threads = threading.Event(), set()

    def wait_at_the_gate(number, *, factor):
        assert gate.wait(5.0)
        threads.add(threading.current_thread())
        return factor * number
    two = executor.DaemonExecutor(2)
    futures = [two.submit(wait_at_the_gate, number, factor=2) for number in range(4)]
    assert not any(future.done() for future in futures)
    assert futures[3].cancel()
    gate.set()
    assert [future.result(5.0) for future in futures[:3]] == [0, 2, 4]
    assert threading.current_thread() not in threads
    assert 1 <= len(threads) <= 2
    assert all(thread.daemon for thread in threads), 'the end of the process would wait for them'


def test_an_exception_is_handed_over_and_the_thread_goes_on():
    one = executor.DaemonExecutor(1)
    with pytest.raises(ZeroDivisionError):
        one.submit(lambda: 1 / 0).result(5.0)
    assert one.submit(lambda: 1).result(5.0) == 1


# --- a person ---------------------------------------------------------------------------------------------------------

def test_a_person_drives_from_a_command_on_until_the_time_is_up(monkeypatch):
    topics, now = {}, [100.0]
    monkeypatch.setattr(teleop.rospy, 'Subscriber', lambda topic, _, callback, **__: topics.update({topic: callback}))
    monkeypatch.setattr(teleop.time, 'monotonic', lambda: now[0])
    person = teleop.Teleop('rumba2')
    assert not person.is_driving
    topics['rumba2/teleop/cmd_vel'](Twist())
    assert person.is_driving
    now[0] += 0.4
    topics['rumba2/teleop/cmd_vel'](Twist())
    now[0] += 0.4
    assert person.is_driving
    now[0] += 0.2
    assert not person.is_driving


# --- wheels and brushes -------------------------------------------------------------------------------------------

def test_wheels_that_are_closed_have_stopped_and_get_no_command(monkeypatch):
    told = []
    monkeypatch.setattr(actuators.rospy, 'Publisher', lambda *_, **__: types.SimpleNamespace(
        publish=lambda twist: told.append((twist.linear.x, twist.angular.z))))
    wheels = actuators.Wheels('rumba')
    wheels.drive(Command(0.2, -1.0))
    wheels.stop()
    wheels.drive(Command(0.1, 0.5))
    wheels.close()
    wheels.drive(Command(0.3, 0.0))
    assert told == [(0.2, -1.0), (0.0, 0.0), (0.1, 0.5), (0.0, 0.0)]


def test_brushes_are_asked_for_what_is_new_and_again_if_that_failed(monkeypatch):
    asked, failures = queue.Queue(), [rospy.ServiceException('no'), TypeError('no'), OSError('no')]

    def serve(are_up):
        asked.put(are_up)
        if failures and are_up:
            raise failures.pop()
    monkeypatch.setattr(actuators.rospy, 'ServiceProxy', lambda *_: serve)
    monkeypatch.setattr(actuators.rospy, 'is_shutdown', lambda: False)
    monkeypatch.setattr(actuators.rospy, 'logwarn_throttle', lambda *_: None)
    brushes = actuators.Brushes('rumba')
    for are_up in (False, False, True):
        brushes.want(are_up)
    assert [asked.get(timeout=5.0), asked.get(timeout=5.0)] == [False, True]
    for _ in range(2):
        end = time.monotonic() + 5.0
        while asked.empty():
            assert time.monotonic() < end
            brushes.want(True)
        assert asked.get(timeout=5.0) is True
    end = time.monotonic() + 5.0
    while asked.empty():
        assert time.monotonic() < end
        brushes.want(True)
    assert asked.get(timeout=5.0) is True
    brushes.want(True)
    brushes.forget()
    brushes.want(True)
    assert asked.get(timeout=5.0) is True
    assert asked.empty()


# --- goals --------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('time_limit, begins', [(0.0, 600.0), (5.0, 5.0)])
def test_a_goal_has_its_time_limit_or_the_usual_one(time_limit, begins):
    plan = crooked(dock=Pose(3.8, 1.5, 0.0))
    activity = activities.Docking(context(plan), DockGoal(time_limit))
    assert activity.behaviour._time_limit == begins


def test_a_clean_goal_that_names_nothing_has_the_settings_of_the_node(monkeypatch):
    mine = context(crooked(), strategy='spiral', target_coverage=0.5)
    monkeypatch.setattr(activities, 'Mission', lambda _, strategy, target: types.SimpleNamespace(
        strategy=strategy, target=target))
    activity = activities.Cleaning.of_goal(mine, CleanGoal())
    assert (activity.strategy, activity.behaviour.behaviour.target) == ('spiral', 0.5)
    activity = activities.Cleaning.of_goal(mine, CleanGoal(strategy='bounce', target_coverage=0.25))
    assert (activity.strategy, activity.behaviour.behaviour.target) == ('bounce', 0.25)


@pytest.mark.parametrize('make, goal', [
    (activities.Cleaning.of_goal, CleanGoal()), (activities.Docking, DockGoal()), (activities.Undocking, UndockGoal()),
    (activities.GoingTo, GoToGoal(Pose2D(1.0, 1.0, 0.0), 0.0))])
def test_feedback_and_state_are_there_before_the_first_step_since_a_person_may_drive_then(make, goal):
    activity = make(context(crooked(dock=Pose(3.8, 1.5, 0.0))), goal)
    senses = types.SimpleNamespace(cleaning=None, look=lambda: None, pose=lambda: None)
    feedback = activity.feedback(senses, MissionStatus())
    assert math.isnan(getattr(feedback, 'distance_remaining', math.nan)) or feedback.distance_remaining == 0.4
    assert activity.state in State


def test_a_resumed_cleaning_has_the_same_mission_and_its_own_time_limit():
    first = activities.Cleaning.of_goal(context(crooked()), CleanGoal(strategy='spiral', time_limit=5.0))
    mission, observation = first.behaviour.behaviour, Observation(0.1, Pose(1.0, 1.0, 0.0))
    first.begin()
    first.behaviour.step(observation)
    mission.charges = 2  # part of the memory
    first.behaviour.stop()
    second = first.resumed(7.0)
    second.begin()
    second.behaviour.step(observation)
    assert second.behaviour.behaviour is mission
    assert (second.strategy, second.behaviour._time_limit, mission.charges) == ('spiral', 7.0, 2)
    with pytest.raises(ConfigError, match='^time_limit is nan: must be a finite number'):
        first.resumed(math.nan)


def test_the_report_tells_distance_charges_and_coverage():
    activity = activities.Cleaning.of_goal(context(crooked()), CleanGoal())
    report = activity.report(CleaningStatus(distance=2.0), CleaningStatus(distance=5.0, coverage=0.987))
    assert report == ', 3.0 m, 0 charges; the floor is 98.7 % clean'
    assert activity.report(None, CleaningStatus()) == ', 0 charges'


def test_a_target_must_be_finite_but_for_its_heading():
    goal = GoToGoal()
    goal.target.x, goal.target.y, goal.target.theta = 1.0, 1.0, math.nan
    activities.GoingTo(context(crooked()), goal)
    goal.target.theta = math.inf
    with pytest.raises(MapError, match=r'^target \(1\.0, 1\.0, inf\): must be finite numbers$'):
        activities.GoingTo(context(crooked()), goal)


# --- go_to_position -------------------------------------------------------------------------------------------------

def test_velocities_call_by_call_lead_to_the_target_around_what_is_in_the_way():
    mine, pose = context(crooked()), Pose(0.4, 0.4, 1.0)
    for _ in range(1000):
        v, w, message = velocity_toward(mine, pose, TARGET)
        if message == 'there':
            break
        assert abs(v) <= 0.5 and abs(w) <= 1.9 + 1e-9
        pose = compose(pose, Pose(0.1 * v, 0.0, 0.1 * w))
        assert mine.plan.safe_clearance_at(pose.x, pose.y) > mine.robot.drive.radius - 0.02
    assert (v, w, message) == (0.0, 0.0, 'there')
    assert math.hypot(pose.x - TARGET.x, pose.y - TARGET.y) < 0.02
    assert abs(pose.theta - TARGET.theta) < 0.03


def test_headings_call_by_call_lead_to_the_target_around_what_is_in_the_way():
    mine, pose, driven = context(crooked()), Pose(0.4, 0.4, 1.0), 0.0
    _, _, first = heading_toward(mine, pose, TARGET)
    for _ in range(1000):
        speed, heading, message = heading_toward(mine, pose, TARGET)
        assert speed == -1.0 and -math.pi <= heading <= math.pi
        if message in ('turning', 'there'):
            break
        pose = compose(Pose(pose.x, pose.y, heading), Pose(0.015, 0.0, 0.0))
        driven += 0.015
        assert mine.plan.safe_clearance_at(pose.x, pose.y) > mine.robot.drive.radius - 0.02
    assert math.hypot(pose.x - TARGET.x, pose.y - TARGET.y) < 0.02
    assert heading == TARGET.theta
    way, *words = first.split()
    assert float(way) == pytest.approx(driven, rel=0.05) and words == ['m', 'to', 'go']
    assert heading_toward(mine, Pose(TARGET.x, TARGET.y, TARGET.theta + 2.0 * math.pi), TARGET) == (
        -1.0, TARGET.theta, 'there')


def test_a_heading_is_an_angle_of_the_map_whatever_the_robot_faces():
    mine = context(room(4.0, 3.0))
    for bearing in (3.0, 1.0, -1.0, -3.0):
        for theta in (0.0, 2.5):
            target = Pose(2.0 + math.cos(bearing), 1.5 + math.sin(bearing), 0.0)
            answer = heading_toward(mine, Pose(2.0, 1.5, theta), target)
            assert answer == (-1.0, pytest.approx(bearing, abs=0.02), '1.00 m to go')


def test_the_side_to_turn_to_is_the_nearer_one():
    mine = context(room(4.0, 3.0))
    for bearing in (2.0, 1.0, -1.0, -2.0):
        target = Pose(2.0 + math.cos(bearing), 1.5 + math.sin(bearing), 0.0)
        v, w, message = velocity_toward(mine, Pose(2.0, 1.5, 0.0), target)
        assert v == 0.0 and np.sign(w) == np.sign(bearing)
        assert message == '1.00 m to go'


@pytest.mark.parametrize('target, message', [
    (Pose(math.nan, 1.0, 0.0), 'must be finite numbers'), (Pose(1.0, 1.0, math.nan), 'must be finite numbers'),
    (Pose(1.35, 0.6, 0.0), 'does not fit'), (Pose(-3.0, 1.0, 0.0), 'lies outside the map'),
    (Pose(3.5, 1.0, 0.0), r'^no path from \(0\.50, 0\.50\) to \(3\.50, 1\.00\) m$')])
def test_a_target_that_cannot_be_reached_is_an_error(target, message):
    plan = room(4.0, 3.0, boxes=((1.2, 0.4, 1.5, 0.9), (2.0, -1.0, 2.1, 4.0)))
    for toward in (velocity_toward, heading_toward):
        with pytest.raises(MapError, match=message):
            toward(context(plan), Pose(0.5, 0.5, 0.0), target)


# --- planners ---------------------------------------------------------------------------------------------------------

class Planning:
    """Planners whose functions return when a test says so."""

    def __init__(self, is_lockstep=True):
        self.later = Later()
        self.done = 0
        self.planners = executor.Planners(self.later, lambda: is_lockstep, self._count)

    def _count(self):
        self.done += 1


def test_in_lockstep_a_plan_is_there_before_the_next_step_and_never_during_one():
    planning = Planning()
    future = planning.planners.submit(lambda: 'route')
    assert planning.planners.are_at_work
    planning.later.work()
    assert not planning.planners.are_at_work and planning.done == 1 and not future.done()
    planning.planners.deliver()
    assert future.result(0) == 'route'


def test_without_lockstep_a_plan_is_there_as_soon_as_it_is_made():
    planning = Planning(is_lockstep=False)
    future = planning.planners.submit(lambda: 'route')
    assert not planning.planners.are_at_work
    planning.later.work()
    assert future.result(0) == 'route' and planning.done == 0


def test_an_error_of_a_plan_goes_to_the_behaviour():
    done = threading.Event()
    planners = executor.Planners(executor.DaemonExecutor(1), lambda: True, done.set)
    future = planners.submit(lambda: 1 // 0)
    assert done.wait(30.0)
    planners.deliver()
    with pytest.raises(ZeroDivisionError):
        future.result(0)


@pytest.mark.parametrize('drop', [lambda planners, future: future.cancel(), lambda planners, _: planners.forget()])
def test_nobody_waits_for_a_plan_that_is_not_needed_any_more(drop):
    planning = Planning()
    future = planning.planners.submit(lambda: 'route')
    assert drop(planning.planners, future)
    assert not planning.planners.are_at_work
    planning.later.work()
    planning.planners.deliver()
    assert future.cancelled() or not future.done()
    assert not planning.planners.forget()


def test_a_world_does_not_wait_for_ever_for_a_plan(monkeypatch):
    planning = Planning()
    planning.planners.submit(lambda: 'route')
    begin = time.monotonic()
    monkeypatch.setattr(executor.time, 'monotonic', lambda: begin + executor.LONGEST + 1.0)
    assert not planning.planners.are_at_work
