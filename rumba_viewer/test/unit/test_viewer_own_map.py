"""What a robot knows over the true map: where its own map is, what is faint, and where the robot is sent."""

import math
import time

import numpy as np
import pytest
from fake_topics import Topic
from geometry_msgs.msg import Point as PointMessage
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from nav_msgs.msg import MapMetaData, OccupancyGrid, Odometry, Path
from PyQt5.QtGui import QColor, QImage, QPainter
from pytest import approx
from rospy.numpy_msg import numpy_msg
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage
from windows import HEIGHT, SCALE, WIDTH, Opened, count, near, robot, simulation, snapshot

from rumba_sim.model.common.geometry import Pose, compose
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, UNKNOWN
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.ros.common.conversions import transform
from rumba_viewer.painting.paint_scene import ScenePainter, picture
from rumba_viewer.ros import listener
from rumba_viewer.ros.ros_graph import RosGraph
from rumba_viewer.scene.acts import target, way
from rumba_viewer.scene.map_frame import on_floor, on_map
from rumba_viewer.scene.snapshot import Grid, Point
from rumba_viewer.scene.theme import DARK, LIGHT
from rumba_viewer.scene.view_transform import ViewTransform

THEMES = pytest.mark.parametrize('theme', [LIGHT, DARK], ids=['light', 'dark'])
WHOLE = ViewTransform(WIDTH, HEIGHT, 1.0, 3.5, SCALE)
FRAME = Pose(2.0, 1.0, 0.5 * math.pi)  # of the robot's map on the floor
BELIEVED = Pose(0.5, 0.25, 0.1)
GRAPH = RosGraph('a master', ('rumba',), frozenset({'/simulator/reset'}))


# --- from messages ----------------------------------------------------------------------------------------------------

def grid(cells, resolution=0.5):
    """A map whose lower left corner is the origin of its frame."""
    rows, columns = cells.shape
    return numpy_msg(OccupancyGrid)(info=MapMetaData(resolution=resolution, width=columns, height=rows),
                                    data=cells.ravel().astype(np.int8))


def link(frame=FRAME, parent='world'):
    """A message that tells where the robot's map is, or something else."""
    return TFMessage([transform('base_link', 'laser', Pose(9.0, 9.0, 0.0), None),
                      transform(parent, 'map', frame, None)])


OWN = grid(np.array([[FREE, OCCUPIED]]))  # turned by FRAME: one cell above the other
TRUE = grid(np.zeros((6, 8)))


@pytest.fixture
def heard(topics, monkeypatch):
    """A listener to one robot."""
    monkeypatch.setattr(listener, 'robot_config', lambda _: RobotConfig())
    one = listener.Listener('rumba', False)
    one._follow(GRAPH)
    return one


def believed():
    """Where the robot believes to be, in the frame of its map."""
    message = PoseWithCovarianceStamped(header=Header(frame_id='map'))
    message.pose.pose.position = PointMessage(BELIEVED.x, BELIEVED.y, 0.0)
    message.pose.pose.orientation = transform('', '', BELIEVED, None).transform.rotation
    return message


def hear(**messages):
    """Messages come, by their topics, and then those of the robot, which believes and plans something."""
    plan = Path(poses=[PoseStamped(pose=believed().pose.pose)])
    for topic, message in {**messages, 'rumba/ground_truth': Odometry(), 'rumba/amcl_pose': believed(),
                           'rumba/plan': plan}.items():
        Topic.opened[topic].callback(message)


def shown(one):
    """The present snapshot."""
    return one.snapshot(time.monotonic())


def test_without_a_true_map_that_of_the_topic_map_is_the_floor(heard):
    hear(**{'/map': OWN, '/tf_static': link(parent='earth')})
    now = shown(heard)
    assert (now.plan.cells.shape, now.known, now.map_frame) == ((1, 2), None, Pose(0.0, 0.0, 0.0))
    assert now.robot.believed == approx(BELIEVED)


def test_the_own_map_is_laid_over_the_true_one_where_its_frame_is(heard):
    hear(**{'simulator/map': TRUE, '/map': OWN, '/tf_static': link()})
    Topic.opened['/tf_static'].callback(link(parent='earth'))  # others publish there too
    now = shown(heard)
    wanted = np.full((6, 8), UNKNOWN)
    wanted[2, 3], wanted[3, 3] = FREE, OCCUPIED
    assert now.known.cells.tolist() == wanted.tolist() and now.plan.cells.shape == (6, 8)
    assert now.map_frame == approx(FRAME) and now.robot.believed == approx(compose(FRAME, BELIEVED))
    assert now.robot.planned == approx(np.array([compose(FRAME, BELIEVED)[:2]]))


def test_a_map_that_grows_is_shown_and_the_robot_keeps_its_path(heard):
    hear(**{'simulator/map': TRUE, '/map': OWN, '/tf_static': link()})
    before = shown(heard)
    assert before.robot is not None
    Topic.opened['/map'].callback(grid(np.array([[FREE, FREE, OCCUPIED]])))
    assert heard.has_news(time.monotonic())
    now = shown(heard)
    assert now.robot.pose == before.robot.pose and now.plan is before.plan
    assert (now.known.cells[:, 3].tolist(), now.known.number == before.known.number) == (
        [UNKNOWN, UNKNOWN, FREE, FREE, OCCUPIED, UNKNOWN], False)


