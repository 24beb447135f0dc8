#!/usr/bin/env python3
"""turtlesim_node does what the documentation of turtlesim says."""

import pathlib
import signal
import subprocess
import tempfile
import unittest

import rosgraph
import rospy
import rostest
from nodes import TIMEOUT, Heard, Turtlesim, commander, wait, without_display

README = (pathlib.Path(__file__).resolve().parents[2] / 'README.md').read_text()
MIDDLE = 5.544444
BACKGROUND, PEN = (69, 86, 255), (0xb3, 0xb8, 0xff)


def rgb(message):
    """Return a colour message as a tuple."""
    return message.r, message.g, message.b


class TurtlesimNodeTest(unittest.TestCase):
    """Each test starts a node, in real time and without a display."""

    def test_its_topics_services_and_parameters_are_those_of_turtlesim(self):
        Turtlesim(self)
        publishers, subscribers, services = rosgraph.Master('/test').getSystemState()
        topics = dict(rosgraph.Master('/test').getTopicTypes())

        def of_node(pairs):
            return {name for name, nodes in pairs if '/turtlesim' in nodes}

        self.assertEqual(of_node(publishers), {'/rosout', '/turtle1/pose', '/turtle1/color_sensor'})
        self.assertEqual(of_node(subscribers), {'/turtle1/cmd_vel'})
        self.assertEqual((topics['/turtle1/pose'], topics['/turtle1/color_sensor']),
                         ('turtlesim/Pose', 'turtlesim/Color'))
        self.assertEqual(
            {name for name in of_node(services) if '_logger' not in name},
            {'/clear', '/reset', '/spawn', '/kill', '/turtlesim/save_png', '/turtle1/set_pen',
             '/turtle1/teleport_absolute', '/turtle1/teleport_relative'})
        for name in (of_node(publishers) | of_node(subscribers) | of_node(services)) - {'/rosout'}:
            self.assertTrue('_logger' in name or f'`{name[1:]}`' in README, name)
        self.assertEqual(rospy.get_param('/turtlesim'), {'background_r': 69, 'background_g': 86, 'background_b': 255})

    def test_a_command_lasts_for_a_second_and_a_pose_comes_at_each_step(self):
        Turtlesim(self)
        pose = Heard(self, '/turtle1/pose')
        first = pose.find()
        self.assertAlmostEqual(first.x, MIDDLE, 5)
        self.assertAlmostEqual(first.y, MIDDLE, 5)
        self.assertEqual((first.theta, first.linear_velocity, first.angular_velocity), (0.0, 0.0, 0.0))
        pose.messages.clear()
        commander(self)(2.0, 0.0, 0.0)
        pose.find(lambda pose: pose.linear_velocity == 2.0)
        last = pose.find(lambda pose: pose.x > 7.0 and pose.linear_velocity == 0.0)
        # 63 steps of 16 ms begin within a second.
        self.assertAlmostEqual(last.x, MIDDLE + 2.0 * 63 * 0.016, 5)
        moving = [pose for pose in pose.messages if pose.linear_velocity]
        self.assertEqual(len(moving), 63)
        self.assertEqual(len({pose.x for pose in moving}), 63)

    def test_linear_y_goes_to_the_left_and_angular_z_turns_left(self):
        Turtlesim(self)
        pose, drive = Heard(self, '/turtle1/pose'), commander(self)
        drive(0.0, 1.0, 0.0)
        end = pose.find(lambda pose: pose.y > MIDDLE + 1.0 and pose.linear_velocity == 0.0)
        self.assertAlmostEqual(end.x, MIDDLE, 5)
        drive(0.0, 0.0, 1.5)
        end = pose.find(lambda pose: pose.theta > 1.0 and pose.angular_velocity == 0.0)
        self.assertAlmostEqual(end.theta, 1.5 * 63 * 0.016, 5)

    def hear(self, node, log):
        """Wait until this test is connected to the log of a node: lines are lost until then."""
        def hears():
            node.call('clear')
            return any(line.msg == 'Clearing turtlesim.' for line in log.messages[:])
        wait(self, hears, 'a line of the log')

    def test_the_log_has_the_words_of_turtlesim(self):
        log = Heard(self, '/rosout')
        node = Turtlesim(self)

        def lines():
            return [line.msg for line in log.messages[:] if line.name == '/turtlesim' and line.level == line.INFO]

        self.hear(node, log)
        node.call('reset')
        wanted = ['Clearing turtlesim.', 'Resetting turtlesim.',
                  'Spawning turtle [turtle1] at x=[5.544445], y=[5.544445], theta=[0.000000]']
        wait(self, lambda: lines()[-1] == wanted[-1], 'the log')
        self.assertEqual(lines()[-3:], wanted)

    def test_names_with_slashes(self):
        node = Turtlesim(self)
        for index, (name, topic) in enumerate((('/abs', '/abs'), ('a/', '/a'), ('b//c', '/b/c'))):
            self.assertEqual(node.call('spawn', 2.0 + index, 3.0, 1.0, name).name, name)
            self.assertEqual(Heard(self, f'{topic}/pose').find().x, 2.0 + index)
            node.call(f'{topic[1:]}/teleport_absolute', 2.0, 3.0, 1.0)
            node.call('kill', name)
        node.refuses(r'A turtled named \[/turtle1\] already exists', 'spawn', 1.0, 1.0, 0.0, '/turtle1')

    def test_a_reset_frees_the_names_of_many_turtles(self):
        node = Turtlesim(self)
        for _ in range(2):
            names = [node.call('spawn', 2.0, 3.0, 1.0, '').name for _ in range(10)]
            self.assertEqual(names, [f'turtle{number}' for number in range(2, 12)])
            node.call('turtle11/teleport_absolute', 4.0, 5.0, 0.0)
            node.call('reset')

    def test_turtles_are_spawned_and_killed_and_bad_requests_fail(self):
        node = Turtlesim(self)
        log = Heard(self, '/rosout')
        self.assertEqual(node.call('spawn', 2.0, 3.0, 1.0, '').name, 'turtle2')
        self.assertEqual(node.call('spawn', 4.0, 3.0, 1.0, 'bob').name, 'bob')
        pose = Heard(self, '/bob/pose').find()
        self.assertEqual((pose.x, pose.y, pose.theta), (4.0, 3.0, 1.0))
        node.refuses(r'A turtled named \[bob\] already exists', 'spawn', 1.0, 1.0, 0.0, 'bob')
        node.refuses(r"'a b' is not a valid name", 'spawn', 1.0, 1.0, 0.0, 'a b')
        node.refuses(r'spawn new: theta is nan', 'spawn', 1.0, 1.0, float('nan'), 'new')
        node.refuses(r'Tried to kill turtle \[bib\], which does not exist: the turtles are turtle1, turtle2, bob',
                     'kill', 'bib')
        log.find(lambda line: line.level == line.ERROR and line.msg.startswith(
            'Tried to kill turtle [bib], which does not exist'))
        node.call('kill', 'bob')
        published = {topic for topic, _ in rospy.get_published_topics()}
        self.assertTrue({'/turtle1/pose', '/turtle2/pose'} <= published and '/bob/pose' not in published)
        self.assertEqual(node.call('spawn', 7.0, 8.0, 0.0, 'bob').name, 'bob')
        Heard(self, '/bob/pose').find(lambda pose: (pose.x, pose.y) == (7.0, 8.0))

    def test_a_turtle_draws_and_sees_the_colour_of_its_line(self):
        node = Turtlesim(self)
        colour = Heard(self, '/turtle1/color_sensor')
        self.assertEqual(rgb(colour.find()), BACKGROUND)
        node.call('turtle1/set_pen', 200, 10, 20, 5, 0)
        node.call('turtle1/teleport_absolute', 9.0, 2.0, 0.0)
        self.assertEqual(rgb(colour.fresh()), (200, 10, 20))
        node.call('turtle1/set_pen', 1, 2, 3, 5, 1)
        node.call('turtle1/teleport_relative', 2.0, 3.0)
        node.call('kill', 'turtle1')
        picture = node.picture()
        self.assertEqual(picture.size, (500, 500))
        row = 499 - 2 * 45
        self.assertEqual([picture.getpixel((9 * 45, row)), picture.getpixel((9 * 45, 2 * 45))],
                         [(200, 10, 20), BACKGROUND])
        halfway = round(45 * (9.0 + MIDDLE) / 2), round(499 - 45 * (2.0 + MIDDLE) / 2)
        self.assertEqual(picture.getpixel(halfway), (200, 10, 20))
        self.assertEqual(set(picture.getdata()), {BACKGROUND, (200, 10, 20)})

    def test_clear_and_reset_read_the_background_again(self):
        node = Turtlesim(self, '_background_r:=1', '_background_g:=2')
        self.assertEqual(rospy.get_param('/turtlesim/background_r'), 1)
        node.call('spawn', 1.0, 1.0, 0.0, 'bob')
        node.call('turtle1/teleport_absolute', 9.0, 2.0, 0.0)
        self.assertEqual(node.picture().getpixel((0, 0)), (1, 2, 255))
        pose = Heard(self, '/turtle1/pose')
        rospy.set_param('/turtlesim/background_r', 300)
        rospy.set_param('/turtlesim/background_g', 'green')
        node.call('clear')
        self.assertEqual(node.picture().getpixel((0, 0)), (44, 86, 255))
        self.assertAlmostEqual(pose.fresh().x, 9.0)
        rospy.set_param('/turtlesim/background_b', -1.5)
        node.call('reset')
        self.assertEqual(node.picture().getpixel((0, 0)), (44, 86, 254))
        # The subscriber to turtle1 is still connected.
        self.assertAlmostEqual(pose.fresh().x, MIDDLE, 5)
        wait(self, lambda: '/bob/pose' not in {topic for topic, _ in rospy.get_published_topics()}, 'the end of bob')
        node.call('kill', 'turtle1')
        node.call('reset')
        Heard(self, '/turtle1/pose').find()

    def test_a_background_out_of_range_wraps_at_the_start_and_the_parameter_stays(self):
        node = Turtlesim(self, '_background_r:=300', '_background_g:=red')
        self.assertEqual(node.picture().getpixel((0, 0)), (44, 86, 255))
        self.assertEqual(rospy.get_param('/turtlesim/background_r'), 300)

    def test_no_parameter_leads_save_png_to_another_file(self):
        with tempfile.TemporaryDirectory() as home:
            precious = pathlib.Path(home, 'notes.png')
            precious.write_text('precious')
            node = Turtlesim(self, env=without_display(ROS_HOME=home))
            self.assertEqual(node.picture().size, (500, 500))
            for name in (str(precious), '../notes.png'):
                rospy.set_param('/turtlesim/png_name', name)
                answer = node.call('turtlesim/save_png')
                self.assertFalse(answer.success)
                self.assertRegex(answer.message, '^parameter /turtlesim/png_name is .*: must be letters, digits')
            pathlib.Path(home, 'turtlesim', 'notes.png').write_text('precious')
            rospy.set_param('/turtlesim/png_name', 'notes.png')
            answer = node.call('turtlesim/save_png')
            self.assertRegex(answer.message, r'/turtlesim/notes\.png is not a picture')
            rospy.set_param('/turtlesim/png_name', 'other.png')
            self.assertEqual(node.picture().size, (500, 500))
            self.assertEqual([path.name for path in sorted(pathlib.Path(home, 'turtlesim').iterdir())],
                             ['notes.png', 'other.png', 'turtlesim.png'])
            self.assertEqual(precious.read_text(), 'precious')

    def test_nan_and_infinity_are_refused_and_the_turtle_obeys_the_next_command(self):
        node = Turtlesim(self)
        pose, log, drive = Heard(self, '/turtle1/pose'), Heard(self, '/rosout'), commander(self)
        self.hear(node, log)
        before = pose.fresh()
        drive(float('nan'), 0.0, 0.0)
        log.find(lambda line: line.level == line.ERROR and line.msg == (
            'turtle1/cmd_vel: linear.x is nan: must be a finite number; ignored'))
        for command in ((0.0, float('inf'), 0.0), (0.0, 0.0, float('-inf'))):
            drive(*command)
        node.refuses('teleport turtle1: y is nan: ', 'turtle1/teleport_absolute', 1.0, float('nan'), 0.0)
        node.refuses('teleport turtle1: angular is inf: ', 'turtle1/teleport_relative', 1.0, float('inf'))
        self.assertEqual(pose.fresh(), before)
        drive(1.0, 0.0, 0.0)
        pose.find(lambda pose: pose.x > MIDDLE + 0.9)

    def test_a_turtle_stops_at_the_wall_and_the_log_says_so(self):
        Turtlesim(self)
        pose, log = Heard(self, '/turtle1/pose'), Heard(self, '/rosout')
        commander(self)(0.0, -10.0, 0.0)
        line = log.find(lambda line: 'hit the wall' in line.msg)
        self.assertEqual(line.level, line.WARN)
        self.assertRegex(line.msg, r'^Oh no! I hit the wall! \(Clamping from \[x=5\.544445, y=11\.\d{6}\]\)$')
        end = pose.find(lambda pose: pose.y == 0.0 and pose.linear_velocity == 0.0)
        self.assertAlmostEqual(end.x, MIDDLE, 5)
        # 29 steps end at the wall; the log gets a line once a second.
        self.assertLessEqual(len([line for line in log.messages if 'hit the wall' in line.msg]), 2)

    def test_signals_and_rosnode_kill_end_it_with_exit_code_0(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            node = Turtlesim(self)
            pose = Heard(self, '/turtle1/pose')
            pose.find()
            node.end(number)
        node = Turtlesim(self)
        subprocess.run(['rosnode', 'kill', '/turtlesim'], stdout=subprocess.DEVNULL, check=True, timeout=TIMEOUT)
        wait(self, lambda: node.process.poll() == 0, 'the end')


if __name__ == '__main__':
    rospy.init_node('test_turtlesim_node')
    rostest.rosrun('turtlesim', 'turtlesim_node', TurtlesimNodeTest)
