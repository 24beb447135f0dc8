#!/usr/bin/env python3
"""The viewer beside a simulator: it shows, drives, sends goals, is opened and closed; the simulation never needs it."""

import os
import pathlib
import signal
import tempfile
import unittest

import numpy as np
import programs
import rosgraph
import rosnode
import rospy
import rostest
from geometry_msgs.msg import Pose2D, Twist
from PIL import Image
from simulators import Heard, Master, Simulator, stands_still, wait, wait_for_service
from viewers import CARD, CLIFF, ROBOT, Cleaner, Display, Viewer, of_colour

from rumba_msg.msg import MissionStatus, Outcome

KEY_SPEED = 0.3  # [m/s]


def middle(shown):
    """Column and row of the centre of all true pixels: bool (rows, columns)."""
    rows, columns = np.nonzero(shown)
    return columns.mean(), rows.mean()


def subscribers(topic):
    """Names of the nodes that listen to a topic."""
    return dict(rosgraph.Master('/test').getSystemState()[1]).get(topic, [])


class Node:
    """A node that serves a service, until the end of a test."""

    def __init__(self, test, service, package, node, *arguments):
        process = programs.start(package, node, *arguments)
        test.addCleanup(process.wait)
        test.addCleanup(process.terminate)
        wait_for_service(test, service, process)


