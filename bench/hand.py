"""Missions in which a person takes over now and then: how many end at their target nevertheless.

Each mission cleans the map studio. At random moments a person drives the robot for 0.3 to 3 s, in any direction; while
the person drives, and for a short time after the last command, the mission stands by. A mission has ended at its target
if it succeeded, the floor is as clean as asked for, and the robot is docked.

    ./rumba shell python3 bench/hand.py --runs 200 --ros 5
"""

import argparse
import collections
import contextlib
import os
import pathlib
import threading
import time
from typing import NamedTuple

import actionlib
import numpy as np
import rospy
from common import figures, ros_session
from geometry_msgs.msg import Twist
from tqdm import tqdm

from rumba_cleaning.behaviour import Status
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.control import CONTROL_DT, CONTROL_TICKS, STEP_RATE, act, observe
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.outcome import Outcome
from rumba_evaluation.trials import batch
from rumba_msg.msg import CleanAction, CleanGoal, DockStatus
from rumba_sim.model.maps import map_file
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.robot import FIRST
from rumba_sim.model.simulation.world import World
from rumba_sim.ros.common import teleop

MAPS = pathlib.Path(__file__).resolve().parents[1] / 'rumba_sim' / 'maps'
MAP = 'studio'
STRATEGY = 'boustrophedon'
TARGET = 0.9
NOT_MEASURED = 0.01  # of the floor: what the robot believes to be swept may differ from what is
GAP = (2.0, 40.0)  # [s] from one takeover to the next ...
GAP_ROS = (0.5, 5.0)  # ... and through ROS, where a mission takes less of the wall clock
DURATION = (0.3, 3.0)  # [s] of a takeover
MAX_V, MAX_W = 0.5, 1.9  # [m/s], [rad/s]
LIMIT = 3600.0  # [s] of simulated time for a mission
SPEED = 10.0  # of a mission through ROS [times real time]
KEY_PERIOD = 0.1  # [s] from one command of the person to the next


class Ending(NamedTuple):
    """How a mission ended."""

    seed: int
    outcome: Outcome
    message: str
    coverage: float  # [0..1] of the true floor
    is_docked: bool
    takeovers: int

    @property
    def is_at_target(self):
        """Whether all is as it shall be."""
        return self.outcome is Outcome.SUCCEEDED and self.coverage >= TARGET - NOT_MEASURED and self.is_docked

    def __str__(self):
        return (f'seed {self.seed}: {self.outcome.name}, {self.message}; {100.0 * self.coverage:.1f} % swept, '
                f'{"docked" if self.is_docked else "not docked"}, {self.takeovers} takeovers')


class Person:
    """Takes over at moments, for durations and with velocities that a seed decides on.

    Attributes:
        takeovers: how often so far.
    """

    def __init__(self, seed, gap):
        """Watch first; `gap` is the least and the longest time from one takeover to the next [s]."""
        self._generator = np.random.default_rng(seed)
        self._gap = gap
        self._begin = self._generator.uniform(*gap)
        self._end = self._begin
        self.takeovers = 0

    def command(self, now):
        """The velocity [m/s], [rad/s] that the person commands at a time [s]; None while the person only watches."""
        if now < self._begin:
            return None
        if self._end <= self._begin:
            self._end = self._begin + self._generator.uniform(*DURATION)
            self._velocity = self._generator.uniform(-MAX_V, MAX_V), self._generator.uniform(-MAX_W, MAX_W)
            self.takeovers += 1
        if now < self._end:
            return self._velocity
        self._begin = self._end = now + self._generator.uniform(*self._gap)
        return None


