"""Obstacle files: what they can say, and one clear line about each mistake."""

import os
import pathlib

import pytest
from rooms import quiet

from rumba_sim.model.common.errors import ConfigError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps import map_file
from rumba_sim.model.simulation import obstacle_file
from rumba_sim.model.simulation.obstacle import Obstacle, Stop, walk
from rumba_sim.model.simulation.world import World

PACKAGE = pathlib.Path(__file__).parents[2]
DISC = {'pose': [1, 2], 'radius': 0.05, 'height': 0.4}
BOX = {'pose': [1.0, 2.0, 0.5], 'size': [0.4, 0.3], 'height': 0.05}
CAT = {'waypoints': [[1, 1], [3, 1, 0.5]], 'speed': 0.5, 'radius': 0.1, 'height': 0.3}
DOOR = {'closed': [1, 1, 0], 'open': [1, 2, 0], 'closed_for': 10, 'open_for': 5.5, 'moves_for': 2, 'size': [0.8, 0.04],
        'height': 2}


def load(folder, text):
    """The obstacles of a file with this text."""
    (folder / 'things.yaml').write_text(text)
    return obstacle_file.load(str(folder / 'things.yaml'))


def test_a_file_names_discs_boxes_movers_and_doors(tmp_path):
    assert load(tmp_path, f'leg: {DISC}\ncrate: {BOX}\ncat: {CAT}\ndoor: {DOOR}\n') == [
        Obstacle('leg', Pose(1.0, 2.0, 0.0), 0.4, radius=0.05),
        Obstacle('crate', Pose(1.0, 2.0, 0.5), 0.05, length=0.4, width=0.3),
        Obstacle('cat', Pose(1.0, 1.0, 0.0), 0.3, radius=0.1, stops=(
            Stop(Pose(1.0, 1.0, 0.0), 4.0), Stop(Pose(3.0, 1.0, 0.5), 4.0))),
        Obstacle('door', Pose(1.0, 1.0, 0.0), 2.0, length=0.8, width=0.04, stops=(
            Stop(Pose(1.0, 1.0, 0.0), 2.0, 10.0, 10.0), Stop(Pose(1.0, 2.0, 0.0), 2.0, 5.5, 5.5)))]


def test_a_mover_may_loop_and_pause():
    corners = [[0, 0], [2, 0], [2, 1]]
    found = obstacle_file.obstacle('cat', {**CAT, 'waypoints': corners, 'loop': True, 'pause': [0, 3]})
    assert found.stops == walk([Pose(x, y, 0.0) for x, y in corners], 0.5, True, 0.0, 3.0) and len(found.stops) == 3
    assert len(obstacle_file.obstacle('cat', {**CAT, 'waypoints': corners, 'loop': False}).stops) == 4


def test_an_empty_file_has_no_obstacles(tmp_path):
    assert load(tmp_path, '# nothing\n') == []


