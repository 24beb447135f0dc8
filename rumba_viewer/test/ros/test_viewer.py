#!/usr/bin/env python3
"""The viewer beside a simulator: it shows, drives, asks, comes and goes, and the simulation never needs it."""

import pathlib
import signal
import tempfile
import unittest

import numpy as np
import rosnode
import rospy
import rostest
from geometry_msgs.msg import Pose2D, Twist
from PIL import Image
from simulators import Heard, Master, Simulator, stands_still, wait
from viewers import CARD, CLIFF, ROBOT, Display, Viewer, of_colour

from rumba_msg.msg import CleanActionGoal, MissionStatus

KEY_SPEED = 0.3  # [m/s]


def middle(shown):
    """Column and row in the middle of what is true: bool (rows, columns)."""
    rows, columns = np.nonzero(shown)
    return columns.mean(), rows.mean()


class ViewerTest(unittest.TestCase):
    """Each test has simulators and viewers of its own."""

    def test_keys_drive_pause_and_close_the_window_and_the_simulation_goes_on(self):
        simulator = Simulator(self, '_map:=field', '_speed:=2')
        viewer = Viewer(self, display=Display(self)).is_there()
        commands, truth, clock = Heard(self, '/rumba/cmd_vel', Twist), Heard(self, '/rumba/ground_truth'), Heard(
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

    def test_a_goal_goes_to_the_cleaner(self):
        Simulator(self, '_map:=studio')
        viewer = Viewer(self, display=Display(self)).is_there()
        status = rospy.Publisher('/rumba/mission_status', MissionStatus, queue_size=1, latch=True)
        self.addCleanup(status.unregister)
        status.publish(MissionStatus(state=MissionStatus.IDLE, message='waits'))
        goals = Heard(self, '/rumba/clean/goal', CleanActionGoal)
        wait(self, status.get_num_connections, 'the viewer to listen')
        viewer.wait_to_see(ROBOT, 20)
        viewer.front()
        self.assertEqual(viewer.key_until('c', lambda: goals.messages, 'a goal')[0].goal.strategy, '')

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

    def test_it_goes_on_when_the_simulator_was_killed_and_another_begins(self):
        first = Simulator(self, '_map:=field', '_speed:=2')
        viewer = Viewer(self).is_there()
        viewer.wait_to_see(ROBOT, 20)
        first.process.send_signal(signal.SIGKILL)
        first.process.wait()
        viewer.wait_to_see(ROBOT, 0, 0)
        Simulator(self, '_map:=apartment', '_speed:=2')
        viewer.wait_to_see(ROBOT, 20)
        viewer.wait_to_see(CLIFF, 100)  # that is in the map's files alone

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
        simulator.does('spawn', 'rumba7', Pose2D(5.0, 5.0, 0.0))  # the colour of rumba, after six others
        viewer.wait_to_see(ROBOT, int(1.5 * first.sum()))
        simulator.does('kill', 'rumba7')
        viewer.wait_to_see(ROBOT, 20, int(1.2 * first.sum()))

    def test_a_picture_can_be_had_without_a_display(self):
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

    def test_without_a_master_the_window_says_so_and_goes_on_when_there_is_one(self):
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

    def test_without_a_display_it_is_one_line_and_where_possible_no_error(self):
        nowhere = type('Nowhere', (), {'name': ''})
        for arguments, code, line in (
                ([], 2, r'(?m)^viewer: no window: there is no display: neither DISPLAY nor WAYLAND_DISPLAY is set$'),
                (['_where_possible:=true'], 0, r'no window, the simulation goes on without: there is no display')):
            self.assertRegex(Viewer(self, *arguments, display=nowhere).ends(code), line)
        closed = type('Closed', (), {'name': ':9999'})
        self.assertRegex(Viewer(self, display=closed).ends(2), 'no window: the display :9999 cannot be opened')


if __name__ == '__main__':
    rospy.init_node('test_viewer', disable_rostime=True)
    rostest.rosrun('rumba_viewer', 'viewer', ViewerTest)