def test_until_its_frame_is_known_nothing_of_the_robots_map_is_shown(heard):
    hear(**{'simulator/map': TRUE, '/map': OWN})
    now = shown(heard)
    assert (now.known.cells == UNKNOWN).all() and now.map_frame is None
    assert (now.robot.believed, now.robot.planned) == (None, None)


def test_a_simulator_that_no_longer_tells_the_true_map_is_followed(heard):
    hear(**{'simulator/map': TRUE, '/map': OWN, '/tf_static': link()})
    Topic.opened['simulator/map'].impl.number = 0
    now = shown(heard)
    assert (now.plan.cells.shape, now.known, now.map_frame) == ((1, 2), None, Pose(0.0, 0.0, 0.0))


# --- painted ----------------------------------------------------------------------------------------------------------

def known():
    """The map of a robot that knows the left half, misses the upper part of the wall there, and believes in another."""
    cells = np.full((30, 40), UNKNOWN, np.int8)
    cells[:, :20] = FREE
    cells[:20, :3] = OCCUPIED
    cells[14:16, 10:14] = OCCUPIED
    return Grid(cells, 0.1, -1.0, 2.0, 5)


@THEMES
def test_what_the_robot_does_not_know_is_faint_and_its_own_walls_are_painted(theme):
    image, plain = (picture(snapshot(known=each), WHOLE, theme) for each in (known(), None))

    def has(x, y, colour):
        return near(image, *WHOLE.to_pixel(x, y), colour)

    def faint(x, y):
        place = [math.floor(pixel) for pixel in WHOLE.to_pixel(x, y)]
        before, now, below = (np.array(colour.getRgb()[:3], float) for colour in (
            plain.pixelColor(*place), image.pixelColor(*place), QColor(theme.background)))
        return np.abs(now - below).max() < 0.4 * np.abs(before - below).max()
    assert has(-0.9, 3.0, theme.floor.wall) and has(0.2, 3.5, theme.floor.wall), 'the walls of its map'
    assert has(0.5, 2.4, theme.floor.swept) and has(0.5, 3.1, theme.floor.to_sweep)
    assert has(0.5, 4.0, theme.floor.out_of_reach)
    assert faint(-0.9, 4.5), 'a wall that its map does not show'
    assert faint(1.5, 3.1) and faint(1.5, 4.0) and faint(2.45, 4.55), 'what it has not seen'


def test_a_map_that_grows_is_painted_again():
    image, painter = QImage(WIDTH, HEIGHT, QImage.Format_RGB32), ScenePainter()
    for each in (Grid(np.full((30, 40), UNKNOWN, np.int8), 0.1, -1.0, 2.0, 4), known()):
        to = QPainter(image)
        painter.paint(to, snapshot(known=each), WHOLE, LIGHT)
        to.end()
    assert image == picture(snapshot(known=known()), WHOLE, LIGHT)


@pytest.mark.parametrize('grid, is_named', [(known(), True), (None, False)])
def test_the_key_names_what_is_faint_only_if_something_is(grid, is_named):
    view = ViewTransform(760, HEIGHT, 1.0, 8.0, SCALE)  # the floor is below the picture
    words = [count(picture(snapshot(known=each), view, LIGHT), LIGHT.text, top=HEIGHT - 40) for each in (grid, None)]
    assert (words[0] > 1.1 * words[1]) is is_named


# --- sent -------------------------------------------------------------------------------------------------------------

def test_a_point_of_the_floor_is_sent_in_the_frame_of_the_robots_map():
    opened = Opened(snapshot(robot(), known=known(), map_frame=FRAME))
    view = opened.window.floor.view
    opened.double_click(*view.to_pixel(1.5, 4.0))
    [(x, y)] = [arguments for name, *arguments in opened.actor.done if name == 'go_to']
    assert (x, y) == approx((3.0, 0.5), abs=1.5 / view.scale)
    opened.window.close()


def test_no_point_can_be_named_before_there_is_a_map():
    now = snapshot(robot(), map_frame=None, target=Point(1.0, 1.0), simulation=simulation())
    assert way(now) == target(now) == 'rumba has not begun a map yet'
    opened = Opened(now)
    opened.click(100, 100)
    opened.double_click(100, 100)
    assert not any(name == 'go_to' for name, *_ in opened.actor.done)
    opened.window.close()


def test_all_that_a_robot_believes_is_moved_and_a_point_comes_back():
    told = robot(believed=BELIEVED, particles=np.array([[1.0, 2.0]]), planned=np.array([[3.0, 4.0], [5.0, 6.0]]),
                 going_to=Point(7.0, 8.0))
    moved = on_floor(told, FRAME)
    assert moved.believed == approx(compose(FRAME, BELIEVED)) and moved.pose == told.pose
    assert (moved.particles, moved.planned) == (approx(np.array([[0.0, 2.0]])),
                                                approx(np.array([[-2.0, 4.0], [-4.0, 6.0]])))
    assert moved.going_to == approx((-6.0, 8.0)) and on_map(moved.going_to, FRAME) == approx(told.going_to)
