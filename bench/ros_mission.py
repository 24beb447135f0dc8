"""The same mission in process, and through the nodes `simulator` and `cleaner` at several speeds: how much gets clean.

A whole mission on the map studio, from the dock to the dock: at speed 1 it takes five minutes.
"""

import pathlib

import actionlib
from common import figures, ros_session

from rumba_evaluation.trials.trial import Trial
from rumba_msg.msg import CleanAction, CleanGoal
from rumba_sim.model import map_file

MAP = 'studio'
MAPS = pathlib.Path(__file__).resolve().parents[1] / 'rumba_sim' / 'maps'
STRATEGY = 'boustrophedon'
SPEEDS = (10.0, 1.0)
APART = 2.0  # [% of the floor] from each other, at most
TARGET = 0.99


def main():
    """Clean, and print."""
    figures.heading(f'A whole mission, {STRATEGY} on the map {MAP}, to {100.0 * TARGET:g} %')
    trial = Trial(map_file.load(MAPS / f'{MAP}.yaml'), STRATEGY, seed=1)
    while not trial.is_over:
        trial.step()
    robot, coverage = trial.world.robots['rumba'], trial.world.floor.coverage
    show('in process', coverage, robot.brush_time, robot.distance)
    with ros_session.master():
        for speed in SPEEDS:
            cleaning = through_ros(speed)
            show(f'through ROS, speed {speed:g}', cleaning.coverage, cleaning.time, cleaning.distance)
            figures.row('    apart from the one in process [% of the floor]',
                        100.0 * abs(cleaning.coverage - coverage), below=APART)


def show(title, coverage, seconds, distance):
    """The figures of one mission."""
    figures.row(f'{title}: clean [%]', 100.0 * coverage)
    figures.row('    brushes down for [s], simulated', seconds)
    figures.row('    driven [m]', distance)


def through_ros(speed):
    """What is clean after the goal `clean` was met; rumba_msg/CleaningStatus."""
    cleaner = ['rosrun', 'rumba_cleaning', 'cleaner']
    with ros_session.simulator(map=MAP, speed=speed), ros_session.process(cleaner):
        client = actionlib.SimpleActionClient('rumba/clean', CleanAction)
        client.wait_for_server()
        client.send_goal(CleanGoal(strategy=STRATEGY, target_coverage=TARGET))
        client.wait_for_result()
        return client.get_result().cleaning


if __name__ == '__main__':
    main()
