"""Ten simulated minutes of a busy world are the same in two processes, bit for bit."""

import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
RUN = '''
import hashlib, sys
import numpy as np
from rooms import crooked
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.world import World

for seed in map(int, sys.argv[1:]):
    world = World(crooked(dock=Pose(3.8, 1.0, 0.0), cliff=(3.6, 2.6, 4.0, 3.0), carpet=(0.0, 0.0, 1.0, 1.0)),
                  seed=seed)
    for number in range(4):
        world.spawn(f'rumba{number}')
    rng = np.random.default_rng(11)
    seen = hashlib.sha256()
    for tick in range(0, 30000, 10):
        for name, robot in world.robots.items():
            robot.command(rng.uniform(-0.1, 0.5), rng.uniform(-1.9, 1.9), world.tick)
            robot.brushes_up = bool(rng.random() < 0.1)
            readings = (world.infrared(name), world.cliffs(name), robot.bumper, robot.contact_angle, robot.odometry,
                        robot.odometry_twist, robot.ticks, robot.battery.voltage, robot.is_docked, world.floor.coverage)
            seen.update(repr(readings).encode())
            if tick % 100 == 0:
                seen.update(world.scan(name).tobytes())
        world.step(10)
    assert world.time == 600.0 and world.floor.coverage > 0.5, world.floor.coverage
    assert sum(robot.bumps for robot in world.robots.values()) > 20
    print(world.digest(), seen.hexdigest())
'''


def ten_minutes(hash_seed, *seeds):
    """Digest of the world and of all readings for each seed, from a process of its own."""
    path = os.pathsep.join([str(HERE), str(HERE.parents[1] / 'src'), *sys.path])
    printed = subprocess.run([sys.executable, '-c', RUN, *map(str, seeds)], check=True, stdout=subprocess.PIPE,
                             env={**os.environ, 'PYTHONPATH': path, 'PYTHONHASHSEED': hash_seed}).stdout
    return [line.split() for line in printed.splitlines()]


def test_ten_minutes_are_the_same_in_another_process_and_differ_with_another_seed():
    (first, other), [again] = ten_minutes('1', 7, 8), ten_minutes('2', 7)
    assert len(first) == 2 and first == again
    assert first[0] != other[0] and first[1] != other[1]
