"""How exactly a robot localises itself, how fast it finds its place, and how missions by that pose go.

`localisation.py [--seeds N] [--first M] [--troubles]` runs N seeds, 20 by default, from M on, 1 by default, on all
cores; times are simulated, but for the cost. With --troubles it runs only the missions in which the laser is silent for
a while, or the wheels slip.
"""

import argparse
import concurrent.futures
import functools
import math
import statistics
import time
from typing import NamedTuple

import numpy as np
from common import figures
from common.mishaps import SilentLaser, Slip

from rumba_cleaning import control
from rumba_cleaning.behaviour import Observation
from rumba_cleaning.behaviours.bounce import Bounce
from rumba_cleaning.behaviours.relocation import Relocation
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.pose_source import Localised
from rumba_evaluation.trials import starts
from rumba_evaluation.trials.cases import ANYWHERE, LOCALISED, TRUTH, Conditions
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.common.geometry import wrap_angle
from rumba_sim.model.maps import map_file, named_maps
from rumba_sim.model.simulation.world import World

NAMES = ('studio', 'apartment')
TARGET = 0.98
FOUND = 0.15, math.radians(5.0)  # [m], [rad] error of a pose that is found
HELD = 2.0  # [s] for which it must stay found
LIMIT = 60.0  # [s] of a search
WITHIN = 30.0  # [s]
BEFORE = 10.0  # [s] of driving before the robot is carried away
SILENCE, SLIPPING = 10.0, 1.0  # [s] for which the laser is silent, and for which the wheels slip
WHEN = 0.05, 1.2  # between which multiples of T a mishap happens
SOON = 5.0  # [s]
MISHAPS = {
    f'laser silent for {SILENCE:g} s': lambda trial, due: SilentLaser(trial, due, SILENCE),
    f'wheels turn {SLIPPING:g} s, the robot does not move': lambda trial, due: Slip(trial, due, SLIPPING, False),
    f'robot slides {SLIPPING:g} s, its wheels do not turn': lambda trial, due: Slip(trial, due, SLIPPING, True)}


class Mission(NamedTuple):
    """A mission by a kind of pose."""

    multiple: float  # working time to the target, in multiples of T
    is_home: bool
    position: float  # RMS of the error [m]
    heading: float  # RMS of the error [rad]
    worst: float  # [m]
    lost: float  # share of the time in which the robot was not sure
    cost: float  # CPU time of the localisation per simulated second [s]
    speed: float  # simulated seconds per CPU second, all in all


class Troubled(NamedTuple):
    """A mission with a mishap."""

    worst: float  # [m] largest error of position from the mishap on
    unnoticed: float  # [m] the same while the robot was sure of its place
    sigmas: float  # the same, in standard deviations
    until: float  # [s] from the end of the mishap until the error was below FOUND for good
    is_noticed: bool  # whether the robot was not sure of its place, at some time from the mishap on
    driven: float  # [m] during the mishap
    is_done: bool  # reached its target, as far as it knows
    swept: float  # [0..1] true coverage at the end
    is_home: bool


@functools.lru_cache(maxsize=None)
def floor(name):
    """The plan of a map."""
    return map_file.load(named_maps.path(name))


def error(belief, world):
    """Error of a belief about the robot of a world: distance [m], angle [rad]."""
    pose = world.robots['rumba'].pose
    return (math.hypot(belief.pose.x - pose.x, belief.pose.y - pose.y),
            abs(wrap_angle(belief.pose.theta - pose.theta)))


class Watched:
    """A source of poses, with the errors of all that it told and the CPU time that it took."""

    def __init__(self, source):
        """Watch a source."""
        self.source, self.errors, self.told, self.cost = source, [], [], 0.0

    def __call__(self, world, name):
        """What the source believes."""
        begun = time.process_time()
        belief = self.source(world, name)
        self.cost += time.process_time() - begun
        self.errors.append(error(belief, world))
        self.told.append(belief)
        return belief

    @property
    def lost(self):
        """Whether the robot was not sure of its place: bool (observations)."""
        return np.array([Observation(0.0, each.pose, covariance=each.covariance, silence=each.silence).is_lost
                         for each in self.told])


def mission(name, pose, seed):
    """A mission on a map, by a kind of pose."""
    begun = time.process_time()
    trial = Trial(floor(name), 'boustrophedon', Conditions(start=ANYWHERE, pose=pose, target=TARGET), seed)
    watched = trial.sources['rumba'] = Watched(trial.sources['rumba'])
    while not trial.is_over:
        trial.step()
    errors, result = np.array(watched.errors), trial.result()
    return Mission(result.multiple_to(round(100 * TARGET)), result.docked == 1, *np.sqrt((errors ** 2).mean(axis=0)),
                   errors[:, 0].max(), watched.lost.mean(), watched.cost / result.time,
                   result.time / (time.process_time() - begun))


def troubled(name, title, seed):
    """A mission on a map, with a mishap of this title."""
    trial = Trial(floor(name), 'boustrophedon', Conditions(start=ANYWHERE, pose=LOCALISED, target=TARGET), seed)
    due = trial.ideal_time * np.random.default_rng(seed).uniform(*WHEN)
    mishap = MISHAPS[title](trial, due)
    watched = trial.sources['rumba'] = Watched(trial.sources['rumba'])
    times, driven = [], []
    while not trial.is_over:
        times.append(trial.world.time)
        driven.append(trial.world.robots['rumba'].distance)
        trial.step()
    result = trial.result()
    since = np.searchsorted(times, mishap.begun)
    errors, lost, times = np.array(watched.errors)[since:, 0], watched.lost[since:], np.array(times)[since:]
    sigmas = np.sqrt([max(belief.covariance[0][0], belief.covariance[1][1]) for belief in watched.told[since:]])
    wrong = np.flatnonzero(errors >= FOUND[0])
    until = times[wrong[-1]] - mishap.ended if len(wrong) else 0.0
    end = np.searchsorted(times, mishap.ended)
    return Troubled(errors.max(), errors[~lost].max(), (errors / sigmas).max(), max(until, 0.0), bool(lost.any()),
                    driven[since + end] - driven[since], not result.has_failed, result.coverage, result.docked == 1)


