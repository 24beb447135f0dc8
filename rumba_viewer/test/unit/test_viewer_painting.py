"""What is painted, checked pixel by pixel, without ROS and without a window."""

import math
import pathlib
import re

import numpy as np
import pytest
from PyQt5.QtGui import QImage, QPainter
from windows import BOTTOM, HEIGHT, LEFT, SCALE, WIDTH, count, near, path, pixels, plan, robot, snapshot

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_colours import ROBOTS, contrast
from rumba_viewer.painting.paint_belief import RING
from rumba_viewer.painting.paint_scene import ScenePainter, picture
from rumba_viewer.scene.snapshot import Dock, MapFeatures, Obstacle, Point, Snapshot
from rumba_viewer.scene.theme import DARK, LIGHT, robot_colour
from rumba_viewer.scene.view_transform import ViewTransform

STYLE = pathlib.Path(__file__).resolve().parents[2] / 'page' / 'style.css'
THEMES = pytest.mark.parametrize('theme', [LIGHT, DARK], ids=['light', 'dark'])
STRIPED = {theme.floor.out_of_reach: theme.floor.stripe for theme in (LIGHT, DARK)}
VIEWS = pytest.mark.parametrize('view', [
    ViewTransform(WIDTH, HEIGHT, 1.0, 3.5, SCALE), ViewTransform(1200, 800, 1.0, 3.5, 270.0),
    ViewTransform(500, 250, 0.8, 3.3, 80.0)], ids=['all', 'large', 'small'])
WHOLE = ViewTransform(WIDTH, HEIGHT, 1.0, 3.5, SCALE)
FLOOR = [  # points [m] and what is there
    (-0.9, 4.0, 'wall'), (2.45, 4.55, 'wall'), (2.75, 2.2, 'unknown'), (0.5, 2.4, 'swept'), (0.5, 3.0, 'to_sweep'),
    (1.0, 4.0, 'out_of_reach'), (2.45, 3.5, 'out_of_reach')]


@THEMES
def test_text_and_robots_can_be_seen(theme):
    assert contrast(ROBOTS[0], theme.floor.swept) >= 2.0 and contrast(theme.body, theme.floor.swept) >= 2.0
    assert contrast(theme.text, theme.card) >= 7.0
    for colour in (theme.faint_text, theme.good, theme.warning, theme.bad, theme.main):
        assert contrast(colour, theme.card) >= 4.5, colour


@THEMES
def test_the_page_has_the_same_colours(theme):
    light, dark = re.findall(r':root \{(.*?)\}', STYLE.read_text(), re.DOTALL)[:2]
    of_page = dict(re.findall(r'--([\w-]+): (#\w{6});', light + (dark if theme.is_dark else '')))
    for name, colour in theme.floor._replace(lines='')._asdict().items():
        assert not colour or of_page[name.replace('_', '-')] == colour, name
    assert tuple(of_page[f'line-{number}'] for number in range(len(ROBOTS))) == theme.floor.lines
    for name in ('background', 'text', 'card', 'line', 'trough', 'main', 'good', 'warning', 'bad', 'body'):
        assert of_page[name] == getattr(theme, name), name
    assert of_page['faint'] == theme.faint_text


@THEMES
@pytest.mark.parametrize('width, is_shown', [(700, True), (300, False)])
def test_a_key_names_the_states_of_the_floor_where_there_is_room(theme, width, is_shown):
    view = ViewTransform(width, HEIGHT, 1.0, 8.0, SCALE)  # the floor is below the picture
    image = picture(snapshot(), view, theme)
    for name in ('swept', 'to_sweep', 'out_of_reach', 'wall') if is_shown else ('to_sweep',):
        assert (count(image, getattr(theme.floor, name), top=HEIGHT - 40, tolerance=3) >= 60) is is_shown, name


