"""The private channel of an examination: frames come whole and in order, to one judge, whoever is slow or ends."""

import io
import os
import socket
import stat
import threading
import time
import types

import pytest
import rospy
from geometry_msgs.msg import Twist
from std_msgs.msg import Header

from rumba_msg.msg import Bumper, LockstepAnswer
from rumba_sim.model.common.errors import WorldError
from rumba_sim.ros.participants import examiner
from rumba_sim.ros.participants.examiner import ExaminerClient, ExaminerServer, socket_path
from rumba_sim.ros.participants.examiner_frames import COMMAND, INTRUDER, MESSAGE, Frame, frames, packed
from rumba_sim.ros.robot.rates import EVERYTHING
from rumba_sim.ros.simulator.lockstep import Lockstep
from rumba_sim.ros.simulator.settings import Settings

TOPIC, COMMANDS, STUDENT = '/rumba/bumper', '/rumba/cmd_vel', '/student'
PATIENCE = 20.0  # [s]
MANY = 3000  # frames: several times what the sockets keep


@pytest.fixture(autouse=True)
def temporary(tmp_path, monkeypatch):
    """A temporary folder of the test, a master that need not run, and a node of a name."""
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path))
    monkeypatch.setenv('ROS_MASTER_URI', 'http://localhost:11999')
    monkeypatch.setattr(rospy, 'get_name', lambda: '/simulator')
    return tmp_path


@pytest.fixture
def server():
    """The end of a simulator in lockstep, which has one topic and keeps the answers."""
    found = ExaminerServer(socket_path())
    found.declare(TOPIC, Bumper)
    found.answers = []
    found.open(True, found.answers.append)
    yield found
    found.close()


@pytest.fixture
def client():
    """The end of a judge."""
    found = ExaminerClient()
    yield found
    found.close()


def bumper(number):
    """A message of a tick."""
    return Bumper(Header(stamp=rospy.Time(number)), bool(number % 2), False)


def tell(server, *numbers):
    """Tell of ticks."""
    for number in numbers:
        server.tell(TOPIC, bumper(number), rospy.Time(number))


def heard(client, count):
    """The stamps [s] of the next frames."""
    found = client.frames()
    return [next(found).secs for _ in range(count)]


def until(condition):
    """Wait until a condition holds."""
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end, 'waited in vain'
        time.sleep(0.005)


def test_frames_come_as_they_were_packed_and_a_part_of_one_does_not_count():
    told = [Frame(MESSAGE, b'content', TOPIC, 'rumba_msg/Bumper', '/simulator', 7, 250_000_000), Frame(INTRUDER)]
    content = b''.join(map(packed, told))
    assert list(frames(io.BytesIO(content))) == told and told[0].time == 7.25
    for length in range(len(packed(told[0]))):
        assert list(frames(io.BytesIO(content[:length]))) == []


def test_a_judge_hears_in_order_what_happened_before_it_came_and_after(server, client):
    tell(server, 1, 2)
    twist = Twist()
    twist.linear.x = 0.5
    server.tell_command(COMMANDS, twist, rospy.Time(2), STUDENT)
    hello = client.connect(socket_path(), PATIENCE)
    assert hello == ('/simulator', True, {TOPIC: 'rumba_msg/Bumper'})
    tell(server, 3)
    found = client.frames()
    first, second, command, third = (next(found) for _ in range(4))
    assert [frame.message() for frame in (first, second, third)] == [bumper(1), bumper(2), bumper(3)]
    assert (command.kind, command.topic, command.sender, command.message()) == (COMMAND, COMMANDS, STUDENT, twist)


def test_a_slow_judge_loses_nothing_and_the_world_waits_for_it(server, client):
    client.connect(socket_path(), PATIENCE)
    world = threading.Thread(target=tell, args=(server, *range(MANY)))
    world.start()
    time.sleep(0.2)
    assert world.is_alive()
    assert heard(client, MANY) == list(range(MANY))
    world.join()


def test_a_judge_that_reads_nothing_for_too_long_is_told_no_more(server, client, monkeypatch):
    monkeypatch.setattr(examiner, 'PATIENCE', 1)
    client.connect(socket_path(), PATIENCE)
    tell(server, *range(MANY))  # does not wait for ever
    assert 0 < len(list(client.frames())) < MANY


def test_a_second_process_is_refused_and_the_judge_told(server, client):
    client.connect(socket_path(), PATIENCE)
    tell(server, 1)
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as spy:
        spy.connect(socket_path())
        assert list(frames(spy.makefile('rb'))) == [Frame(INTRUDER)]
    tell(server, 2)
    found = client.frames()
    assert [next(found).kind for _ in range(3)] == [MESSAGE, INTRUDER, MESSAGE]