def search(name, is_carried, seed):
    """Seconds until a robot has found its place, which nobody told it, or from which it was carried to another one."""
    plan, generator = floor(name), np.random.default_rng(seed)
    world = World(plan, seed=seed)
    poses = starts.anywhere(plan, world.config, world.start, 2, generator)
    world.spawn('rumba', poses[0])
    source = Localised(plan, world, 'rumba', seed)
    context = Context(plan, world.config, CleaningConfig(), seed)
    if is_carried:
        _drive(world, source, Bounce(context.generator, CleaningConfig().speed).step, BEFORE)
        world.teleport('rumba', poses[1])
    else:
        source.localiser.search_anywhere()
    return _found(_drive(world, source, Relocation(context).command, LIMIT))


def _drive(world, source, decide, seconds):
    """Drive for some time; returns for each step whether the place was known."""
    known = []
    end = world.time + seconds
    while world.time < end:
        observation = control.observe(world, 'rumba', control.CONTROL_DT, source)
        off, turned = error(observation, world)
        known.append(not observation.is_lost and off < FOUND[0] and turned < FOUND[1])
        command = decide(observation)
        world.robots['rumba'].command(command.v, command.w, world.tick)
        world.step(control.CONTROL_TICKS)
    return known


def _found(known):
    """Seconds after which the place was known for good."""
    held = 0
    for step, is_known in enumerate(known, 1):
        held = held + 1 if is_known else 0
        if held * control.CONTROL_DT >= HELD:
            return (step - held) * control.CONTROL_DT
    return math.inf


def main():
    """Print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--seeds', type=int, default=20)
    parser.add_argument('--first', type=int, default=1)
    parser.add_argument('--troubles', action='store_true')
    given = parser.parse_args()
    seeds = range(given.first, given.first + given.seeds)
    with concurrent.futures.ProcessPoolExecutor() as executor:
        for name in NAMES:
            if not given.troubles:
                undisturbed(name, seeds, executor)
            for title in MISHAPS:
                figures.heading(f'Localisation on the map {name}, {title}, {len(seeds)} seeds')
                mishaps(list(executor.map(functools.partial(troubled, name, title), seeds)))


def undisturbed(name, seeds, executor):
    """Missions on a map without mishaps, and searches."""
    figures.heading(f'Localisation on the map {name}, {len(seeds)} seeds')
    told = list(executor.map(functools.partial(mission, name, LOCALISED), seeds))
    true = list(executor.map(functools.partial(mission, name, TRUTH), seeds))
    missions(told, true)
    for title, is_carried in (('place found, told nothing', False), ('place found, carried away', True)):
        searches(title, list(executor.map(functools.partial(search, name, is_carried), seeds)))


def missions(told, true):
    """Print how missions went."""
    figures.row('RMS error of position [m], worst mission', max(each.position for each in told), below=0.03)
    figures.row('RMS error of heading [deg], worst mission', math.degrees(max(each.heading for each in told)),
                below=1.5)
    figures.row('largest error of position [m]', max(each.worst for each in told), below=0.15)
    figures.row('largest share of the time not sure', max(each.lost for each in told))
    ratios = [one.multiple / other.multiple for one, other in zip(told, true)]
    figures.row(f'{100 * TARGET:.0f} % swept: time by that of the true pose, median', statistics.median(ratios),
                below=1.15)
    figures.row('    the same, worst', max(ratios))
    figures.row('home', sum(each.is_home for each in told), at_least=len(told))
    figures.row('CPU time at real time [%]', 100.0 * statistics.median(each.cost for each in told), below=10.0)
    figures.row('simulated seconds per CPU second, all', statistics.median(each.speed for each in told), at_least=200)


def mishaps(results):
    """Print how missions with a mishap went."""
    figures.row('largest error of position [m], median', statistics.median(each.worst for each in results))
    figures.row('    the same, worst mission', max(each.worst for each in results))
    figures.row('    the same, while sure of its place', max(each.unnoticed for each in results), below=0.5)
    figures.row('    the same, in standard deviations', max(each.sigmas for each in results))
    figures.row('not sure of its place at some time [missions]', sum(each.is_noticed for each in results))
    figures.row('driven during the mishap [m], farthest', max(each.driven for each in results))
    figures.row('from its end until within 0.15 m for good [s], median', statistics.median(
        each.until for each in results))
    figures.row('    the same, longest', max(each.until for each in results), below=SOON)
    figures.row(f'{100 * TARGET:.0f} % swept, as far as it knows [missions]', sum(each.is_done for each in results),
                at_least=len(results))
    figures.row('    truly swept [%], least', 100.0 * min(each.swept for each in results), at_least=97)
    figures.row('home', sum(each.is_home for each in results), at_least=len(results))


def searches(title, seconds):
    """Print how searches went."""
    figures.row(f'{title}, within {WITHIN:.0f} s', sum(each <= WITHIN for each in seconds),
                at_least=math.ceil(0.95 * len(seconds)))
    figures.row('    median time [s]', statistics.median(seconds))
    figures.row('    longest time [s]', max(seconds))


if __name__ == '__main__':
    main()