@THEMES
@pytest.mark.parametrize('width', [900, 600])  # one row, two rows
def test_the_key_names_cliff_and_dock_if_the_map_has_them(theme, width):
    view = ViewTransform(width, HEIGHT, 1.0, 8.0, SCALE)
    cells = np.ones(plan().cells.shape, bool)
    features = MapFeatures((Dock(Pose(0.0, 0.0, 0.0), np.zeros((0, 2)), np.zeros((0, 2))),), cells, cells, True)
    for known in (features, MapFeatures()):
        image = picture(snapshot(features=known), view, theme)
        assert count(image, theme.floor.to_sweep, top=HEIGHT - 60, tolerance=3) >= 60
        for name in ('cliff', 'dock'):
            shown = count(image, getattr(theme.floor, name), top=HEIGHT - 60, tolerance=3) >= 60
            assert shown is (known is features), name


@THEMES
def test_where_a_robot_is_sent_is_painted_with_the_way_to_it(theme):
    sent = robot(pose=Pose(0.0, 4.0, 0.0), going_to=Point(1.5, 4.0))
    image = picture(snapshot(sent), WHOLE, theme)
    colour = robot_colour('rumba')
    assert at(image, WHOLE, 1.5 + 0.14, 4.0, colour, 60)
    left, top = (round(pixel) for pixel in WHOLE.to_pixel(0.4, 4.02))
    assert count(image, colour, left, top, left + 80, top + 5, 60) > 40
    assert count(picture(snapshot(robot(pose=sent.pose)), WHOLE, theme), colour, left, top, left + 80, top + 5, 60) == 0


def at(image, view, x, y, colour, tolerance=12):
    """Whether the picture of a view has a colour at a point [m], or the one with which that takes turns in stripes."""
    return any(near(image, *view.to_pixel(x, y), each, tolerance) for each in (colour, STRIPED.get(colour, colour)))


@THEMES
@VIEWS
def test_walls_and_swept_floor_are_at_their_positions_and_y_points_upward(view, theme):
    image = picture(snapshot(), view, theme)
    assert (image.width(), image.height()) == (view.width, view.height)
    for x, y, what in FLOOR:
        assert at(image, view, x, y, getattr(theme.floor, what)), (x, y, what)


def test_outside_the_map_nothing_is_painted():
    view = ViewTransform(WIDTH, HEIGHT, 1.0, 3.5, 50.0)
    image = picture(snapshot(), view, LIGHT)
    assert at(image, view, LEFT - 0.2, BOTTOM + 1.0, LIGHT.background)
    assert at(image, view, LEFT + 1.0, BOTTOM + 3.2, LIGHT.background)


def test_without_coverage_all_free_floor_has_one_colour():
    image = picture(snapshot(coverage=None), WHOLE, LIGHT)
    for x, y in ((0.5, 2.4), (0.5, 3.0), (1.0, 4.0)):
        assert at(image, WHOLE, x, y, LIGHT.floor.swept)


def test_a_map_much_finer_than_the_picture_keeps_its_walls():
    view = ViewTransform(WIDTH, HEIGHT, 1.0, 3.5, 4.0)
    image = picture(snapshot(), view, LIGHT)
    assert at(image, view, -0.9, 4.0, LIGHT.floor.wall, 60)
    assert at(image, view, 1.0, 4.2, LIGHT.floor.out_of_reach, 30)


@THEMES
@VIEWS
@pytest.mark.parametrize('theta', [0.0, 2.0])
def test_a_robot_is_true_to_scale_and_its_bumper_is_in_front(theta, view, theme):
    pose = Pose(1.0, 4.0, theta)
    image = picture(snapshot(robot(pose=pose)), view, theme)
    colour, radius = robot_colour('rumba'), 0.17425

    def ahead(forward, left):
        return pose.x + forward * math.cos(theta) - left * math.sin(theta), \
            pose.y + forward * math.sin(theta) + left * math.cos(theta)
    assert at(image, view, *ahead(0.92 * radius, 0.0), colour, 40)
    assert at(image, view, *ahead(-0.8 * radius, 0.0), theme.body, 30)
    assert at(image, view, *ahead(-0.1 * radius, 0.3 * radius), theme.lit, 30)
    for side in ((1.2, 0.0), (-1.2, 0.0), (0.0, 1.2), (0.0, -1.2)):
        assert at(image, view, *ahead(*(radius * share for share in side)), theme.floor.out_of_reach), side


