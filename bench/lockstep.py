"""Whether a mission through ROS, in lockstep, is that in process, bit for bit, at any speed and load; and its speed.

    ./rumba shell python3 bench/lockstep.py --maps studio --seeds 1 2 --speeds 0 10 --busy 0 6 --robots 1

Each mission runs in process, and through the nodes `simulator` and `cleaner` beside a number of busy loops. When it is
over, the digest of the world is compared with that of the mission in process at the same tick.

    ./rumba shell python3 bench/lockstep.py --against CHECKOUT

compares the speed with that of another checkout, on the studio with one robot.
"""

import argparse
import contextlib
import itertools
import pathlib
import sys
import threading
import time
from typing import NamedTuple

import rospy
from common import checkouts, figures, ros_session
from std_srvs.srv import Trigger
from tqdm import tqdm

from rumba_evaluation.trials.cases import Conditions
from rumba_evaluation.trials.trial import Trial
from rumba_msg.msg import MissionStatus
from rumba_sim.model.maps import map_file
from rumba_sim.model.simulation.robot import nth_name
from rumba_sim.model.simulation.world import World

MAPS = pathlib.Path(__file__).resolve().parents[1] / 'rumba_sim' / 'maps'
STRATEGY = 'boustrophedon'
PATIENCE = 3600.0  # [s] for a mission
FASTEST = 0.0  # speed
FASTER = 1.25  # times the speed of a8bddec0, at least


class Case(NamedTuple):
    """One mission."""

    map: str
    robots: int
    seed: int
    target: float

    def __str__(self):
        return f'{self.map}, {self.robots} robot{"s" if self.robots > 1 else ""}, seed {self.seed}'


class Ending(NamedTuple):
    """The world after a mission through ROS."""

    digest: str
    tick: int
    factor: float  # simulated seconds per second of the wall clock, from the first step to the end
    per_cpu: float  # the same per second of CPU time of all nodes


