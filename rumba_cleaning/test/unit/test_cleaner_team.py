"""What cleaners of one team tell each other, and hear, whatever order messages come in."""

import numpy as np
import pytest
import rospy
from geometry_msgs.msg import Pose2D
from numpy.testing import assert_array_equal
from rooms import quiet, room
from std_msgs.msg import Header

from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.mates import Report, Task
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.ros.cleaner.goals.activities import Cleaning
from rumba_cleaning.ros.cleaner.robots import team
from rumba_cleaning.ros.cleaner.robots.team import PATIENCE, SILENT, Team
from rumba_cleaning.route import Ahead, Relief, Route
from rumba_msg.msg import CleanGoal, TeamPlan, TeamReport
from rumba_sim.model.common.geometry import Pose

NAMES = 'rumba', 'rumba2'
HERE = Pose(1.0, 2.0, 0.5)
ROUTE = Route(np.array([(1.0, 2.0), (2.0, 2.0), (2.0, 1.0)]), np.array([0.3, 0.45]))
OTHER = Route(np.array([(0.1, 0.2), (0.3, 0.2)]), np.array([0.3]))


class Wire:
    """Stands for the topics of ROS: keeps what is published until it is passed on."""

    def __init__(self):
        self.sent = []  # (topic, message)
        self.listeners = {}
        self.warnings = []

    def publisher(self, topic, kind, **_):
        """As rospy.Publisher."""
        return type('Publisher', (), {'publish': lambda _, message: self.sent.append((topic, message))})()

    def subscriber(self, topic, kind, callback, argument, **_):
        """As rospy.Subscriber."""
        self.listeners[topic] = lambda message: callback(message, argument)
        return type('Subscriber', (), {'get_num_connections': lambda _: 1})()

    def take(self):
        """What was published since the last time."""
        sent, self.sent = self.sent, []
        return sent

    def deliver(self, messages):
        """Pass messages on."""
        for topic, message in messages:
            self.listeners[topic](message)


@pytest.fixture
def wire(monkeypatch):
    made = Wire()
    monkeypatch.setattr(team.rospy, 'Publisher', made.publisher)
    monkeypatch.setattr(team.rospy, 'Subscriber', made.subscriber)
    for level in ('logwarn', 'logwarn_throttle'):
        monkeypatch.setattr(team.rospy, level, lambda *words: made.warnings.append(words[-1]))
    return made


@pytest.fixture
def pair(wire):
    """The teams of two robots, of which the first listens, and what the first knows."""
    context = Context(room(4.0, 3.0), quiet(), CleaningConfig())
    first, second = (Team(name, NAMES) for name in NAMES)
    context.mates = first.mates()
    return first, second, context


def at(seconds):
    return rospy.Time.from_sec(seconds)


def test_a_report_arrives_as_it_was_told(wire, pair):
    first, second, context = pair
    told = Report(HERE, False, Task.SWEEPING, Ahead(ROUTE, 1.5, 7, Relief('rumba', 3, 2.5)))
    second.tell(told, at(1.0))
    wire.deliver(wire.take())
    first.listen([context.hear], at(1.1))
    heard = context.mates.reports['rumba2']
    assert heard._replace(ahead=None) == told._replace(ahead=None)
    assert heard.ahead[1:] == told.ahead[1:]
    for mine, theirs in zip(heard.ahead.route, ROUTE):
        assert_array_equal(mine, theirs)


def test_a_plan_is_published_only_if_it_is_another_one(wire, pair):
    _, second, _ = pair
    for remaining, route in ((2.0, ROUTE), (1.5, ROUTE), (0.2, OTHER)):
        second.tell(Report(HERE, False, Task.SWEEPING, Ahead(route, remaining)), at(1.0))
    sent = [(topic.split('/')[1], message.route) for topic, message in wire.take()]
    assert sent == [('team_plan', 1), ('team_report', 1), ('team_report', 1), ('team_plan', 2), ('team_report', 2)]


def test_a_report_waits_for_its_plan_and_those_after_it_wait_too(wire, pair):
    first, second, context = pair
    second.tell(Report(HERE, False, Task.SEEKING), at(1.0))
    wire.deliver(wire.take())
    first.listen([context.hear], at(1.0))
    second.tell(Report(HERE, False, Task.SWEEPING, Ahead(ROUTE, 2.0)), at(1.1))
    second.tell(Report(HERE, True, Task.RETURNING), at(1.2))
    plan, *reports = wire.take()
    wire.deliver(reports)
    first.listen([context.hear], at(1.2))
    assert context.mates.reports['rumba2'].task is Task.SEEKING
    wire.deliver([plan])
    first.listen([context.hear], at(1.3))
    assert context.mates.reports['rumba2'].task is Task.RETURNING


def test_a_plan_that_overtakes_a_report_does_not_take_the_place_of_its_own(wire, pair):
    first, second, context = pair
    second.tell(Report(HERE, False, Task.SWEEPING, Ahead(ROUTE, 2.0)), at(1.0))
    second.tell(Report(HERE, False, Task.SWEEPING, Ahead(OTHER, 0.2)), at(1.1))
    plan, report, other_plan, other_report = wire.take()
    wire.deliver([plan, other_plan, report])
    first.listen([context.hear], at(1.1))
    assert_array_equal(context.mates.reports['rumba2'].ahead.route.waypoints, ROUTE.waypoints)
    wire.deliver([other_report])
    first.listen([context.hear], at(1.2))
    assert_array_equal(context.mates.reports['rumba2'].ahead.route.waypoints, OTHER.waypoints)