@THEMES
@VIEWS
def test_obstacles_are_true_to_scale_and_turned_and_low_ones_are_lighter(view, theme):
    disc = Obstacle(Pose(0.5, 4.0, 0.0), 0.3, 0.3, is_round=True, is_low=False)
    high = Obstacle(Pose(1.5, 4.0, math.pi / 4.0), 0.6, 0.1, is_round=False, is_low=False)
    low = high._replace(is_low=True)
    image = picture(snapshot(obstacles=(disc, high)), view, theme)
    for x, y in ((0.5, 4.0), (0.62, 4.0), (1.5, 4.0), (1.65, 4.15), (1.35, 3.85)):
        assert at(image, view, x, y, theme.floor.obstacle), (x, y)
    for x, y in ((0.62, 4.12), (1.65, 3.85), (1.35, 4.15)):
        assert at(image, view, x, y, theme.floor.out_of_reach), (x, y)
    image = picture(snapshot(obstacles=(low,)), view, theme)
    for colour in (theme.floor.obstacle, theme.floor.out_of_reach):
        assert not at(image, view, 1.65, 4.15, colour)


def test_the_side_of_the_bumper_that_is_pressed_is_red():
    pose, radius = Pose(1.0, 4.0, 0.0), 0.17425
    point = {side: (pose.x + 0.9 * radius * math.cos(side * 0.6), pose.y + 0.9 * radius * math.sin(side * 0.6))
             for side in (1, -1)}
    for bumper in ((True, False), (False, True), (False, False), (True, True)):
        image = picture(snapshot(robot(pose=pose, bumper=bumper)), WHOLE, LIGHT)
        for side, is_pressed in zip((1, -1), bumper):
            assert at(image, WHOLE, *point[side], LIGHT.bad, 40) is is_pressed


@pytest.mark.parametrize('are_up, pixels', [(False, range(40, 120)), (True, range(1)), (None, range(1))])
def test_brushes_that_clean_are_lit(are_up, pixels):
    image = picture(snapshot(robot(pose=Pose(1.0, 4.0, 0.5), brushes_up=are_up)), WHOLE, LIGHT)
    assert count(image, LIGHT.lit, 180, 80, 220, 120) in pixels


@THEMES
@pytest.mark.parametrize('has_fallen', [True, False])
def test_a_robot_that_has_fallen_has_a_red_ring_and_a_red_cross(has_fallen, theme):
    pose, radius = Pose(1.0, 4.0, 0.4), 0.17425
    image = picture(snapshot(robot(pose=pose, has_fallen=has_fallen)), WHOLE, theme)

    def is_red(forward, left):
        x = pose.x + forward * math.cos(pose.theta) - left * math.sin(pose.theta)
        y = pose.y + forward * math.sin(pose.theta) + left * math.cos(pose.theta)
        return at(image, WHOLE, x, y, theme.bad, 40)
    for forward, left in ((-1.0, 0.0), (0.0, 1.0), (0.4, 0.4), (-0.4, 0.4), (0.4, -0.4)):
        assert is_red(forward * radius, left * radius) is has_fallen


@THEMES
def test_a_target_is_a_ring_with_cross_hairs(theme):
    image = picture(snapshot(robot(pose=Pose(0.0, 2.5, 0.0)), target=Point(1.5, 4.0)), WHOLE, theme)
    colour = robot_colour('rumba')
    for x, y in ((0.09, 0.0), (-0.14, 0.0), (0.0, 0.09), (0.0, -0.14), (0.064, 0.064)):
        assert at(image, WHOLE, 1.5 + x, 4.0 + y, colour, 60), (x, y)
    assert not at(image, WHOLE, 1.5, 4.0, colour, 60)


