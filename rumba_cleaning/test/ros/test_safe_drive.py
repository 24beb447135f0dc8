"""safe_drive stops a robot whose topics fall silent, keeps to its limits, and lets a person drive."""

import subprocess

import programs
import rospy
from fakes import REMAPPED, SafeDriveRun
from geometry_msgs.msg import TransformStamped, Twist, Vector3
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import LaserScan
from simulators import ENDS_WITHIN, wait, wait_for_service
from std_msgs.msg import Header
from std_srvs.srv import SetBool
from tf2_msgs.msg import TFMessage

DT = 0.05  # [s] from one message of the robot to the next
WITHIN = 0.5  # [s] of the robot's time, in which it must be stopped


def twist(v, w=0.0):
    """A command."""
    return Twist(Vector3(v, 0.0, 0.0), Vector3(0.0, 0.0, w))


class SafeDriveTest(SafeDriveRun):
    """The robot is this test, and so is its time."""

    def setUp(self):
        self.start(f'_odometry_from_tf:={"tf" in self._testMethodName}', *REMAPPED)
        self.now, self.taken = rospy.Time(100), []
        self.clock = self.publisher('/clock', Clock)
        self.talkers = {'scan': self.publisher('/front/laser', LaserScan),
                        'odometry': self.publisher('/base/odometry', Odometry),
                        'cleaner': self.publisher('rumba/cmd_vel', Twist),
                        'person': self.publisher('rumba/teleop/cmd_vel', Twist)}
        subscriber = rospy.Subscriber('/base/velocity', Twist, self.taken.append)
        self.addCleanup(subscriber.unregister)
        self.turned = 0.0  # [rad] by odometry
        wait(self, lambda: all(each.get_num_connections() for each in self.talkers.values())
             and self.clock.get_num_connections() > 1 and subscriber.get_num_connections(), 'safe_drive')

    def _tick(self, silent=(), command=None, person=None, turn=0.0):
        """Pass DT, in which all but some talk, until safe_drive has heard it."""
        self.now += rospy.Duration(DT)
        self.clock.publish(self.now)
        wait(self, lambda: rospy.Time.now() >= self.now, 'the clock')
        self.turned += turn * DT
        odometry = Odometry(header=Header(stamp=self.now))
        odometry.pose.pose.orientation.w, odometry.pose.pose.orientation.z = 1.0 - self.turned ** 2 / 8, self.turned / 2
        messages = {'scan': LaserScan(), 'odometry': odometry, 'cleaner': command or twist(0.2), 'person': person}
        self.taken.clear()
        for name, talker in self.talkers.items():
            if name not in silent and messages[name] is not None:
                talker.publish(messages[name])
        rospy.rostime.wallsleep(0.05)  # more than a look of safe_drive

    def _drive(self, speed, **ticks):
        """Have it drive until it is commanded a speed."""
        for _ in range(100):
            self._tick(**ticks)
            if self.taken and abs(self.taken[-1].linear.x - speed) < 1e-6:
                return
        self.fail(f'it never drives at {speed}: {self.taken}')

    def _stops_without(self, silent):
        """Whether it stops in time, and no sooner, when one of those who talk falls silent."""
        self._drive(0.2)
        self._tick()
        begin = self.now
        while not (self.taken and self.taken[-1].linear.x == 0.0):
            self._tick(silent=[silent])
            self.assertLessEqual((self.now - begin).to_sec(), WITHIN)
        self.assertGreater((self.now - begin).to_sec(), 0.3)

    def test_it_stops_within_half_a_second_after_the_scan_has_fallen_silent(self):
        self._stops_without('scan')

    def test_it_stops_within_half_a_second_after_the_odometry_has_fallen_silent(self):
        self._stops_without('odometry')

    def test_it_stops_within_half_a_second_after_the_cleaner_has_fallen_silent(self):
        self._stops_without('cleaner')

    def test_a_person_drives_also_without_scan_and_nobody_faster_than_the_robot_may(self):
        self._drive(0.35, command=twist(3.0))
        self._drive(-0.1, person=twist(-0.1), silent=['scan', 'cleaner'])
        self._drive(0.2)
        self._drive(0.0, command=twist(float('nan')))

    def test_the_service_stop_holds_until_it_is_called_again(self):
        wait_for_service(self, 'rumba/stop')
        stop = rospy.ServiceProxy('rumba/stop', SetBool)
        self._drive(0.2)
        self.assertEqual(stop(True).message, 'stopped')
        for _ in range(5):
            self._tick(person=twist(0.1))
            self.assertEqual({each.linear.x for each in self.taken}, {0.0})
        stop(False)
        self._drive(0.2)

    def test_it_stops_if_the_odometry_turns_the_other_way(self):
        for _ in range(40):
            self._tick(command=twist(0.0, 1.0), turn=-1.0)
        self.assertEqual({each.angular.z for each in self.taken}, {0.0})

    def test_at_its_end_it_commands_a_stop(self):
        self._drive(0.2)
        self.taken.clear()
        self.end()
        wait(self, lambda: self.taken and self.taken[-1].linear.x == 0.0, 'a stop')

    def test_it_makes_odometry_of_tf(self):
        came = []
        subscriber = rospy.Subscriber('/base/odometry', Odometry, came.append)
        self.addCleanup(subscriber.unregister)
        tf = self.publisher('/tf', TFMessage)
        wait(self, lambda: tf.get_num_connections() and subscriber.get_num_connections() > 1, 'safe_drive')
        moved = [TransformStamped(header=Header(stamp=rospy.Time(7), frame_id=frame), child_frame_id='chassis')
                 for frame in ('other', 'wheels')]
        for each in moved:
            each.transform.translation.y, each.transform.rotation.z, each.transform.rotation.w = 0.25, 0.6, 0.8
        wait(self, lambda: tf.publish(moved) or came, 'an odometry')
        told = came[0]
        self.assertEqual((told.header.stamp, told.header.frame_id, told.child_frame_id),
                         (rospy.Time(7), 'wheels', 'chassis'))
        self.assertEqual((told.pose.pose.position.y, told.pose.pose.orientation.z), (0.25, 0.6))

    def test_it_says_what_it_needs(self):
        done = programs.run('rumba_cleaning', 'safe_drive', '__name:=another', timeout=ENDS_WITHIN,
                            stderr=subprocess.PIPE, universal_newlines=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn('own_robot is not given: must be the path of a YAML file', done.stderr)
