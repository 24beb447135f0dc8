"""Whether a robot that cleans every day for a month holds what it held at first: memory, files, threads.

`endurance.py [--days N] [--ros]` simulates N days, 3 in process and 2 through ROS by default: each morning a mission on
the map apartment, then the robot rests on its dock. Without `--ros`, the days pass in this process; with it, in the
nodes simulator and cleaner at speed 0, which takes some minutes a day. What missions leave behind shows sooner if the
robot rests less: with `--day 4000`, a day has 4,000 s.
"""

import argparse
import os
import time

import actionlib
import rospy
import tqdm
from common import figures, ros_session

from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.control import STEP_RATE, steps
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.outcome import Outcome
from rumba_msg.msg import CleanAction, CleanGoal
from rumba_sim.model.maps import map_file, named_maps
from rumba_sim.model.simulation.world import World

MAP, TARGET = 'apartment', 0.98
STRIDE = 10  # [s] of rest in one call
GROWTH = 5.0  # [%] from the second day on, the upper bound


def main():
    """Simulate and print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--ros', action='store_true', help='through the nodes simulator and cleaner')
    parser.add_argument('--days', type=int)
    parser.add_argument('--day', type=int, default=86400, metavar='SECONDS', help='how long a day is')
    options = parser.parse_args()
    days = (2 if options.ros else 3) if options.days is None else options.days
    if days < 2:
        parser.error(f'--days is {days}: must be 2 or more, since growth counts from the second day on')
    if options.day < 1:
        parser.error(f'--day is {options.day}: must be 1 or more seconds')
    (through_ros if options.ros else in_process)(days, options.day)


# --- in process -------------------------------------------------------------------------------------------------------

def in_process(days, day):
    """Simulate days, of so many seconds each, in this process and print what it holds."""
    plan = map_file.load(named_maps.path(MAP))
    world = World(plan, step_rate=STEP_RATE, seed=1)
    world.spawn('rumba', brushes_up=True)
    held = [a_day(plan, world, number, day) for number in tqdm.trange(days, unit='day', disable=None)]
    figures.heading(f'A robot that cleans the {MAP} every morning, {days} days in process')
    figures.row(f'simulated time [days of {day:,} s]', world.time / day, at_least=days)
    figures.row('driven [km]', world.robots['rumba'].distance / 1000.0)
    tell('the process', held)


def a_day(plan, world, number, day):
    """A mission and the rest of a day [s]; returns what this process holds in the evening.

    Raises:
        AssertionError: the mission failed.
    """
    end = world.time + day
    context = Context(plan, world.config, CleaningConfig(), seed=number)
    mission = Mission(context, 'boustrophedon', TARGET)
    for _ in steps(mission, world, seconds=day):
        pass
    assert mission.outcome is Outcome.SUCCEEDED and world.robots['rumba'].is_docked, mission.message
    while world.time < end:
        world.step(STRIDE * STEP_RATE)
    return holdings('self')


# --- through ROS ------------------------------------------------------------------------------------------------------

def through_ros(days, day):
    """Simulate days, of so many seconds each, with the nodes and print what they hold."""
    with ros_session.master(), ros_session.simulator(map=MAP, speed=0, seed=1, brushes_up='true') as simulator, \
            ros_session.process(['rosrun', 'rumba_cleaning', 'cleaner', f'_target_coverage:={TARGET}']) as cleaner:
        client = actionlib.SimpleActionClient('/rumba/clean', CleanAction)
        ros_session.wait_until(lambda: client.wait_for_server(rospy.Duration(1)))
        begin, held = time.monotonic(), []
        for number in tqdm.trange(days, unit='day', disable=None):
            clean(client)
            while simulator.simulated() < (number + 1) * day:
                pass
            held.append((holdings(simulator.pid), holdings(cleaner.pid)))
        simulated, seconds = simulator.simulated(), time.monotonic() - begin
    figures.heading(f'A robot that cleans the {MAP} every morning, {days} days through ROS')
    figures.row(f'simulated time [days of {day:,} s]', simulated / day, at_least=days)
    figures.row('simulated s per s', simulated / seconds)
    for name, of_node in zip(('simulator', 'cleaner'), zip(*held)):
        tell(name, of_node)


def clean(client):
    """A mission.

    Raises:
        AssertionError: it failed.
    """
    client.send_goal(CleanGoal())
    client.wait_for_result()
    outcome = client.get_result().outcome
    assert outcome.code == Outcome.SUCCEEDED.value, outcome


# --- figures ----------------------------------------------------------------------------------------------------------

def holdings(pid):
    """Memory [MB], open files and threads of a process."""
    files, threads = (len(os.listdir(f'/proc/{pid}/{each}')) for each in ('fd', 'task'))
    return figures.resident_megabytes(pid), files, threads


def tell(name, held):
    """Print what a process held in some evenings, and how its memory grew."""
    for number in sorted({0, 1, len(held) // 2, len(held) - 1}):
        megabytes, files, threads = held[number]
        figures.row(f'{name}, day {number + 1}: memory [MB]', megabytes)
        figures.row('    open files', files)
        figures.row('    threads', threads)
    figures.row(f'{name}: growth of memory since the second day [%]', 100.0 * (held[-1][0] / held[1][0] - 1.0),
                below=GROWTH)


if __name__ == '__main__':
    main()