def test_in_lockstep_nothing_is_heard_before_its_time(wire, pair):
    first, second, context = pair
    second.tell(Report(HERE, False, Task.SEEKING), at(1.0))
    wire.deliver(wire.take())
    first.listen([context.hear], at(1.0), before=at(1.0))
    assert context.mates.reports == {}
    first.listen([context.hear], at(1.1), before=at(1.1))
    assert context.mates.reports['rumba2'].task is Task.SEEKING


def test_a_robot_in_lockstep_waits_until_its_mate_has_told_and_sent_its_plan_but_not_for_ever(wire, pair, monkeypatch):
    first, second, _ = pair
    clock = [100.0]
    monkeypatch.setattr(team.time, 'monotonic', lambda: clock[0])
    assert first.have_told(None) and first.have_told(at(1.0))  # nobody knows yet that there is a mate
    second.tell(Report(HERE, False, Task.SWEEPING, Ahead(ROUTE, 2.0)), at(1.0))
    plan, report = wire.take()
    wire.deliver([report])
    assert not first.have_told(at(1.0))
    wire.deliver([plan])
    assert first.have_told(at(1.0)) and not first.have_told(at(1.1))
    clock[0] += PATIENCE
    assert first.have_told(at(1.1)) and first.have_told(at(1.2))
    second.tell(Report(HERE, True, Task.OFF), at(1.2))
    wire.deliver(wire.take())
    assert first.have_told(at(1.2)) and not first.have_told(at(1.3))


def test_a_mate_that_falls_silent_is_taken_to_have_stopped(wire, pair):
    first, second, context = pair
    second.tell(Report(HERE, False, Task.SWEEPING, Ahead(ROUTE, 2.0)), at(1.0))
    wire.deliver(wire.take())
    first.listen([context.hear], at(1.0))
    first.listen([context.hear], at(1.0 + SILENT))
    assert context.mates.are_busy and not wire.warnings
    first.listen([context.hear], at(1.1 + SILENT))
    assert not context.mates.are_busy and context.mates.reports['rumba2'].pose == HERE
    assert wire.warnings == ['rumba: rumba2 has fallen silent: it counts as stopped']


def test_a_new_goal_begins_with_what_mates_told_last(wire, pair):
    first, second, context = pair
    second.tell(Report(HERE, True, Task.DOCKED), at(1.0))
    wire.deliver(wire.take())
    first.listen([], at(1.0))
    assert first.mates().reports['rumba2'].task is Task.DOCKED


def test_the_mission_of_a_cleaning_hears_mates_and_so_does_what_is_resumed_of_it():
    context = Context(room(4.0, 3.0), quiet(), CleaningConfig())
    cleaning = Cleaning.of_goal(context, CleanGoal())
    for activity, pose in ((cleaning, HERE), (cleaning.resumed(0.0), Pose(3.0, 1.0, 0.0))):
        activity.hear('rumba2', Report(pose, True, Task.OFF))
        assert context.mates.reports['rumba2'].pose == pose


NAN = float('nan')


@pytest.mark.parametrize('topic, bad', [
    ('team_report', TeamReport(task=6)), ('team_report', TeamReport(remaining=NAN)),
    ('team_report', TeamReport(pose=Pose2D(NAN, 0.0, 0.0))), ('team_report', TeamReport(relieved_length=NAN)),
    ('team_plan', TeamPlan(route=1)), ('team_plan', TeamPlan(route=1, x=[1.0], y=[1.0])),
    ('team_plan', TeamPlan(route=1, x=[1.0, 2.0], y=[1.0], speed=[0.3])),
    ('team_plan', TeamPlan(route=1, x=[1.0, NAN], y=[1.0, 2.0], speed=[0.3])),
    ('team_plan', TeamPlan(route=1, x=[1.0, 2.0], y=[1.0, 2.0], speed=[0.0]))])
def test_what_makes_no_sense_is_ignored_with_a_line(wire, pair, topic, bad):
    first, _, context = pair
    wire.deliver([(f'rumba2/{topic}', bad)])
    first.listen([context.hear], at(1.0))
    assert context.mates.reports == {} and len(wire.warnings) == 1 and wire.warnings[0].startswith(f'rumba2/{topic} is')


@pytest.mark.parametrize('remaining', [-1.0, 0.0, 1e9])
def test_an_odd_length_that_is_left_is_borne(wire, pair, remaining):
    first, _, context = pair
    wire.deliver([('rumba2/team_plan', TeamPlan(Header(), 1, [1.0, 2.0, 2.0], [1.0, 1.0, 2.0], [0.3, 0.3])),
                  ('rumba2/team_report', TeamReport(task=TeamReport.SWEEPING, route=1, remaining=remaining))])
    first.listen([context.hear], at(1.0))
    rest = context.mates.sweeping()['rumba2'].rest()
    assert np.isfinite(rest.waypoints).all() and len(rest.speeds) >= 1


def test_a_robot_without_mates_tells_nothing(wire):
    alone = Team('rumba', ('rumba',))
    alone.tell(Report(HERE, True, Task.OFF), at(1.0))
    alone.listen([], at(1.0))
    assert alone.is_alone and wire.sent == [] and wire.listeners == {} and alone.have_told(at(1.0))


def test_the_tasks_are_those_of_the_message():
    assert {task.name: int(task) for task in Task} == {
        name: getattr(TeamReport, name) for name in ('OFF', 'SEEKING', 'SWEEPING', 'RETURNING', 'DOCKING', 'DOCKED')}
