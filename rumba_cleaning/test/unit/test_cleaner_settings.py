"""The settings of the cleaner, and its map and robot: its own, or those of the simulator."""

import pathlib

import pytest
import rospy
import yaml
from rooms import quiet
from std_msgs.msg import Header

from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.ros.cleaner.goals import workplace
from rumba_cleaning.ros.cleaner.goals.settings import Settings
from rumba_msg.msg import SimulatorState
from rumba_sim.model.common.config import from_mapping
from rumba_sim.model.common.errors import ConfigError, MapError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps import map_file
from rumba_sim.model.settings.own_robot import FramesConfig, OwnRobot
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.ros.participants.maps import map_path


def test_settings_hold_those_of_cleaning():
    settings = Settings(speed=0.2, strategy='bounce', robot='rumba2')
    assert settings.cleaning == CleaningConfig(speed=0.2, strategy='bounce')


@pytest.mark.parametrize('robot', ['', '/rumba', 'a/b', '2', 'a b'])
def test_an_invalid_name_of_a_robot_is_refused(robot):
    with pytest.raises(ConfigError, match=r'^robot is .*: must be letters, digits and _, beginning with a letter$'):
        Settings(robot=robot)


@pytest.mark.parametrize('team', ['rumba2 rumba3', 'rumba rumba', 'rumba /rumba2', 'rumba 2'])
def test_a_team_without_the_robot_or_with_wrong_names_is_refused(team):
    with pytest.raises(ConfigError, match=r"^team is .*: must be names of robots, each of them once, and 'rumba' among "
                                          'them$'):
        Settings(team=team)


def test_robots_that_make_their_own_maps_are_no_team():
    Settings(team='rumba', mapping=True)
    with pytest.raises(ConfigError, match='^team is .rumba rumba2.: must be empty with mapping: '):
        Settings(team='rumba rumba2', mapping=True)


def test_a_cleaner_without_a_map_works_alone_and_by_its_bumper():
    Settings(team='rumba', mapless=True)
    with pytest.raises(ConfigError, match='^team is .rumba rumba2.: must be empty with mapless: '):
        Settings(team='rumba rumba2', mapless=True)
    for other in ('mapping', 'laser'):
        with pytest.raises(ConfigError, match=f'^{other} is true: must be false with mapless$'):
            Settings(mapless=True, **{other: True})


def test_a_robot_that_is_not_ours_needs_a_map_or_makes_one_and_works_alone():
    Settings(own_robot='robot.yaml', map='room.yaml')
    Settings(own_robot='robot.yaml', mapping=True)
    for others in ({}, {'mapless': True}, {'map': 'room.yaml', 'team': 'rumba rumba2'}):
        with pytest.raises(ConfigError, match='^own_robot is given: must come with map, or with mapping, and with '):
            Settings(own_robot='robot.yaml', **others)


def test_where_a_robot_of_others_ends_is_a_pose():
    assert Settings(own_robot='robot.yaml', mapping=True).home_pose is None
    assert Settings(own_robot='robot.yaml', mapping=True, home='1 -2.5 3').home_pose == (1.0, -2.5, 3.0)
    for home in ('1 2', '1 2 3 4', 'a b c', '1 2 nan'):
        with pytest.raises(ConfigError, match=f"^home is '{home}': must be x y theta "):
            Settings(own_robot='robot.yaml', mapping=True, home=home)
    with pytest.raises(ConfigError, match='^home is given: must come with own_robot'):
        Settings(home='1 2 3')


def test_a_robot_that_docks_by_itself_is_not_ours_and_its_dock_is_where_it_begins_if_it_makes_a_map():
    Settings(own_robot='robot.yaml', map='room.yaml', docks=True, home='1 2 3')
    Settings(own_robot='robot.yaml', mapping=True, docks=True)
    with pytest.raises(ConfigError, match='^docks is true: must come with own_robot'):
        Settings(docks=True)
    with pytest.raises(ConfigError, match='^home is given: must be empty with docks and mapping'):
        Settings(own_robot='robot.yaml', mapping=True, docks=True, home='1 2 3')


def test_the_dock_of_a_robot_that_is_not_ours_is_where_its_owner_says_or_the_map(monkeypatch, tmp_path):
    Simulator(monkeypatch)
    own, home = OwnRobot(quiet(), FramesConfig(), None), Pose(1.0, 2.0, 3.0)
    studio = map_file.load(map_path('studio'), quiet().drive.radius).dock

    def docks(name='studio', **arguments):
        return workplace.Workplace(name, own=own, **arguments).look()[0].docks
    assert docks() == docks(home=home) == ()
    assert docks(docks=True) == (studio,)
    assert docks(docks=True, home=home) == (home,)
    bare = yaml.safe_load(pathlib.Path(map_path('field')).read_text(encoding='utf-8'))
    bare.pop('dock')
    bare['image'] = str(pathlib.Path(map_path('field')).with_name(bare['image']))
    (tmp_path / 'bare.yaml').write_text(yaml.safe_dump(bare), encoding='utf-8')
    with pytest.raises(MapError, match='no dock on the map: its YAML file may name one, .* or the parameter home$'):
        docks(str(tmp_path / 'bare.yaml'), docks=True)


def test_an_unknown_answer_of_go_to_position_is_refused():
    with pytest.raises(ConfigError, match="^it: go_to_position/answer is 'speed': must be velocity or heading$"):
        from_mapping(Settings, {'go_to_position': {'answer': 'speed'}}, 'it')