def test_a_judge_that_comes_after_another_process_learns_it(server, client):
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as spy:
        spy.connect(socket_path())
        spy.recv(1)
        with pytest.raises(WorldError, match=examiner.REFUSED):
            client.connect(socket_path(), PATIENCE)


def test_answers_come_to_the_simulator(server, client):
    client.connect(socket_path(), PATIENCE)
    answer = LockstepAnswer(Header(stamp=rospy.Time(3)), 'run', '/judge', LockstepAnswer.DONE, '')
    client.answer(answer)
    until(lambda: server.answers)
    assert server.answers == [answer]


def test_the_world_goes_on_when_the_judge_ends(server, client):
    client.connect(socket_path(), PATIENCE)
    client.close()
    tell(server, *range(MANY))


def test_the_judge_learns_when_the_simulator_ends(server, client):
    client.connect(socket_path(), PATIENCE)
    tell(server, 1)
    server.close()
    assert len(list(client.frames())) == 1
    client.answer(LockstepAnswer())
    assert not os.path.exists(socket_path())


def test_without_a_judge_the_world_goes_on_and_keeps_no_more_than_it_may(server, client, monkeypatch):
    monkeypatch.setattr(examiner, 'MOST_WAITING', 10)
    tell(server, *range(20))
    with pytest.raises(WorldError, match='no simulator in an examination listens at '):
        client.connect(socket_path(), 0.1)


def test_a_judge_waits_for_the_simulator(client):
    server = ExaminerServer(socket_path())
    opening = threading.Timer(0.2, server.open, [False, lambda _: None])
    opening.start()
    assert not client.connect(socket_path(), PATIENCE).is_lockstep
    server.close()


def test_what_a_killed_simulator_left_is_taken_away_but_a_living_one_keeps_its_socket(server):
    with pytest.raises(WorldError, match='another process listens there'):
        ExaminerServer(socket_path())
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as killed:
        killed.bind(f'{socket_path()}1')
    ExaminerServer(f'{socket_path()}1').close()


def test_the_folder_is_for_its_user_alone(temporary):
    folder = os.path.dirname(socket_path())
    assert stat.S_IMODE(os.stat(folder).st_mode) == 0o700 and socket_path().endswith('/11999')
    os.chmod(folder, 0o755)
    with pytest.raises(WorldError, match='must be your own folder, closed to others'):
        socket_path()


def test_the_folder_for_temporary_files_may_have_a_long_path(temporary, client):
    folder = temporary / ('x' * 200)
    folder.mkdir()
    server = ExaminerServer(str(folder / '11999'))
    server.open(True, print)
    assert client.connect(str(folder / '11999'), PATIENCE).node == '/simulator'
    server.close()


def test_a_path_that_cannot_be_used_is_told(temporary):
    with pytest.raises(WorldError, match=r'/none/11999: No such file or directory$'):
        ExaminerServer(str(temporary / 'none' / '11999'))


# --- the simulator in an examination ------------------------------------------------------------------------------

def answer_to(second):
    """What the judge answers to a tick."""
    return LockstepAnswer(Header(stamp=rospy.Time(second)), 'run', '/judge', LockstepAnswer.DONE, '')


def test_once_the_judge_has_answered_nobody_answers_for_it_by_a_topic(monkeypatch):
    monkeypatch.setattr(rospy, 'Publisher', lambda *_, **__: types.SimpleNamespace(
        resolved_name='/simulator/lockstep', get_num_connections=lambda: 0))
    by_topic, ticks = [], []
    monkeypatch.setattr(rospy, 'Subscriber', lambda topic, kind, take, **_: by_topic.append(take))
    channel = types.SimpleNamespace(declare=lambda *_: None, tell=lambda topic, tick, stamp: ticks.append(tick))
    requests = types.SimpleNamespace(post=lambda act: act())
    lockstep = Lockstep(requests, 'run', 'judge', 10.0, lambda _: True, channel)
    for second in (1, 2):
        lockstep.publish(EVERYTHING, rospy.Time(second), 0)
        assert lockstep.is_waiting and ticks[-1].header.stamp == rospy.Time(second)
        if second == 2:
            by_topic[0](answer_to(second))
            assert lockstep.is_waiting
        lockstep.on_examiner(answer_to(second))
        assert not lockstep.is_waiting
    assert ticks[-1].odom == rospy.Time(2) and ticks[-1].cleaning.is_zero()  # of cleaning_status no topic tells


def test_nodes_do_not_learn_in_an_examination_what_makes_a_world_differ_from_others():
    usual = Settings(seed=7, obstacles='things.yaml', localisation='none')
    assert usual.told is usual
    told = Settings(seed=7, obstacles='things.yaml', localisation='none', exam=True).told
    assert (told.seed, told.obstacles, told.exam) == (0, '', True)
