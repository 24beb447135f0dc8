"""The tables of interfaces say what the robots do whose names they have; sources stand in `interfaces`."""

import collections
import math

import numpy as np
import pytest
from pytest import approx
from rooms import alone, quiet, room

from rumba_sim.model.common.config import ConfigError, from_mapping, updated
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.devices.laser_scan import intensities
from rumba_sim.model.devices.light_bumper import REACH, STRONGEST, light_bumper
from rumba_sim.model.settings.interfaces import INTERFACES, PRESETS, is_due
from rumba_sim.model.settings.laser_config import LaserConfig
from rumba_sim.model.simulation.obstacle import Obstacle
from rumba_sim.model.simulation.world import World
from rumba_sim.ros.robot.interface_topics import message_class
from rumba_sim.ros.simulator.settings import Settings

# Of rosmsg md5 on ROS Noetic; those of create_msgs by genmsg of the definitions of create_robot.
MD5 = {
    'geometry_msgs/Twist': '9f195f881246fdfa2798d1d3eebca84a',
    'nav_msgs/Odometry': 'cd5e73d190d741a2f92e81eda573aca7',
    'sensor_msgs/BatteryState': '4ddae7f048e32fda22cac764685e3974',
    'sensor_msgs/Imu': '6a62c6daae103f4ff57a132d6f95cec2',
    'sensor_msgs/JointState': '3066dcd76a6cfaef579bd0f34173e9fd',
    'sensor_msgs/LaserScan': '90c7ef2dc6895d81024acba2ac42f369',
    'std_msgs/Empty': 'd41d8cd98f00b204e9800998ecf8427e',
    'std_msgs/Float32': '73fcbf46b49191e672908e50842a83d4',
    'std_msgs/Int16': '8524586e34fbd7cb1c08c5f5f1ca0e57',
    'std_msgs/UInt16': '1df79edf208b629fe6b81923a544552d',
    'create_msgs/Bumper': '18fe5b1d31e6a8db180b924157ac665e',
    'create_msgs/ChargingState': 'e4da1ef814a2def80691224a5e5883ea',
    'create_msgs/Cliff': '52f9ca1c0878e942bfdd1e74ef36146c',
    'create_msgs/Mode': 'b4faf4b68b6555d4656417971bee31a0',
    'create_msgs/MotorSetpoint': '6b1e8af79e9957aa39f0d7274f652afb',
}
TYPES = sorted({kind for each in INTERFACES.values()
                for kind in [*(topic.type for topic in each.topics), *each.inputs.values()]})


@pytest.mark.parametrize('kind', TYPES)
def test_each_message_has_the_wire_format_of_the_real_robot(kind):
    assert message_class(kind, 'test')._md5sum == MD5[kind]
    assert message_class(kind, 'test')._type == kind


def test_a_message_that_is_not_installed_is_named_with_the_way_to_it():
    with pytest.raises(ConfigError, match='^interface is create, but there is no package lacking_msgs: ./rumba builds'):
        message_class('lacking_msgs/Lacking', 'create')