class ViewerTest(unittest.TestCase):
    """Each test has simulators and viewers of its own."""

    def test_keys_drive_pause_and_close_the_window_and_the_simulation_goes_on(self):
        simulator = Simulator(self, '_map:=field', '_speed:=2')
        viewer = Viewer(self, display=Display(self)).is_there()
        commands, truth, clock = Heard(self, '/rumba/teleop/cmd_vel', Twist), Heard(self, '/rumba/ground_truth'), Heard(
            self, '/clock')
        viewer.wait_to_see(ROBOT, 20)
        viewer.front()
        start = truth.fresh().pose.pose.position.x
        viewer.key('keydown', 'w')
        truth.find(lambda message: message.pose.pose.position.x > start + 1.0)
        self.assertEqual({twist.linear.x for twist in commands.messages}, {KEY_SPEED}, 'a key that repeats flickers')
        viewer.key('keyup', 'w')
        commands.find(lambda twist: twist.linear.x == 0.0)
        truth.fresh(lambda message: message.twist.twist.linear.x == 0.0)
        viewer.key('key', 'space')
        wait(self, lambda: stands_still(clock), 'the pause')
        paused_at = clock.messages[-1].clock
        viewer.key_until('n', lambda: clock.messages[-1].clock > paused_at, 'a step')
        stepped_to = clock.messages[-1].clock
        viewer.key_until('space', lambda: clock.messages[-1].clock > stepped_to + rospy.Duration(0.2), 'time to go on')
        viewer.key('key', 'b')
        Heard(self, '/rumba/battery_status').find(lambda message: message.brushes_up)
        viewer.key('key', 'ctrl+q')
        viewer.ends()
        clock.fresh()
        self.assertIsNone(simulator.process.poll())

    def test_a_cleaning_is_started_interrupted_and_resumed(self):
        Simulator(self, '_map:=studio')
        viewer = Viewer(self, display=Display(self)).is_there()
        cleaner = Cleaner(self)
        cleaner.tell(MissionStatus.IDLE)
        viewer.wait_to_see(ROBOT, 20)
        viewer.front()
        self.assertFalse(viewer.key_until('c', lambda: cleaner.goals, 'a goal')[0].goal.resume)
        cleaner.tell(MissionStatus.CLEANING, 'bounce')
        cleaner.ends(Outcome.CANCELLED)
        cleaner.tell(MissionStatus.IDLE)
        cleaner.goals.clear()
        self.assertTrue(viewer.key_until('r', lambda: cleaner.goals, 'a goal')[0].goal.resume)

    @unittest.skipIf('RUMBA_PLATFORM' in os.environ, 'roslz4 is compiled for the Python of the system alone')
    def test_a_mission_is_recorded_and_a_page_made_of_it_when_it_has_ended(self):
        Simulator(self, '_map:=studio', '_speed:=10')
        viewer = Viewer(self, display=Display(self)).is_there()
        cleaner = Cleaner(self)
        cleaner.tell(MissionStatus.IDLE)
        viewer.wait_to_see(ROBOT, 20)
        viewer.front()
        viewer.key('key', 'ctrl+b')
        truth = Heard(self, '/rumba/ground_truth')
        wait(self, lambda: any(name.startswith('/record') for name in subscribers('/rumba/ground_truth')), 'rosbag')
        cleaner.tell(MissionStatus.CLEANING, 'bounce')
        begun = truth.fresh().header.stamp
        truth.find(lambda message: (message.header.stamp - begun).to_sec() > 5.0)
        cleaner.tell(MissionStatus.IDLE)
        folder = pathlib.Path(viewer.folder.name)
        page = wait(self, lambda: [path for path in folder.glob('*.html') if path.stat().st_size], 'the page')[0]
        self.assertTrue(page.with_suffix('.bag').exists())
        self.assertIn('Mission of rumba', wait(self, page.read_text, 'its content'))

    def test_a_click_shows_a_target_and_only_a_double_click_sends_a_goal(self):
        Simulator(self, '_map:=studio')
        viewer = Viewer(self, display=Display(self)).is_there()
        cleaner = Cleaner(self)
        cleaner.tell(MissionStatus.IDLE)
        seen = viewer.wait_to_see(ROBOT, 20).sum()
        viewer.front()
        viewer.click(0.5, 0.5)
        viewer.wait_to_see(ROBOT, seen + 40)  # the mark has the colour of the robot
        viewer.key('key', 'Escape')
        viewer.wait_to_see(ROBOT, 0, seen + 20)
        self.assertEqual(cleaner.goals, [])
        viewer.click(0.5, 0.45, times=2)
        goal = wait(self, lambda: cleaner.goals, 'a goal')[0].goal
        self.assertTrue(1.0 < goal.target.x < 5.0 and 1.0 < goal.target.y < 5.0, goal)

    def test_it_works_beside_a_simulator_of_another_name(self):
        Simulator(self, '_map:=apartment', '_speed:=2', '__name:=sim2', node='/sim2')
        viewer = Viewer(self, display=Display(self)).is_there()
        clock = Heard(self, '/clock')
        viewer.wait_to_see(ROBOT, 20)
        viewer.wait_to_see(CLIFF, 100)  # read from the files of the map
        viewer.front()
        viewer.key_until('space', lambda: stands_still(clock), 'the pause')

    def test_it_works_beside_a_turtle_as_the_body(self):
        Node(self, '/turtle1/set_pen', 'turtlesim', 'turtlesim_node', '_gui:=false')
        Node(self, '/turtlesim_body/reset', 'rumba_sim', 'turtlesim_body')
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, 'picture.png')
            Viewer(self, f'_save_png:={path}').ends()
            self.assertGreater(of_colour(np.asarray(Image.open(str(path)).convert('RGB')).astype(int), ROBOT).sum(), 20)

    def test_it_ends_cleanly_by_signals_and_by_rosnode_kill(self):
        Simulator(self, '_map:=studio')
        for number in (signal.SIGINT, signal.SIGTERM):
            viewer = Viewer(self).is_there()
            viewer.wait_to_see(ROBOT, 20)
            viewer.end(number)
        viewer = Viewer(self).is_there()
        viewer.wait_to_see(ROBOT, 20)
        rosnode.kill_nodes(['/viewer'])
        viewer.ends()

    def test_it_goes_on_if_the_simulator_is_killed_and_another_starts(self):
        first = Simulator(self, '_map:=field', '_speed:=2')
        viewer = Viewer(self).is_there()
        viewer.wait_to_see(ROBOT, 20)
        first.process.send_signal(signal.SIGKILL)
        first.process.wait()
        viewer.wait_to_see(ROBOT, 0, 0)
        Simulator(self, '_map:=apartment', '_speed:=2')
        viewer.wait_to_see(ROBOT, 20)
        viewer.wait_to_see(CLIFF, 100)  # read from the files of the map

    def test_robots_come_and_go_and_y_points_upward(self):
        simulator = Simulator(self, '_map:=field', '_robots:=0')
        viewer = Viewer(self).is_there()
        viewer.wait_to_see(CARD, 20_000)
        simulator.does('spawn', 'rumba', Pose2D(2.0, 9.0, 0.0))
        first = viewer.wait_to_see(ROBOT, 20)
        across, down = middle(first)
        simulator.teleport(8.0, 3.0, 0.0)
        wait(self, lambda: middle(viewer.wait_to_see(ROBOT, 20))[0] > across + 100, 'the robot elsewhere')
        self.assertGreater(middle(viewer.wait_to_see(ROBOT, 20))[1], down + 100)
        simulator.does('spawn', 'rumba7', Pose2D(5.0, 5.0, 0.0))  # has the colour of rumba: there are six
        viewer.wait_to_see(ROBOT, int(1.5 * first.sum()))
        simulator.does('kill', 'rumba7')
        viewer.wait_to_see(ROBOT, 20, int(1.2 * first.sum()))

    def test_a_picture_is_saved_without_a_display(self):
        Simulator(self, '_map:=studio')
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, 'new', 'picture.png')
            Viewer(self, f'_save_png:={path}', '_width:=800', '_height:=500').ends()
            picture = np.asarray(Image.open(str(path)).convert('RGB')).astype(int)
        self.assertEqual(picture.shape, (500, 800, 3))
        self.assertGreater(of_colour(picture[:, :500], ROBOT).sum(), 20)
        self.assertFalse(rospy.has_param('/viewer/save_png'), 'the next viewer would save and end too')

    def test_a_picture_that_cannot_be_saved_is_one_line_and_exit_code_2(self):
        Simulator(self, '_map:=studio')
        printed = Viewer(self, '_save_png:=/proc/none/picture.png').ends(2)
        self.assertRegex(printed, r'(?m)^viewer: save_png: .*/proc/none')

    def test_without_a_master_the_window_tells_so_and_goes_on_when_there_is_one(self):
        display, master = Display(self), Master(self)
        viewer = Viewer(self, display=display, master=master.uri)
        wait(self, lambda: f'No roscore answers at {master.uri}' in viewer.printed, 'the line')
        viewer.front()
        master.start()
        master.wait_for('/viewer/save_png')
        viewer.front()
        viewer.key('key', 'ctrl+q')
        viewer.ends()

    def test_a_window_that_waits_for_a_master_can_be_closed(self):
        for end in ('close', signal.SIGINT):
            viewer = Viewer(self, display=Display(self), master='http://localhost:9')
            viewer.front()
            if end == 'close':
                viewer.key('key', 'ctrl+q')
                viewer.ends()
            else:
                viewer.end(end)

    def test_without_a_display_one_line_tells_why_and_with_where_possible_it_is_no_error(self):
        nowhere = type('Nowhere', (), {'name': ''})
        for arguments, code, line in (
                ([], 2, r'(?m)^viewer: no window: there is no display: neither DISPLAY nor WAYLAND_DISPLAY is set$'),
                (['_where_possible:=true'], 0, r'the simulation runs without a window: there is no display')):
            self.assertRegex(Viewer(self, *arguments, display=nowhere).ends(code), line)
        closed = type('Closed', (), {'name': ':9999'})
        self.assertRegex(Viewer(self, display=closed).ends(2), 'no window: the display :9999 cannot be opened')

    def test_without_qt_one_line_names_the_package_and_with_where_possible_it_is_no_error(self):
        package = 'PyQt5 is not installed: apt-get install python3-pyqt5'
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, 'PyQt5.py').write_text('raise ModuleNotFoundError("No module named \'PyQt5\'")\n')
            path = f'{folder}:{os.environ["PYTHONPATH"]}'
            for arguments, code, line in (
                    ([], 2, f'viewer: no window: {package}'),
                    (['_where_possible:=true'], 0, f'the simulation runs without a window: {package}')):
                printed = Viewer(self, *arguments, PYTHONPATH=path).ends(code).strip()
                self.assertTrue(printed.endswith(line) and len(printed.splitlines()) == 1, printed)


if __name__ == '__main__':
    rospy.init_node('test_viewer', disable_rostime=True)
    rostest.rosrun('rumba_viewer', 'viewer', ViewerTest)