def main():
    """Run the missions and print how they ended."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--runs', type=int, default=200, help='missions in process')
    parser.add_argument('--ros', type=int, default=0, help='missions through ROS')
    parser.add_argument('--seed', type=int, default=0, help='of the first mission; each further one has the next')
    parser.add_argument('--jobs', type=int, default=os.cpu_count(), help='processes at a time')
    options = parser.parse_args()
    seeds = range(options.seed, options.seed + options.runs)
    with batch.local(options.jobs) as executor:
        show('in process', [ending for _, ending in batch.each(executor, mission, seeds, 'missions')])
    if options.ros:
        with ros_session.master():
            show(f'through ROS, speed {SPEED:g}', [
                mission_through_ros(seed)
                for seed in tqdm(range(options.seed, options.seed + options.ros), unit=' missions', disable=None)])


def show(title, endings):
    """Print how many missions ended at their target, and why the others did not."""
    if not endings:
        return
    figures.heading(f'{len(endings)} missions on the map {MAP} to {100.0 * TARGET:g} %, a person takes over: {title}')
    figures.row('takeovers in a mission', sum(ending.takeovers for ending in endings) / len(endings))
    for outcome, count in collections.Counter(ending.outcome for ending in endings).items():
        figures.row(f'outcome {outcome.name}', count)
    figures.row('ended at the target', sum(ending.is_at_target for ending in endings), at_least=len(endings))
    for ending in sorted(endings):
        if not ending.is_at_target:
            print(f'    {ending}')


# --- in process -------------------------------------------------------------------------------------------------------

def mission(seed):
    """A mission by the rules of the node `cleaner`; simulated time stands for the wall clock at speed 1."""
    plan = map_file.load(MAPS / f'{MAP}.yaml')
    world, person = World(plan, RobotConfig(), STEP_RATE, seed), Person(seed, GAP)
    robot = world.spawn(FIRST, brushes_up=True)
    world.step()  # the contacts of the dock close in the first tick
    cleaning = Mission(Context(plan, RobotConfig(), CleaningConfig(), seed), STRATEGY, TARGET)
    driven_until, dt = 0.0, 0.0
    while cleaning.status is Status.RUNNING and world.time < LIMIT:
        if robot.has_fallen:
            cleaning.fail('a wheel hangs over a cliff', Outcome.FALLEN)
            break
        command = person.command(world.time)
        if command is not None:
            robot.command(*command, world.tick)
            driven_until = world.time + teleop.TIMEOUT
        if world.time < driven_until:
            cleaning.stand_by(observe(world, FIRST, dt))
        else:
            act(cleaning, world, FIRST, dt)
        world.step(CONTROL_TICKS)
        dt = CONTROL_DT
    return Ending(seed, cleaning.outcome, cleaning.message, world.floor.coverage, robot.is_docked, person.takeovers)


# --- through ROS ------------------------------------------------------------------------------------------------------

def mission_through_ros(seed):
    """The same with the nodes, the person on the wall clock."""
    cleaner = ['rosrun', 'rumba_cleaning', 'cleaner']
    with ros_session.simulator(map=MAP, speed=SPEED, seed=seed), ros_session.process(cleaner):
        client = actionlib.SimpleActionClient('rumba/clean', CleanAction)
        client.wait_for_server()
        client.send_goal(CleanGoal(strategy=STRATEGY, target_coverage=TARGET))
        with keyboard(Person(seed, GAP_ROS)) as person:
            client.wait_for_result()
        result = client.get_result()
        is_docked = rospy.wait_for_message(f'{FIRST}/dock_status', DockStatus).is_docked
    return Ending(seed, Outcome(result.outcome.code), result.outcome.message, result.cleaning.coverage, is_docked,
                  person.takeovers)


@contextlib.contextmanager
def keyboard(person):
    """Publish what a person commands, as long as the block."""
    publisher = rospy.Publisher(f'{FIRST}/{teleop.TOPIC}', Twist, queue_size=1)
    has_ended, begin = threading.Event(), time.monotonic()

    def publish():
        while not has_ended.wait(KEY_PERIOD):
            command = person.command(time.monotonic() - begin)
            if command is not None:
                twist = Twist()
                twist.linear.x, twist.angular.z = command
                publisher.publish(twist)
    thread = threading.Thread(target=publish)
    thread.start()
    try:
        yield person
    finally:
        has_ended.set()
        thread.join()
        publisher.unregister()


if __name__ == '__main__':
    main()