class Simulator:
    """The state of a simulator, without ROS."""

    def __init__(self, monkeypatch, map=None):
        self.state = map and SimulatorState(node='/sim2', map=map)
        self.robots = {'/sim2': quiet(), '/sim3': quiet(drive={'max_speed': 0.3})}
        monkeypatch.setattr(workplace, 'SimulatorClient', self._listen)
        monkeypatch.setattr(workplace, 'robot_config', self._robot)

    def _listen(self, on_state):
        self._on_state = on_state
        return self

    def _robot(self, node):
        found = self.robots[node]
        if isinstance(found, Exception):
            raise found
        return found

    def tells(self, map, node='/sim2', run='', resets=0, seconds=0):
        """Publish a state."""
        header = Header(stamp=rospy.Time(seconds))
        self.state = SimulatorState(header=header, node=node, map=map, run=run, resets=resets)
        self._on_state(self.state)

    def wait(self):
        """The state, or the error that there is none."""
        if self.state is None:
            raise MapError('no simulator publishes /simulator/state')
        return self.state


def test_map_and_robot_are_those_of_the_simulator_whatever_its_name(monkeypatch):
    simulator = Simulator(monkeypatch, map_path('studio'))
    plan, robot = workplace.Workplace('').look()
    assert (plan.name, robot) == (map_path('studio'), simulator.robots['/sim2'])


def test_a_simulator_that_is_started_again_may_have_another_map_and_another_robot(monkeypatch):
    simulator = Simulator(monkeypatch, map_path('studio'))
    place = workplace.Workplace('')
    plan, robot = place.look()
    assert place.look()[0] is plan
    simulator.robots['/sim2'] = quiet(drive={'max_speed': 0.1})
    simulator.tells(map_path('studio'))
    assert place.look() == (plan, simulator.robots['/sim2'])
    simulator.tells(map_path('field'), '/sim3', run='second')
    assert (place.look()[0].name, place.look()[1]) == (map_path('field'), simulator.robots['/sim3'])


def test_settings_of_the_simulator_that_became_invalid_are_an_error_until_they_are_valid_again(monkeypatch):
    simulator = Simulator(monkeypatch, map_path('studio'))
    place = workplace.Workplace('')
    valid, simulator.robots['/sim2'] = simulator.robots['/sim2'], ConfigError('drive/radius is -1')
    simulator.tells(map_path('studio'))
    with pytest.raises(ConfigError, match='^drive/radius is -1$'):
        place.look()
    simulator.robots['/sim2'] = valid
    simulator.tells(map_path('studio'))
    assert place.look()[1] == valid


def test_a_map_is_read_again_for_a_simulator_that_was_started_again_since_the_file_may_have_changed(monkeypatch):
    simulator = Simulator(monkeypatch, map_path('studio'))
    place = workplace.Workplace('')
    plan = place.look()[0]
    simulator.tells(map_path('studio'), run='second')
    assert place.look()[0] is not plan


def test_each_new_world_is_told_once_with_the_stamp_that_it_began_at(monkeypatch):
    simulator, told = Simulator(monkeypatch, map_path('studio')), []
    place = workplace.Workplace('', lambda: told.append(place.world))
    for run, resets, seconds in (('a', 0, 5), ('a', 0, 6), ('a', 1, 7), ('a', 1, 8), ('b', 1, 2)):
        simulator.tells(map_path('studio'), run=run, resets=resets, seconds=seconds)
    assert told == [('a', 0, rospy.Time(5)), ('a', 1, rospy.Time(7)), ('b', 1, rospy.Time(2))]


def test_settings_are_kept_while_the_master_is_away(monkeypatch):
    simulator = Simulator(monkeypatch, map_path('studio'))
    place = workplace.Workplace('')
    simulator.tells(map_path('studio'))
    known, simulator.robots['/sim2'] = simulator.robots['/sim2'], ConnectionRefusedError(111, 'Connection refused')
    simulator.tells(map_path('studio'))
    assert place.look()[1] == known


def test_of_a_robot_that_creeps_one_line_is_told(monkeypatch):
    simulator, lines = Simulator(monkeypatch, map_path('studio')), []
    monkeypatch.setattr(workplace.rospy, 'logwarn', lines.append)
    workplace.Workplace('')
    simulator.tells(map_path('studio'))
    assert lines == []
    simulator.robots['/sim2'] = quiet(drive={'wheel_base': 0.32})
    simulator.tells(map_path('studio'))
    simulator.tells(map_path('studio'))
    assert len(lines) == 1 and lines[0].startswith('drive/wheel_base is 0.32 m')


def test_a_map_that_is_named_goes_before_that_of_the_simulator_and_needs_none(monkeypatch):
    simulator = Simulator(monkeypatch)
    place = workplace.Workplace('studio')
    assert place.look()[0].name == map_path('studio')
    assert place.look()[1] == RobotConfig()
    simulator.tells(map_path('field'))
    assert (place.look()[0].name, place.look()[1]) == (map_path('studio'), simulator.robots['/sim2'])


def test_without_a_simulator_a_map_must_be_named(monkeypatch):
    Simulator(monkeypatch)
    with pytest.raises(MapError, match='^no simulator publishes /simulator/state'):
        workplace.Workplace('')