def test_the_path_is_painted_as_it_was_driven_and_not_across_a_jump():
    driven = path((0.0, 2.5), (1.0, 2.5), (1.0, 4.5), (np.nan, np.nan), (2.0, 3.0), (2.0, 3.4))
    image = picture(snapshot(robot(pose=Pose(2.0, 3.7, 0.0), path=driven)), WHOLE, LIGHT)
    plain = picture(snapshot(robot(pose=Pose(2.0, 3.7, 0.0))), WHOLE, LIGHT)

    difference = (pixels(image) != pixels(plain)).any(axis=2)

    def differs(x, y):
        across, down = (round(pixel) for pixel in WHOLE.to_pixel(x, y))
        return difference[down - 1:down + 2, across - 1:across + 2].any()
    assert all(differs(*point) for point in ((0.5, 2.5), (1.0, 3.5), (2.0, 3.2)))
    assert not any(differs(*point) for point in ((0.0, 3.5), (1.5, 3.75), (1.2, 4.2), (2.0, 2.6)))


def test_a_picture_that_is_extended_equals_one_that_is_painted_at_once():
    points = [(0.0, 2.5), (1.0, 2.6), (1.2, 4.5), (np.nan, np.nan), (2.0, 3.0), (2.0, 3.4), (1.5, 3.0)]
    keeping = ScenePainter()
    for shown in range(1, len(points) + 1):
        now = snapshot(robot(path=path(*points[:shown])), robot('rumba2', Pose(2.0, 2.5, 1.0)))
        kept = QImage(WIDTH, HEIGHT, QImage.Format_RGB32)
        painter = QPainter(kept)
        keeping.paint(painter, now, WHOLE, LIGHT)
        painter.end()
    repainted = picture(now, WHOLE, LIGHT)
    assert (abs(pixels(kept) - pixels(repainted)).max(axis=2) > 40).sum() < 20  # smoothed twice where two parts meet
    far = path((0.0, 2.5), (2.0, 4.5), number=8)
    painter = QPainter(kept)
    keeping.paint(painter, snapshot(robot(path=far)), WHOLE, LIGHT)
    painter.end()
    assert kept == picture(snapshot(robot(path=far)), WHOLE, LIGHT)


@THEMES
def test_the_beams_of_the_laser_are_tinted(theme):
    beams = np.array([(1.5, 4.6), (0.5, 4.6), (0.5, 3.6), (1.5, 3.6)])  # in front of the robot
    pose = Pose(1.0, 3.6, 0.5 * math.pi)
    lit = picture(snapshot(robot(pose=pose, beams=beams)), WHOLE, theme)
    assert not at(lit, WHOLE, 1.0, 4.2, theme.floor.out_of_reach, 2)
    assert at(lit, WHOLE, 1.0, 3.35, theme.floor.out_of_reach, 2)
    assert at(picture(snapshot(robot(pose=pose)), WHOLE, theme), WHOLE, 1.0, 4.2, theme.floor.out_of_reach, 2)


@THEMES
def test_a_planned_path_is_dashed_from_corner_to_corner(theme):
    planned = np.array([(0.6, 3.0), (2.6, 3.0), (2.6, 1.0)])
    image = picture(snapshot(robot(pose=Pose(0.3, 4.0, 0.0), planned=planned)), WHOLE, theme)
    plain = picture(snapshot(robot(pose=Pose(0.3, 4.0, 0.0))), WHOLE, theme)
    changed = np.abs(pixels(image) - pixels(plain)).max(axis=2) > 20
    for left, bottom, right, top in ((0.6, 2.95, 2.6, 3.05), (2.55, 1.0, 2.65, 3.0)):
        (first, low), (last, high) = (
            np.round(WHOLE.to_pixel(*at)).astype(int) for at in ((left, top), (right, bottom)))
        part = changed[low:high, first:last]
        assert 0.2 < part.any(axis=0 if right - left > top - bottom else 1).mean() < 0.95
    assert changed.sum() < 8 * WHOLE.scale


