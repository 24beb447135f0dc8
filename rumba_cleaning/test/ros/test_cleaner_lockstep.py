#!/usr/bin/env python3
"""In lockstep, a mission through ROS is the same as in process, bit for bit, whatever happens to the processes."""

import os
import pathlib
import signal
import subprocess
import sys
import time
import unittest
import unittest.mock

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from cleaners import Cleaner, go_to
from simulators import TICK, Heard, Simulator, wait
from teams import QUICKLY
from tiers import thorough

from rumba_cleaning.behaviour import Status
from rumba_cleaning.belief.context import Context, own_seed
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.control import CONTROL_TICKS, STEP_RATE, steps
from rumba_cleaning.executors import BeforeNextStep
from rumba_cleaning.mission.mapless import MaplessMission
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.pose_source import reckoned, truth
from rumba_msg.msg import CleanGoal, LockstepAnswer, MissionStatus, Outcome
from rumba_sim.model.maps import map_file
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.robot import FIRST
from rumba_sim.model.simulation.world import World
from rumba_sim.ros.participants.maps import map_path

HERE = pathlib.Path(__file__).resolve().parent
SEED = 3
TARGET = 0.02  # with it a mission still undocks, plans, cleans, returns and docks
BUSY = 4  # loops beside the nodes
STOPPED = 1.5  # [s] of the wall clock
PATIENCE = 5  # [s] of the wall clock: on a busy machine, a cleaner that plans may be silent for seconds
SIMULATOR = '_map:=studio', f'_seed:={SEED}', '_speed:=50', '_brushes_up:=true'
MAPLESS = '_mapless:=true', '_strategy:=wander', '_cleaning_time:=60'
CLEANER = f'_seed:={SEED}', f'_target_coverage:={TARGET}'


def digest_in_process(ticks, begin=1):
    """The digest of the world so many ticks after the start of a mission that begins at a tick."""
    plan = map_file.load(map_path('studio'))
    world, planners = World(plan, RobotConfig(), STEP_RATE, SEED), BeforeNextStep()
    world.spawn(FIRST, brushes_up=True)
    world.step(begin)
    mission = Mission(Context(plan, RobotConfig(), QUICKLY, own_seed(SEED, FIRST), planners), 'boustrophedon', TARGET)
    return digest_of(mission, world, ticks, truth, planners)


def digest_without_map(ticks):
    """The same of a mission without a map, which begins at the first tick."""
    world = World(map_file.load(map_path('studio')), RobotConfig(), STEP_RATE, SEED)
    world.spawn(FIRST, brushes_up=True)
    world.step()
    context = Context.without_map(RobotConfig(), CleaningConfig(cleaning_time=60.0), own_seed(SEED, FIRST))
    return digest_of(MaplessMission(context, 'wander'), world, ticks, reckoned)


def digest_of(mission, world, ticks, source, planners=BeforeNextStep()):
    """The digest so many ticks after the start, by poses of a source."""
    for _ in steps(mission, world, FIRST, 3600.0, source):
        planners.work()
    assert mission.status is Status.SUCCEEDED, mission.message
    world.step(ticks - world.tick)
    return world.digest()