def main():
    """Run the missions and print whether they are equal."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--maps', nargs='+', default=['studio', 'apartment'], help='names of maps of rumba_sim')
    parser.add_argument('--robots', nargs='+', type=int, default=[1], help='robots with a cleaner each')
    parser.add_argument('--seeds', nargs='+', type=int, default=[1])
    parser.add_argument('--speeds', nargs='+', type=float, default=[FASTEST], help='times real time; 0: no limit')
    parser.add_argument('--busy', nargs='+', type=int, default=[0], help='busy loops beside the nodes')
    parser.add_argument('--heard', action='store_true', help='with one subscriber to each topic, in another process')
    parser.add_argument('--target', type=float, default=0.99, help='share of the floor to clean [0..1]')
    checkouts.add_arguments(parser)
    options = parser.parse_args()
    if options.against is not None:
        return compare(options.against, options.pairs, options.target)
    cases = [Case(*each, options.target) for each in itertools.product(options.maps, options.robots, options.seeds)]
    conditions = list(itertools.product(options.speeds, options.busy))
    figures.heading(f'Missions to {100.0 * options.target:g} % through ROS, in lockstep'
                    f'{", one subscriber to each topic" if options.heard else ""}')
    count = equal = 0
    with ros_session.master(), tqdm(total=len(cases) * len(conditions), unit=' missions', disable=None) as bar:
        for case in cases:
            trial = in_process(case)
            for speed, busy in conditions:
                ending = through_ros(case, speed, busy, options.heard)
                is_equal = ending.digest == digest_at(trial, ending.tick)
                count, equal = count + 1, equal + is_equal
                figures.row(f'{case}, speed {speed:g}, {busy} busy loops: {"equal" if is_equal else "NOT EQUAL"}; '
                            'simulated s per s', ending.factor)
                figures.row('    per CPU s of the nodes', ending.per_cpu)
                bar.update()
    figures.row('missions that end as in process, bit for bit', equal, at_least=count)
    return 0 if equal == count else 1


def compare(checkout, pairs, target):
    """Print the speed of this checkout against that of another one.

    Returns:
        The exit code: 1 if a mission of this checkout does not end as in process.
    """
    figures.heading(f'A mission to {100.0 * target:g} % in the studio through ROS, in lockstep, nobody else listens')
    case = Case('studio', 1, 1, target)
    trial, are_equal = in_process(case), []

    def measure(checkout):
        ending = through_ros(case, FASTEST, 0, False, checkout)
        if checkout is None:  # an older one need not have the same results
            are_equal.append(ending.digest == digest_at(trial, ending.tick))
        return {'simulated s per CPU s of the nodes': ending.per_cpu, 'simulated s per s': ending.factor}
    with ros_session.master():
        checkouts.rows(checkouts.compare(measure, checkout, pairs), FASTER)
    figures.row('missions here that end as in process, bit for bit', sum(are_equal), at_least=pairs + 1)
    return 0 if all(are_equal) else 1


def in_process(case):
    """The mission in process, at its end."""
    trial = Trial(map_file.load(MAPS / f'{case.map}.yaml'), STRATEGY, Conditions(target=case.target), case.seed,
                  case.robots)
    while not trial.is_over:
        trial.step()
    return trial


def digest_at(trial, tick):
    """The digest of a trial that has ended, at a later tick; '' if that has passed."""
    world = trial.world
    if tick < world.tick:
        return ''
    later = World.restored(world.state(), world.plan, world.config, world.step_rate, world.seed)
    later.step(tick - world.tick)
    return later.digest()


def through_ros(case, speed, busy, is_heard, checkout=None):
    """The same mission through ROS, by the nodes of another checkout unless that is None."""
    names = [nth_name(number) for number in range(1, case.robots + 1)]
    with contextlib.ExitStack() as stack:
        for _ in range(busy):
            stack.enter_context(ros_session.process([sys.executable, '-c', 'while True: pass']))
        ends = stack.enter_context(Ends(names))
        simulator = stack.enter_context(ros_session.simulator(
            checkout, map=case.map, robots=case.robots, seed=case.seed, speed=speed, brushes_up='true', lockstep='true',
            wait_for=' '.join(f'cleaner_of_{name}' for name in names)))
        if is_heard:
            stack.enter_context(ros_session.listener())
        pids = [simulator.pid]
        for name in names:
            pids.append(stack.enter_context(ros_session.process(checkouts.command(checkout, [
                'rosrun', 'rumba_cleaning', 'cleaner', f'__name:=cleaner_of_{name}', f'_robot:={name}',
                f'_team:={" ".join(names)}', f'_seed:={case.seed}', f'_strategy:={STRATEGY}',
                f'_target_coverage:={case.target}',
                '_autostart:=true']))).pid)
        begin = ends.wait_for_begin()
        cpu = sum(map(figures.cpu_seconds, pids))
        ends.wait()
        seconds, cpu = time.monotonic() - begin, sum(map(figures.cpu_seconds, pids)) - cpu
        digest, tick = rospy.ServiceProxy('/simulator/digest', Trigger)().message.split()
        return Ending(digest, int(tick), ends.simulated / seconds, ends.simulated / cpu)


class Ends:
    """Waits until the missions of robots have begun, and have ended."""

    def __init__(self, robots):
        """Listen to robots, by their names."""
        self._running = set()
        self._ended = set()
        self._robots = set(robots)
        self._changed = threading.Condition()
        self._first = self._last = None  # stamps
        self._subscribers = [
            rospy.Subscriber(f'/{robot}/mission_status', MissionStatus, self._take, robot) for robot in robots]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for subscriber in self._subscribers:
            subscriber.unregister()

    def _take(self, status, robot):
        with self._changed:
            self._last = status.header.stamp
            if status.state not in (MissionStatus.IDLE, MissionStatus.STRANDED):
                self._first = self._first or status.header.stamp
                self._running.add(robot)
            elif robot in self._running:
                self._ended.add(robot)
            self._changed.notify()

    def wait_for_begin(self):
        """Wait until a mission has begun; returns when, as a time of `time.monotonic`."""
        with self._changed:
            assert self._changed.wait_for(lambda: self._running, PATIENCE)
        return time.monotonic()

    def wait(self):
        """Wait until all missions have ended."""
        with self._changed:
            assert self._changed.wait_for(lambda: self._ended == self._robots, PATIENCE)

    @property
    def simulated(self):
        """Time from the first status of a mission that is under way to the last status [s]."""
        return (self._last - self._first).to_sec()


if __name__ == '__main__':
    sys.exit(main())