def test_a_picture_of_plans_that_was_kept_follows_other_plans_views_and_robots():
    one, other = np.array([(0.6, 3.0), (2.6, 3.0)]), np.array([(0.6, 2.0), (2.6, 2.0)])
    keeping, nearer = ScenePainter(), WHOLE.zoomed(1.5, 100.0, 100.0)
    for planned, view in ((one, WHOLE), (one, WHOLE), (other, WHOLE), (other, nearer), (None, nearer), (one, nearer)):
        now = snapshot(robot(pose=Pose(0.3, 4.0, 0.0), planned=planned))
        kept = QImage(int(view.width), int(view.height), QImage.Format_RGB32)
        painter = QPainter(kept)
        keeping.paint(painter, now, view, LIGHT)
        painter.end()
        assert kept == picture(now, view, LIGHT)


@THEMES
def test_particles_and_the_believed_robot_are_painted_where_they_are_beside_the_true_one(theme):
    true, believed = Pose(0.0, 4.0, 0.0), Pose(1.5, 4.0, 0.5 * math.pi)
    cloud = np.array([(0.6, 3.2), (0.7, 3.2)])
    image = picture(snapshot(robot(pose=true, believed=believed, particles=cloud)), WHOLE, theme)
    plain = picture(snapshot(robot(pose=true)), WHOLE, theme)
    colour, radius = robot_colour('rumba'), RING * 0.17425
    ring = [(1.5 + radius * math.cos(angle), 4.0 + radius * math.sin(angle)) for angle in np.arange(0.0, 6.28, 0.02)]
    share = np.mean([at(image, WHOLE, x, y, colour, 60) for x, y in ring])
    assert 0.3 < share < 0.95 and not any(at(plain, WHOLE, x, y, colour, 60) for x, y in ring)
    assert at(image, WHOLE, 1.5, 4.0 + 1.3 * radius, colour, 60)
    assert not at(image, WHOLE, 1.5 + 1.3 * radius, 4.0, colour)
    for x, y in cloud:
        left, top = (round(pixel) for pixel in WHOLE.to_pixel(x, y))
        spot = left - 1, top - 1, left + 2, top + 2
        assert abs(pixels(image.copy(spot[0], spot[1], 3, 3)) - pixels(plain.copy(spot[0], spot[1], 3, 3))).max() > 40


def test_dock_carpet_and_cliff_are_painted_on_their_cells():
    carpet, cliff = np.zeros((30, 40), bool), np.zeros((30, 40), bool)
    carpet[8:12, 5:10] = cliff[20:28, 20:30] = True
    pose = Pose(0.0, 4.0, math.pi)  # faces the left
    field = np.array([(-0.2, 4.0), (0.8, 4.4), (0.8, 3.6)])
    features = MapFeatures((Dock(pose, field, field),), carpet, cliff, True)
    image, plain = (picture(snapshot(robot(pose=Pose(2.0, 2.6, 0.0)), features=features), WHOLE, LIGHT),
                    picture(snapshot(robot(pose=Pose(2.0, 2.6, 0.0))), WHOLE, LIGHT))
    assert at(image, WHOLE, -0.17, 4.0, LIGHT.floor.dock)
    assert not at(image, WHOLE, 0.17, 4.0, LIGHT.floor.dock, 20)
    assert not at(image, WHOLE, 0.6, 4.0, LIGHT.floor.out_of_reach, 4)
    left, top = (round(pixel) for pixel in WHOLE.to_pixel(-0.5, 3.2))
    box = left, top, left + 50, top + 40  # with four of the dots, which are 0.2 m apart
    assert count(plain, LIGHT.floor.carpet, *box) == 0 < count(image, LIGHT.floor.carpet, *box) < 500
    assert count(image, LIGHT.floor.to_sweep, *box) > 1000
    left, top = (round(pixel) for pixel in WHOLE.to_pixel(1.0, 4.8))
    assert count(image, LIGHT.floor.cliff, left, top, left + 100, top + 80) > 2000
    assert count(image, LIGHT.floor.cliff) == count(image, LIGHT.floor.cliff, left, top, left + 100, top + 80)


