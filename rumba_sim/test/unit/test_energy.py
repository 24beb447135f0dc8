"""How a robot in a world discharges its battery, and how the dock charges it."""

import math

import numpy as np
import pytest
from pytest import approx
from rooms import alone, crooked, drive, drove, quiet

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import BatteryConfig
from rumba_sim.model.simulation.world import World

DOCK = Pose(3.8, 1.0, 0.0)
LOADS = {'idle_current': 0.2, 'brush_current': 0.7, 'wheel_current_slow': 0.25, 'wheel_current': 1.15,
         'wheel_speed': 0.3}


@pytest.mark.parametrize('v, w, brushes_up, load', [
    (0.0, 0.0, True, 0.2),
    (0.0, 0.0, False, 0.2 + 0.7),
    (0.3, 0.0, True, 0.2 + 1.15),
    (-0.3, 0.0, True, 0.2 + 1.15),
    (0.15, 0.0, False, 0.2 + 0.7 + 0.25 + 0.45),
    (0.0, 1.0, True, 0.2 + 0.25 + 0.9 * 0.1175 / 0.3),
    (0.2, 1.0, True, 0.2 + 0.25 + 0.9 * 0.2 / 0.3),
])
def test_the_battery_loses_the_sum_of_the_loads(v, w, brushes_up, load):
    world, robot = alone(battery=LOADS, drive={'acceleration': 1000.0})
    robot.brushes_up = brushes_up
    drove(world, v, w, 1)
    assert robot.battery.current == approx(-load)
    before = robot.battery.charge
    drove(world, v, w, 500)
    assert before - robot.battery.charge == approx(load * 10.0 / 3600.0)


def test_the_change_of_charge_is_the_integral_of_the_current():
    config = quiet(battery={'drain': 20.0, **LOADS})
    world = World(crooked(dock=DOCK), config)
    robot = world.spawn('rumba', state_of_charge=0.5)
    rng = np.random.default_rng(2)
    flowed, on_dock = 0.0, 0
    for _ in range(60):
        v, w = rng.uniform(-0.2, 0.2), rng.uniform(-1.0, 1.0)
        robot.brushes_up = bool(rng.random() < 0.5)
        if rng.random() < 0.3:
            world.teleport('rumba', DOCK)
            v = w = 0.0
        for _ in drive(world, v, w, 50):
            twist = robot.twist
            left, right = abs(twist.v - 0.1175 * twist.w), abs(twist.v + 0.1175 * twist.w)
            wheels = 0.25 + 0.9 * (left + right) / 2.0 / 0.3 if left or right else 0.0
            loads = 0.2 + wheels + (0.0 if robot.brushes_up else 0.7)
            current = 1.25 if robot.is_docked else -loads
            assert robot.battery.current == approx(current)
            flowed += current * 0.02 * 20.0 / 3600.0
            on_dock += robot.is_docked
    assert 200 < on_dock < 2800
    assert robot.battery.charge == approx(1.35 + flowed)


def test_drain_multiplies_the_loss_of_charge_but_not_the_current():
    lost = []
    for drain in (1.0, 25.0):
        world, robot = alone(battery={'drain': drain})
        drove(world, 0.3, 0.0, 100)
        assert robot.battery.current == approx(-0.19 - 1.0 - 0.5)
        lost.append(2.7 - robot.battery.charge)
    assert lost[1] == approx(25.0 * lost[0])


def test_a_robot_with_an_empty_battery_comes_to_rest_sweeps_nothing_and_stays():
    world, robot = alone(battery={'drain': 1e4})
    while robot.battery.percentage:
        drove(world, 0.3, 0.5, 1)
    world.step()  # sweeps what was not swept yet of the last stride
    swept, brush_time = world.floor.cleaned_area, robot.brush_time
    drove(world, 0.3, 0.5, 100)
    rest = robot.pose
    drove(world, 0.5, -1.0, 100)
    assert robot.pose == rest and robot.twist == (0.0, 0.0)
    assert (world.floor.cleaned_area, robot.brush_time) == (swept, brush_time)
    assert (robot.battery.charge, robot.battery.current) == (0.0, 0.0)


def test_an_empty_robot_at_the_dock_charges_and_drives_again():
    world = World(crooked(dock=DOCK), quiet(), seed=1)
    robot = world.spawn('rumba', DOCK, state_of_charge=0.0)
    world.step(50)
    assert robot.is_docked and robot.battery.current == 1.25
    assert robot.battery.charge == approx(1.25 / 3600.0)
    drove(world, -0.2, 0.0, 50)
    assert robot.pose.x < 3.7


@pytest.mark.parametrize('pose, docked', [
    (DOCK, True),
    (Pose(3.8 - 0.074, 1.0, 0.0), True),
    (Pose(3.8 - 0.076, 1.0, 0.0), False),
    (Pose(3.8, 1.0, 0.104), True),
    (Pose(3.8, 1.0, -0.106), False),
    (Pose(3.8, 1.0, math.pi), False),
    (Pose(2.2, 1.0, 0.0), False)])
def test_only_at_the_contacts_the_battery_charges(pose, docked):
    world = World(crooked(dock=DOCK), quiet())
    robot = world.spawn('rumba', pose, state_of_charge=0.5)
    world.step()
    assert robot.is_docked == docked
    assert (robot.battery.current > 0.0) == docked


def test_a_full_battery_at_the_dock_takes_nothing_and_loses_nothing():
    world = World(crooked(dock=DOCK), quiet())
    robot = world.spawn('rumba')
    world.step(500)
    assert (robot.battery.charge, robot.battery.current) == (2.7, 0.0)


def test_the_kernel_and_the_class_battery_agree():
    world, robot = alone(battery={'drain': 30.0})
    drove(world, 0.2, 0.3, 200)
    battery = robot.battery
    assert battery.config == BatteryConfig(drain=30.0)
    battery.step(0.02, load=-battery.current)
    drove(world, 0.2, 0.3, 1)
    assert robot.battery.charge == approx(battery.charge, rel=1e-12)
    assert robot.battery.voltage == approx(battery.voltage)