@pytest.mark.parametrize('rate', [5, 10, 30, 50])
def test_what_is_due_comes_at_the_first_tick_and_evenly(rate):
    ticks = [tick for tick in range(1, 501) if is_due(rate, tick, 50)]
    assert ticks[0] == 1 and len(ticks) == 10 * rate
    assert set(np.diff(ticks)) <= {50 // rate, math.ceil(50 / rate)}


def test_what_is_due_more_often_than_there_are_ticks_comes_at_each():
    assert all(is_due(200, tick, 50) for tick in range(1, 51))
    assert collections.Counter(is_due(200, tick, 1000) for tick in range(1, 1001)) == {True: 200, False: 800}


# --- the choice of an interface -----------------------------------------------------------------------------------

@pytest.mark.parametrize('interface, model', [
    ('rumba', 'ideal'), ('turtlebot3', 'lds01'), ('create', 'ideal'), ('plain', 'camera')])
def test_an_interface_chooses_the_laser(interface, model):
    wanted = from_mapping(LaserConfig, {'model': model}, 'here')
    assert from_mapping(Settings, {'interface': interface}, 'here').laser == wanted


def test_a_laser_that_is_given_beside_an_interface_counts_in_any_order():
    given = {'model': 'urg04lx', 'noise': 0.5}
    for settings in ({'interface': 'plain', 'laser': given}, {'laser': given, 'interface': 'plain'}):
        found = from_mapping(Settings, settings, 'here')
        laser = found.laser
        assert (found.interface, laser.model, laser.beams, laser.noise) == ('plain', 'urg04lx', 682, 0.5)


def test_without_an_interface_a_laser_stays_as_a_file_has_it():
    file = from_mapping(Settings, {'laser': {'model': 'tim561'}}, 'file')
    assert updated(file, {'speed': 2.0}, 'parameters').laser.model == 'tim561'
    assert updated(file, {'interface': 'turtlebot3'}, 'parameters').laser.model == 'lds01'


def test_an_unknown_interface_is_refused():
    with pytest.raises(ConfigError, match="^here: interface is 'turtlebot2': must be rumba or turtlebot3 or create or"):
        from_mapping(Settings, {'interface': 'turtlebot2'}, 'here')
    assert list(PRESETS) == ['rumba', *INTERFACES]


@pytest.mark.parametrize('interface, ahead', [('turtlebot3', 0), ('plain', None)])
def test_the_index_that_looks_ahead_is_where_nodes_expect_it(interface, ahead):
    laser = from_mapping(Settings, {'interface': interface}, 'here').laser
    angles = laser.first_angle + np.arange(laser.beams) * laser.increment
    ahead = (laser.beams - 1) / 2 if ahead is None else ahead
    assert np.interp(ahead, np.arange(laser.beams), angles) == approx(0.0, abs=1e-9)
    if interface == 'plain':
        assert math.degrees(angles[-1] - angles[0]) == approx(57.0, abs=0.1)
    else:
        assert (laser.beams, math.degrees(angles[90]), laser.range_min, laser.range_max, laser.rate) == (
            360, approx(90.0), 0.12, 3.5, 5.0)


# --- what sensors tell --------------------------------------------------------------------------------------------

def test_intensities_fall_with_the_range_and_are_zero_without_an_echo():
    laser = LaserConfig(range_max=3.5)
    found = intensities(np.array([0.5, 1.0, 3.0, 0.0, math.inf, -math.inf, math.nan, 3.5]), laser)
    assert found.tolist() == [2667.0, 2000.0, 1000.0, 0.0, 0.0, 0.0, 0.0, 0.0]


def test_the_light_bumper_sees_a_wall_on_its_side_before_it_touches():
    """There is a wall 0.05 m to the right of the body, and nothing else."""
    world = World(room(6.0, 6.0), quiet(), seed=1)
    world.spawn('rumba', Pose(3.0, 0.05 + quiet().drive.radius, 0.0))
    lights = light_bumper(world, 'rumba')
    assert [light.is_near for light in lights] == [False] * 5 + [True]
    # The beam at 65 degrees meets the wall at (radius + 0.05) / sin 65 degrees from the centre.
    gap = (quiet().drive.radius + 0.05) / math.sin(math.radians(65.0)) - quiet().drive.radius
    assert lights[5].signal == approx(STRONGEST * (1.0 - gap / REACH) ** 2, abs=5)
    assert [light.signal for light in lights[:4]] == [0] * 4


def test_the_light_bumper_sees_obstacles_and_other_robots():
    world, robot = alone(Pose(3.0, 3.0, 0.0), room(6.0, 6.0))
    ahead = robot.config.drive.radius + 0.05
    assert not any(light.signal for light in light_bumper(world, 'rumba'))
    world.add_obstacle(Obstacle('box', Pose(3.0 + ahead + 0.2, 3.0, 0.0), 0.5, length=0.4, width=0.4))
    lights = light_bumper(world, 'rumba')
    assert [light.is_near for light in lights] == [False, False, True, True, False, False]
    world.remove_obstacle('box')
    between, left = 2.0 * robot.config.drive.radius + 0.05, math.radians(65.0)
    world.spawn('other', Pose(3.0 + between * math.cos(left), 3.0 + between * math.sin(left), 0.0))
    lights = light_bumper(world, 'rumba')
    assert lights[0] == (approx(STRONGEST * (1.0 - 0.05 / REACH) ** 2, abs=30), True)
    assert not lights[5].is_near