@pytest.mark.parametrize('name, values, message', [
    ('leg', {**DISC, 'radus': 1}, "leg/radus is unknown: did you mean 'radius'?"),
    ('leg', {**DISC, 5: 1}, 'leg/5 is unknown: known are height, radius, size, pose, waypoints, speed, loop, pause, '
                            'closed, open, closed_for, open_for, moves_for'),
    ('leg', 7, 'leg is 7: must be a mapping of height, radius, size, pose, waypoints, speed, loop, pause, closed, '
               'open, closed_for, open_for, moves_for'),
    ('a leg', DISC, "'a leg' is not a valid name: must be 1 to 64 letters, digits and _, beginning with a letter"),
    (3, DISC, '3 is not a valid name: must be 1 to 64 letters, digits and _, beginning with a letter'),
    ('leg', {'pose': [1, 2], 'radius': 0.1}, 'leg/height is missing: must be 0.001 to 10 [m]'),
    ('leg', {**DISC, 'height': 0}, 'leg/height is 0: must be 0.001 to 10 [m]'),
    ('leg', {**DISC, 'radius': 'wide'}, "leg/radius is 'wide': must be 0.005 to 20 [m]"),
    ('leg', {**DISC, 'radius': float('nan')}, 'leg/radius is nan: must be 0.005 to 20 [m]'),
    ('leg', {**DISC, 'radius': True}, 'leg/radius is True: must be 0.005 to 20 [m]'),
    ('leg', {**DISC, 'radius': 10 ** 400}, 'leg/radius is a number of 400 digits: must be 0.005 to 20 [m]'),
    ('leg', {**DISC, 'size': [1, 1]}, 'leg has radius and size of radius, size: must have one of them'),
    ('leg', {'pose': [1, 2], 'height': 1}, 'leg has none of radius, size: must have one of them'),
    ('leg', {'radius': 0.1, 'height': 1}, 'leg has none of pose, waypoints, closed: must have one of them'),
    ('leg', {**CAT, 'pose': [1, 2]}, 'leg has pose and waypoints of pose, waypoints, closed: must have one of them'),
    ('leg', {**DISC, 'speed': 1}, 'leg/speed belongs to waypoints: an obstacle with pose has no speed'),
    ('leg', {**DOOR, 'pause': [1, 2]}, 'leg/pause belongs to waypoints: an obstacle with closed has no pause'),
    ('leg', {**DISC, 'pose': [1]}, 'leg/pose is [1]: must be [x, y, yaw] in m, m, rad, or [x, y]'),
    ('leg', {**DISC, 'pose': [1, 2, 3, 4]}, 'leg/pose is [1, 2, 3, 4]: must be [x, y, yaw] in m, m, rad, or [x, y]'),
    ('leg', {**DISC, 'pose': [1, '2']}, "leg/pose is [1, '2']: must be [x, y, yaw] in m, m, rad, or [x, y]"),
    ('leg', {**BOX, 'size': [0.4]}, 'leg/size is [0.4]: must be [length, width], each 0.005 to 20 [m]'),
    ('leg', {**BOX, 'size': [0.4, 0]}, 'leg/size is [0.4, 0]: must be [length, width], each 0.005 to 20 [m]'),
    ('cat', {**CAT, 'waypoints': [[1, 1]]},
     'cat/waypoints is [[1, 1]]: must be 2 to 1000 times [x, y, yaw] in m, m, rad, or [x, y]'),
    ('cat', {**CAT, 'waypoints': [[1, 1], [2]]},
     'cat/waypoints is [[1, 1], [2]]: must be 2 to 1000 times [x, y, yaw] in m, m, rad, or [x, y]'),
    ('cat', {**CAT, 'speed': 9}, 'cat/speed is 9: must be 0.01 to 5 [m/s]'),
    ('cat', {**CAT, 'loop': 1}, 'cat/loop is 1: must be true or false'),
    ('cat', {**CAT, 'pause': [0, -1]}, 'cat/pause is [0, -1]: must be [shortest, longest], each 0 to 86400 [s]'),
    ('cat', {**CAT, 'pause': [2, 1]}, 'cat/pause is [2, 1]: must be [shortest, longest], in this order'),
    ('door', {**DOOR, 'moves_for': 0}, 'door/moves_for is 0: must be 0.1 to 86400 [s]'),
    ('door', {key: value for key, value in DOOR.items() if key != 'open'},
     'door/open is missing: must be [x, y, yaw] in m, m, rad, or [x, y]')])
def test_a_mistake_is_one_line_that_names_the_file_the_key_and_what_would_be_right(tmp_path, monkeypatch, name, values,
                                                                                   message):
    monkeypatch.setattr(obstacle_file, 'read_mapping', lambda path, error: {'first': DISC, name: values})
    with pytest.raises(ConfigError) as error:
        obstacle_file.load('things.yaml')
    assert str(error.value) == f'things.yaml: {message}'


def test_a_file_that_is_none_is_one_line(tmp_path):
    with pytest.raises(ConfigError, match='^none.yaml: No such file or directory$'):
        obstacle_file.load('none.yaml')
    with pytest.raises(ConfigError, match='things.yaml: must hold keys and values$'):
        load(tmp_path, '- leg\n')
    with pytest.raises(ConfigError, match='things.yaml, line 2: is not valid YAML: '):
        load(tmp_path, 'leg: {\n')
    os.mkfifo(str(tmp_path / 'pipe'))
    with pytest.raises(ConfigError, match='is a named pipe: must be a regular file$'):
        obstacle_file.load(str(tmp_path / 'pipe'))


def test_the_examples_of_the_package_fit_into_their_maps():
    found = sorted((PACKAGE / 'config').glob('obstacles_*.yaml'))
    assert [path.stem for path in found] == ['obstacles_apartment', 'obstacles_studio']
    for path in found:
        plan = map_file.load(PACKAGE / 'maps' / f'{path.stem.split("_")[1]}.yaml')
        obstacles = obstacle_file.load(str(path))
        world = World(plan, quiet(), obstacles=obstacles)
        world.spawn('rumba')
        assert {bool(each.stops) for each in obstacles} == {each.is_seen for each in obstacles} == {True, False}
        share = world.floor.reachable_area / World(plan, quiet()).floor.reachable_area
        assert 0.9 < share < 1.0, share