def test_several_robots_have_colours_names_and_a_ring_around_the_selected():
    pair = robot(pose=Pose(0.0, 4.0, 0.0)), robot('rumba2', Pose(1.5, 4.0, 0.0))
    image = picture(snapshot(*pair, selected='rumba2'), WHOLE, LIGHT)
    first, second = (robot_colour(one.name) for one in pair)
    assert first != second
    for name, x in ((first, 0.0), (second, 1.5)):
        across, down = (round(pixel) for pixel in WHOLE.to_pixel(x, 4.0))
        assert count(image, name, across - 40, down + 20, across + 40, down + 45, 60) > 20, 'no name below it'
    assert at(image, WHOLE, 1.5 + 1.22 * 0.17425, 4.0, second, 60)
    assert not at(image, WHOLE, 1.22 * 0.17425, 4.0, first, 60)
    alone = picture(snapshot(pair[0]), WHOLE, LIGHT)
    assert not at(alone, WHOLE, 1.22 * 0.17425, 4.0, first, 60)


def test_a_robot_that_is_too_small_to_be_seen_gets_a_ring():
    view = ViewTransform(WIDTH, HEIGHT, 1.0, 3.5, 10.0)
    image = picture(snapshot(robot(pose=Pose(1.0, 4.0, 0.0))), view, LIGHT)
    across, down = view.to_pixel(1.0, 4.0)
    assert near(image, across + 9, down, robot_colour('rumba'), 70)


@pytest.mark.parametrize('scale, length', [(100.0, 100), (10.0, 100), (300.0, 60), (3000.0, 60)])
def test_the_scale_bar_has_a_round_length(scale, length):
    image = picture(snapshot(), ViewTransform(WIDTH, HEIGHT, 1.0, 3.5, scale), LIGHT)
    rows = [count(image, LIGHT.text, 0, row, 200, row + 1, 8) for row in range(HEIGHT - 30, HEIGHT)]
    assert abs(max(rows) - length) <= 2


@THEMES
@pytest.mark.parametrize('size', [(640, 480), (300, 200)])
def test_what_is_missing_is_written_in_the_middle(size, theme):
    text = 'Waiting for a simulator\nTo start one, in another terminal:\nroslaunch rumba_sim simulator.launch'
    view = ViewTransform(*size, 1.0, 3.5, 10.0)
    image = picture(Snapshot(missing=text), view, theme)
    empty = picture(Snapshot(), view, theme)
    assert count(image, theme.text, tolerance=60) > 100
    assert count(empty, theme.text, tolerance=60) == 0
    for edge in (0, size[0] - 1):
        assert count(image, theme.background, edge, 0, edge + 1) == size[1], 'it does not fit'


def test_the_plan_of_another_map_replaces_the_old_one():
    painter_of_many = ScenePainter()
    other = plan(number=9)
    other.cells[:] = 100
    for shown, colour in ((snapshot(), LIGHT.floor.out_of_reach),
                          (snapshot(plan=other, coverage=None), LIGHT.floor.wall)):
        image = QImage(WIDTH, HEIGHT, QImage.Format_RGB32)
        painter = QPainter(image)
        painter_of_many.paint(painter, shown, WHOLE, LIGHT)
        painter.end()
        assert at(image, WHOLE, 1.0, 4.0, colour)