class CleanerLockstepTest(unittest.TestCase):
    """Each test has its own nodes."""

    def autostarted(self, loops=0):
        """A simulator that waits for its cleaner from the first tick on, and that cleaner; busy loops run meanwhile."""
        simulator = Simulator(self, *SIMULATOR, '_wait_for:=cleaner')
        for _ in range(loops):
            busy = subprocess.Popen([sys.executable, '-c', 'while True: pass'])
            self.addCleanup(busy.wait)
            self.addCleanup(busy.kill)
        # Listen before the cleaner starts: its mission may be over before the clients of its actions are connected.
        status = Heard(self, '/rumba/mission_status', MissionStatus, waits=False)
        cleaner = Cleaner(self, *CLEANER, '_autostart:=true').connect()
        cleaner.status = status
        return simulator, cleaner

    def ends_as_in_process(self, simulator, cleaner, begin=1):
        """Wait until the mission has ended at its target, and compare the world."""
        for state in (MissionStatus.CLEANING, MissionStatus.DOCKING):  # on a busy machine, each takes its time
            cleaner.status.find(lambda status, state=state: status.state == state)
        ended = cleaner.status.find(lambda status: status.state == MissionStatus.IDLE and 'swept' in status.message)
        self.assertRegex(ended.message, r'^2\.\d % swept$')
        digest, tick = simulator.digest()
        self.assertEqual(digest, digest_in_process(tick, begin))

    @thorough
    def test_a_mission_is_the_same_beside_busy_loops(self):
        self.ends_as_in_process(*self.autostarted(BUSY))

    @thorough
    def test_a_mission_without_a_map_is_the_same(self):
        simulator = Simulator(self, *SIMULATOR, '_wait_for:=cleaner', '_localisation:=none')
        status = Heard(self, '/rumba/mission_status', MissionStatus, waits=False)
        Cleaner(self, *MAPLESS, f'_seed:={SEED}', '_autostart:=true')
        status.find(lambda status: status.state == MissionStatus.CLEANING)
        ended = status.find(lambda status: status.state == MissionStatus.IDLE and 'cleaned' in status.message)
        self.assertRegex(ended.message, '^cleaned for 1 (of 1 )?min$')
        digest, tick = simulator.digest()
        self.assertEqual(digest, digest_without_map(tick))

    def test_a_mission_is_the_same_although_its_processes_are_stopped_for_a_while(self):
        simulator, cleaner = self.autostarted()
        cleaner.status.find(lambda status: status.state == MissionStatus.CLEANING)
        for process in (cleaner.process, simulator.process):
            process.send_signal(signal.SIGSTOP)
            time.sleep(STOPPED)
            process.send_signal(signal.SIGCONT)
        self.ends_as_in_process(simulator, cleaner)

    def test_a_mission_is_the_same_after_a_reset(self):
        simulator = Simulator(self, *SIMULATOR)
        cleaner = Cleaner(self, *CLEANER).connect()
        cleaner.send('go_to', go_to(2.5, 2.0)).ends(Outcome.SUCCEEDED)
        simulator.pause()
        simulator.does('reset')
        cleaner.status.messages.clear()
        goal = cleaner.send('clean', CleanGoal())
        wait(self, lambda: goal.handle.get_goal_status() == GoalStatus.ACTIVE, 'the goal to be accepted')
        simulator.does('resume')
        self.ends_as_in_process(simulator, cleaner, CONTROL_TICKS - (simulator.ticks - 1) % CONTROL_TICKS)

    def test_the_world_does_not_wait_for_a_cleaner_without_a_goal(self):
        simulator, log = Simulator(self, *SIMULATOR, f'_lockstep_patience:={PATIENCE}'), Heard(self, '/rosout')
        cleaner = Cleaner(self).connect()
        answers = Heard(self, '/simulator/lockstep_answers', LockstepAnswer)
        cleaner.send('go_to', go_to(2.5, 2.0)).ends(Outcome.SUCCEEDED)
        rests = answers.last(lambda answer: answer.state == LockstepAnswer.RESTS).header.stamp.to_nsec() // TICK
        wait(self, lambda: simulator.digest()[1] > rests, 'the world to hear that it rests', period=0.1)
        cleaner.process.send_signal(signal.SIGSTOP)
        self.addCleanup(cleaner.process.send_signal, signal.SIGCONT)
        _, tick = simulator.digest()
        wait(self, lambda: simulator.digest()[1] > tick + 100 * CONTROL_TICKS, 'the world to go on', period=0.1)
        cleaner.process.send_signal(signal.SIGCONT)
        cleaner.send('go_to', go_to(2.0, 2.0)).is_active()
        self.assertEqual([message.msg for message in log.messages if 'lockstep: nothing' in message.msg], [])
        cleaner.process.send_signal(signal.SIGSTOP)
        log.find(lambda message: message.msg.startswith('lockstep: no answer of /cleaner'))

    def test_the_world_goes_on_at_once_without_a_cleaner_that_was_killed_and_takes_in_the_next_one(self):
        simulator = Simulator(self, *SIMULATOR, '_lockstep_patience:=600')
        cleaner, log = Cleaner(self).connect(), Heard(self, '/rosout')
        cleaner.send('go_to', go_to(2.5, 2.0)).is_active()
        cleaner.process.kill()
        cleaner.process.wait()
        tick = simulator.digest()[1]
        wait(self, lambda: simulator.digest()[1] > tick + 100 * CONTROL_TICKS, 'the world to go on', period=0.1)
        lines = ['lockstep: /cleaner has ended without a word: the world goes on without it until it answers again']
        Cleaner(self).connect().send('go_to', go_to(2.0, 2.0)).ends(Outcome.SUCCEEDED)
        self.assertEqual([message.msg for message in log.messages if message.msg.startswith('lockstep')], lines)
        simulator.end()

    def test_the_world_waits_for_a_cleaner_that_takes_longer_than_its_patience_for_one_step(self):
        simulator = Simulator(self, *SIMULATOR, '_lockstep_patience:=1', '_wait_for:=cleaner')
        log = Heard(self, '/rosout')
        status = Heard(self, '/rumba/mission_status', MissionStatus, waits=False)
        with unittest.mock.patch.dict(os.environ, PYTHONPATH=f'{HERE}:{os.environ["PYTHONPATH"]}'):
            Cleaner(self, *CLEANER, '_autostart:=true', '_strategies:=sluggish', '_strategy:=sluggish')
        status.find(lambda status: status.state == MissionStatus.IDLE and status.message.endswith('sluggish'))
        self.assertEqual([message.msg for message in log.messages if message.msg.startswith('lockstep')], [])
        simulator.end()


if __name__ == '__main__':
    rospy.init_node('test_cleaner_lockstep')
    rostest.rosrun('rumba_cleaning', 'cleaner_lockstep', CleanerLockstepTest)
