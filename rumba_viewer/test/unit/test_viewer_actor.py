"""Which commands, goals and calls the window sends, and what it tells of their answers, without a master."""

import pytest
import rospy
from actionlib import CommState
from dynamic_reconfigure.srv import ReconfigureResponse
from std_srvs.srv import TriggerResponse

from rumba_msg.msg import CleanResult, GoToResult, Outcome
from rumba_viewer.ros import actor, robot_client

pytestmark = pytest.mark.usefixtures('topics')


class Handle:
    """A goal that has ended."""

    def __init__(self, result):
        self._result = result

    def get_comm_state(self):
        return CommState.DONE

    def get_result(self):
        return self._result


class ActionClient:
    """A fake client of actionlib: the server may answer even before `send_goal` returns."""

    answers_at_once = None

    def __init__(self, name, kind):
        self.goals, self.transitions = [], []

    def stop(self):
        self.cancel_all_goals = None

    def send_goal(self, goal, transition):
        self.goals.append(goal)
        self.transitions.append(transition)
        handle = Handle(self.answers_at_once)
        if self.answers_at_once is not None:
            transition(handle)
        return handle


@pytest.fixture
def client(monkeypatch):
    """A client of rumba, and what it tells."""
    monkeypatch.setattr(robot_client.actionlib, 'ActionClient', ActionClient)
    told = []
    one = robot_client.RobotClient('rumba', told.append)
    one.told = told
    return one


def test_keys_drive_by_the_input_for_a_person(client, topics):
    client.drive(0.3, -1.5)
    [twist] = topics['rumba/teleop/cmd_vel'].published
    assert (twist.linear.x, twist.angular.z) == (0.3, -1.5)
    assert 'rumba/cmd_vel' not in topics


def test_a_client_that_was_closed_by_another_thread_sends_nothing(client, topics):
    client.close()
    client.drive(0.3, 0.0)
    client.dock()
    client.cancel()
    assert topics['rumba/teleop/cmd_vel'].published == client._clients['dock'].goals == []


def test_resuming_a_cleaning_is_a_goal_of_clean(client):
    client.resume_cleaning()
    client.clean('spiral')
    assert [(goal.resume, goal.strategy) for goal in client._clients['clean'].goals] == [(True, ''), (False, 'spiral')]


def test_a_refusal_that_comes_at_once_is_told(client, monkeypatch):
    monkeypatch.setattr(ActionClient, 'answers_at_once', CleanResult(
        outcome=Outcome(Outcome.REFUSED, 'no cleaning was interrupted')))
    client.resume_cleaning()
    assert client.told == ['rumba: clean: no cleaning was interrupted']


def test_only_the_newest_goal_of_an_action_tells_its_result(client):
    client.go_to(1.0, 2.0)
    client.go_to(3.0, 4.0)
    for message, transition in zip(('preempted', 'arrived'), client._clients['go_to'].transitions):
        transition(Handle(GoToResult(outcome=Outcome(message=message))))
    assert client.told == ['rumba: go to: arrived']


def test_a_cleaner_that_is_gone_is_told(client):
    client.dock()
    client._clients['dock'].transitions[0](Handle(None))
    assert client.told == ['rumba: dock: the cleaner is gone']


def test_services_of_the_simulator_are_below_the_name_of_its_node(monkeypatch):
    called = []
    monkeypatch.setattr(rospy, 'ServiceProxy', lambda name, kind: lambda *request: (
        called.append(name), TriggerResponse(True, 'done'))[1])
    one = actor.Actor('rumba')
    for act, service in ((one.pause, 'pause'), (one.unpause, 'resume'), (one.reset, 'reset'), (one.step, 'step')):
        act('/house/sim2')
        assert one.notices.get(timeout=10.0).endswith(': done')
        assert called.pop() == f'/house/sim2/{service}'


def test_an_odd_answer_of_a_service_is_told(monkeypatch):
    monkeypatch.setattr(rospy, 'ServiceProxy', lambda name, kind: lambda *request: ReconfigureResponse())
    one = actor.Actor('rumba')
    one.set_speed('/sim2', 2.0)
    assert one.notices.get(timeout=10.0) == "speed: KeyError: 'speed'"


def test_a_robot_that_is_selected_while_the_master_ends_is_told(monkeypatch):
    def refuse(*_):
        raise ConnectionRefusedError('no master')
    monkeypatch.setattr(actor, 'RobotClient', refuse)
    one = actor.Actor('rumba')
    one.select('rumba2')
    assert one.notices.get(timeout=10.0) == 'rumba2: not connected: ConnectionRefusedError: no master'
