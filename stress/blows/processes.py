"""Blows on processes: killed, stopped, ended and started again."""

import signal
import time

import psutil
from common.ros_session import wait_until

from stress import goals, wire
from stress.blows import fresh
from stress.blows.blow import some_member
from stress.failure import Failure
from stress.member import ENDS_WITHIN, Member

STOPPED = (0.1, 2.0)  # [s] shortest and longest stop
GONE = (0.0, 1.0)  # [s] shortest and longest absence
GIVES_UP_WITHIN = 40.0  # [s] for a goal whose robot is gone
AGAIN_WITHIN = 40.0  # [s] until all nodes are known to a master that was started again


def kill(ground, chance, blow):
    """kill -9 of a node, which is started again."""
    member = some_member(ground, chance)
    absence = chance.uniform(*GONE)
    blow.say(f'kill -9 of {member.name}, started again {absence:.1f} s later', faults=1)
    if member is ground.world and chance.random() < 0.5:
        blow.say('but not before a goal of clean has ended')
        with goals.client(ground, 'clean') as client:
            client.send()
            member.kill()
            client.await_results(GIVES_UP_WITHIN)
    member.kill()
    time.sleep(absence)
    ground.start(member)


def stop(ground, chance, blow):
    """SIGSTOP of a node, and SIGCONT after a while."""
    member = some_member(ground, chance)
    _stop(member, chance, blow)


def stop_master(ground, chance, blow):
    """SIGSTOP of the master, and SIGCONT after a while."""
    _stop(ground.master, chance, blow)


def _stop(member, chance, blow):
    seconds = chance.uniform(*STOPPED)
    blow.say(f'SIGSTOP of {member.name} for {seconds:.1f} s', faults=1)
    member.process.send_signal(signal.SIGSTOP)
    time.sleep(seconds)
    member.process.send_signal(signal.SIGCONT)


def end(ground, chance, blow):
    """SIGTERM or Ctrl-C of a node, which is started again."""
    member = some_member(ground, chance)
    number = chance.choice((signal.SIGTERM, signal.SIGINT))
    blow.say(f'{signal.Signals(number).name} of {member.name}', faults=1)
    if member is ground.cleaner and chance.random() < 0.7:
        blow.say('while it cleans')
        with goals.client(ground, 'clean') as client:
            client.send()
            time.sleep(chance.uniform(0.0, 1.0))
            fresh.ends(member, number)
            client.await_results(1.0)
    else:
        fresh.ends(member, number)
    ground.start(member)


def shutdown(ground, chance, blow):
    """The shutdown of ROS, as rosnode kill asks for it."""
    member = some_member(ground, chance)
    blow.say(f'rosnode kill of {member.name}', faults=1)
    try:
        wire.ask(ground.node_uri(member.name), 'shutdown', 'a blow')
    except wire.WireError:  # the answer may be lost in the end of the node
        pass
    try:
        wait_until(lambda: not member.is_alive, 20.0)
    except TimeoutError:
        raise Failure('end', member.name, 'does not end after rosnode kill') from None
    fresh.ends(member, signal.SIGTERM)
    ground.start(member)


def kill_master(ground, chance, blow):
    """kill -9 of the master, which is started again and knows nothing."""
    absence = chance.uniform(*GONE)
    blow.say(f'kill -9 of the master, started again {absence:.1f} s later', faults=1)
    ground.master.kill()
    time.sleep(absence)
    ground.start_master()
    for member in ground.members.values():
        if not member.role.registers_again:
            fresh.ends(member, signal.SIGTERM)
            ground.start(member)
    try:
        wait_until(lambda: all(map(ground.answers, ground.members.values())), AGAIN_WITHIN)
    except TimeoutError:
        lost = [member.name for member in ground.members.values() if not ground.answers(member)]
        raise Failure('registered', 'master', f'after the master was started again, it never hears of '
                      f'{", ".join(lost)}') from None
    for member in ground.everybody:  # the connections are new ones
        member.baseline = None


def twin(ground, chance, blow):
    """A second simulator starts beside the first, which goes on; the second says why it does not."""
    arguments = chance.choice(((), ('__name:=other',), ('__ns:=/upstairs',)))
    blow.say(f'a second simulator {" ".join(arguments)}', faults=1)
    twin = Member(ground.world.role, ground.environment, ground.folder)
    twin.start(arguments=arguments)
    try:
        twin.process.wait(ENDS_WITHIN)
    except psutil.TimeoutExpired:
        raise Failure('twin', 'world', 'a second simulator runs beside the first') from None
    finally:
        twin.kill()
    fresh.check_refusal(twin)
