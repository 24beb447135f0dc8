"""Growth of memory: a day in process, hours of making a map, the node at speed 0 without and with subscribers."""

import math
import os
import random
import subprocess
import sys

import numpy as np
from common import figures, ros_session

from rumba_cleaning.behaviours.bounce import Bounce
from rumba_cleaning.control import steps
from rumba_cleaning.pose_source import Mapped
from rumba_sim.model.common.config import updated
from rumba_sim.model.maps import map_file
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World
from rumba_sim.ros.participants.maps import map_path

MAP = 'studio'
HOUR, DAY = 3600, 86400  # [s]
STEP_RATE, SCAN_RATE = 50, 10  # [Hz]
GROWTH = 5.0  # [%] the upper bound
WARM, LONG = 5.0, 45.0  # [s] of the wall clock, before and during the measurement of the node
MAPPING = 4  # [h] of a robot that makes a map
IN_PROCESS, WITH_MAP = '--in-process', '--with-map'


def main():
    """Measure and print."""
    for what in (IN_PROCESS, WITH_MAP):  # each in a process of its own, without rospy and its threads
        subprocess.run([sys.executable, os.path.abspath(__file__), what], check=True)
    with ros_session.master(), ros_session.simulator(map=MAP, speed=0) as node:
        figures.heading(f'Memory of the node at speed 0, one robot on the map {MAP}')
        through_node('no subscriber', node)
        with ros_session.listener():
            through_node('one subscriber to each topic', node)


def through_node(title, node):
    """Print the memory of the node early, and later."""
    before, _, _ = node.watch(WARM)
    first = node.resident
    simulated, _, _ = node.watch(LONG)
    figures.row(f'{title}: after {before / HOUR:.2f} simulated hours [MB]', first)
    figures.row(f'  {simulated / HOUR:.2f} simulated hours later [MB]', node.resident)
    figures.row('  growth [%]', 100.0 * (node.resident / first - 1.0), below=GROWTH)


def day():
    """Print the memory of this process during a simulated day: one robot bounces around, with its laser on."""
    config = updated(RobotConfig(), {'battery': {'drain': 0.05}}, 'bench')  # so that the battery lasts all day
    world = World(map_file.load(map_path(MAP)), config, STEP_RATE, seed=1)
    robot = world.spawn('rumba')
    chance = random.Random(1)
    turns_until, turn = 0, 0.0
    first = 0.0
    for scans in range(1, DAY * SCAN_RATE + 1):
        if any(robot.bumper):
            turn = math.copysign(1.5, chance.random() - 0.5)
            turns_until = world.tick + chance.randint(STEP_RATE // 2, 2 * STEP_RATE)
        if world.tick < turns_until:
            robot.command(-0.05, turn, world.tick)
        else:
            robot.command(0.3, 0.0, world.tick)
        world.step(STEP_RATE // SCAN_RATE)
        world.scan('rumba')
        if scans == HOUR * SCAN_RATE:
            first = figures.resident_megabytes()
        if scans % (HOUR * SCAN_RATE) == 0 and sys.stderr.isatty():
            print(f'\r  {scans // (HOUR * SCAN_RATE)} of 24 hours', end='\r', file=sys.stderr)
    assert robot.battery.percentage > 0 and robot.bumps > 24, 'it did not drive all day'
    last = figures.resident_megabytes()
    figures.heading(f'Memory of a process with a day of simulated time: one robot on the map {MAP}, {SCAN_RATE} scans '
                    f'a second, {robot.distance / 1000.0:.1f} km, {robot.bumps} bumps')
    figures.row('after an hour [MB]', first)
    figures.row('after a day [MB]', last)
    figures.row('  growth [%]', 100.0 * (last / first - 1.0), below=GROWTH)


def with_map():
    """Print the memory of this process while a robot bounces around the floor of which it has made a map."""
    config = updated(RobotConfig(), {'battery': {'drain': 0.0}}, 'bench')
    plan = map_file.load(map_path(MAP))
    world = World(plan, config, STEP_RATE, seed=1)
    world.spawn('rumba')
    source = Mapped(world, 'rumba', plan.dock)
    memory = []
    for hour in range(MAPPING):
        for _ in steps(Bounce(np.random.default_rng(hour)), world, seconds=HOUR, source=source):
            pass
        source.plan()  # as missions ask for it
        memory.append((figures.resident_megabytes(), len(source.mapper.frames)))
    figures.heading(f'Memory of a process in which a robot makes a map of {MAP}, 10 scans a second')
    for title, (megabytes, frames) in (('after an hour', memory[0]), (f'after {MAPPING} hours', memory[-1])):
        figures.row(f'{title} [MB]', megabytes)
        figures.row('  scans that the map shows', frames)
    figures.row('  growth [%]', 100.0 * (memory[-1][0] / memory[0][0] - 1.0), below=GROWTH)


if __name__ == '__main__':
    if IN_PROCESS in sys.argv:
        day()
    elif WITH_MAP in sys.argv:
        with_map()
    else:
        main()
