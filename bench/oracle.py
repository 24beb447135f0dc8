"""How exactly another localisation, that of MRPT, tracks a robot by the same scans and the same odometry as ours.

`oracle.py [--seeds N] [--seconds S]` has a robot bounce about each map with seeds 1 to N. The particle filter of MRPT
weighs particles by the likelihood field, too (Thrun, Burgard, Fox, Probabilistic Robotics, ch. 6 and 8); it needs
python3-pymrpt, which Debian 13 has and Debian 12 lacks.
"""

import argparse
import itertools
import math
import sys
import time
from typing import NamedTuple

import numpy as np
from common import figures

from rumba_cleaning import control
from rumba_cleaning.behaviours.bounce import Bounce
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.pose_source import Localised
from rumba_sim.model.common.geometry import Pose, as_told, compose, inverse, wrap_angle
from rumba_sim.model.maps import map_file, named_maps
from rumba_sim.model.settings.laser_config import LaserConfig
from rumba_sim.model.simulation.world import World

LASER = LaserConfig()
NAMES = ('studio', 'apartment')
RMS = 0.03  # [m] at most
PARTICLES = 500
SPREAD = 0.003, math.radians(0.3)  # [m], [rad] that MRPT adds to each movement: in 0.1 s our wheels err by less


class Drive(NamedTuple):
    """What was told, what was true, and what was believed, at each control tick of a drive: poses [m, rad], scans."""

    odometry: list
    scans: list
    truth: list
    believed: list
    cost: float  # CPU time of our localisation [s]


def drive(name, seed, seconds):
    """Drive about a map, and localise the robot meanwhile."""
    plan = map_file.load(named_maps.path(name))
    world = World(plan, seed=seed)
    world.spawn('rumba')
    source = Localised(plan, world, 'rumba', seed)
    bounce = Bounce(np.random.default_rng(seed), CleaningConfig().speed)
    found, robot, cost = Drive([], [], [], [], 0.0), world.robots['rumba'], 0.0
    for _ in range(round(seconds / control.CONTROL_DT)):
        begun = time.process_time()
        believed = source(world, 'rumba')
        cost += time.process_time() - begun
        for values, value in zip(found, (as_told(robot.odometry), believed.scan, robot.pose, believed.pose)):
            values.append(value)
        command = bounce.step(control.observe(world, 'rumba', control.CONTROL_DT, lambda *_: believed))
        robot.command(command.v, command.w, world.tick)
        world.step(control.CONTROL_TICKS)
    return found._replace(cost=cost)


class Oracle:
    """The Monte Carlo localisation of MRPT, told where the robot begins."""

    def __init__(self, mrpt, name, start):
        """Know a map of rumba_sim, and where the robot is on it."""
        self._mrpt = mrpt
        self._map = mrpt.maps.COccupancyGridMap2D.FromROSMapServerYAML(str(named_maps.path(name)))
        likelihood = self._map.likelihoodOptions
        likelihood.likelihoodMethod = mrpt.maps.COccupancyGridMap2D.TLikelihoodMethod.lmLikelihoodField_Thrun
        likelihood.LF_stdHit, likelihood.LF_decimation = 0.03, 5
        self._pdf = mrpt.slam.CMonteCarloLocalization2D(PARTICLES)
        self._pdf.options.metricMap = self._map
        self._pdf.resetDeterministic(mrpt.math.TPose2D(*start), PARTICLES)
        self._filter = mrpt.bayes.CParticleFilter()
        self._motion = mrpt.obs.CActionRobotMovement2D.TMotionModelOptions()
        gaussian = self._motion.gaussianModel
        gaussian.minStdXY, gaussian.minStdPHI = SPREAD

    def observe(self, moved, scan):
        """Take a movement (x, y [m], theta [rad]), and a scan at its end; returns the mean of the particles."""
        mrpt = self._mrpt
        movement = mrpt.obs.CActionRobotMovement2D()
        movement.computeFromOdometry(mrpt.poses.CPose2D(*moved), self._motion)
        actions, frame = mrpt.obs.CActionCollection(), mrpt.obs.CSensoryFrame()
        actions.insert(movement)
        frame.insert(self._converted(scan))
        self._filter.executeOn(self._pdf, actions, frame)
        mean = self._pdf.getMeanVal()
        return Pose(mean.x(), mean.y(), mean.phi())

    def _converted(self, scan):
        mrpt, x, y = self._mrpt, *scan.points.T
        converted = mrpt.obs.CObservation2DRangeScan()
        step = 2.0 * math.pi / LASER.beams  # ours begin straight back; those of MRPT lie evenly on both sides of ahead
        converted.aperture, converted.maxRange, converted.rightToLeft = 2.0 * math.pi - step, LASER.range_max, True
        converted.sensorPose = mrpt.poses.CPose3D(0.0, 0.0, 0.0, -0.5 * step, 0.0, 0.0)
        converted.resizeScan(LASER.beams)
        for beam in range(LASER.beams):
            converted.setScanRangeValidity(beam, False)
        beams = np.rint((np.arctan2(y, x) + math.pi) / step).astype(int) % LASER.beams
        for beam, distance in zip(beams.tolist(), np.hypot(x, y).tolist()):
            converted.setScanRange(beam, distance)
            converted.setScanRangeValidity(beam, True)
        return converted


def show(title, poses, truth, cost, seconds):
    """Print the errors of poses."""
    off = np.array([math.dist(pose[:2], true[:2]) for pose, true in zip(poses, truth)])
    turned = np.array([wrap_angle(pose.theta - true.theta) for pose, true in zip(poses, truth)])
    figures.row(f'{title}: RMS of the error [m]', math.sqrt((off ** 2).mean()), below=RMS)
    figures.row('    largest error [m]', off.max())
    figures.row('    RMS of the error of the heading [degrees]', math.degrees(math.sqrt((turned ** 2).mean())))
    figures.row('    simulated seconds per CPU second', seconds / cost)


def main():
    """Print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--seeds', type=int, default=3)
    parser.add_argument('--seconds', type=float, default=120.0)
    arguments = parser.parse_args()
    try:
        from mrpt.pymrpt import mrpt
    except ImportError as error:
        print(f'no other localisation to compare with: {error}; it comes with python3-pymrpt, on Debian 13')
        return
    for name, seed in itertools.product(NAMES, range(1, arguments.seeds + 1)):
        figures.heading(f'A robot that bounces about the {name} for {arguments.seconds:g} s, seed {seed}')
        found = drive(name, seed, arguments.seconds)
        show('localiser', found.believed, found.truth, found.cost, arguments.seconds)
        begun, before, poses = time.process_time(), found.odometry[0], []
        oracle = Oracle(mrpt, name, found.truth[0])
        for odometry, scan in zip(found.odometry, found.scans):
            poses.append(oracle.observe(compose(inverse(before), odometry), scan))
            before = odometry
        show(f'MRPT, {PARTICLES} particles', poses, found.truth, time.process_time() - begun, arguments.seconds)


if __name__ == '__main__':
    sys.exit(main())
