"""safe_drive lets a Create dock by itself, stops it meanwhile, and moves its brushes."""

import rospy
from create_msgs.msg import ChargingState, Mode, MotorSetpoint
from fakes import SafeDriveRun
from geometry_msgs.msg import Twist, Vector3
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import LaserScan
from simulators import wait, wait_for_service
from std_msgs.msg import Empty, Header, UInt16
from std_srvs.srv import SetBool

from rumba_msg.msg import DockStatus

DT = 0.05  # [s] from one message of the robot to the next
WITHIN = 0.5  # [s] of the robot's time, in which it must be stopped
SILENT = 3.0  # [s] of it, more than a second of the wall clock longer than that, in which brushes must stand
AHEAD = Twist(Vector3(0.2, 0.0, 0.0), Vector3())
MOTORS = 'main_brush_motor', 'side_brush_motor', 'vacuum_motor'


class SafeDriveCreateTest(SafeDriveRun):
    """The driver is this test, and so is its time."""

    def setUp(self):
        self.start('_create:=/create', '_docked:=false', 'rumba/odom:=/create/odom',
                   'rumba/safe_cmd_vel:=/create/cmd_vel')
        self.now, self.told, self.statuses, self.mode, self.state = rospy.Time(100), [], [], Mode.MODE_FULL, 0
        self.clock = self.publisher('/clock', Clock)
        self.talkers = {name: self.publisher(topic, kind) for name, topic, kind in (
            ('scan', 'rumba/scan', LaserScan), ('odometry', '/create/odom', Odometry),
            ('drive', 'rumba/cmd_vel', Twist), ('seek', 'rumba/seek_dock', Empty), ('mode', '/create/mode', Mode),
            ('charger', '/create/battery/charging_state', ChargingState), ('beams', '/create/ir_omni', UInt16))}
        listeners = [rospy.Subscriber(f'/create/{topic}', kind, self._note, topic) for topic, kind in (
            ('dock', Empty), ('undock', Empty), ('cmd_vel', Twist), *((motor, MotorSetpoint) for motor in MOTORS))]
        listeners.append(rospy.Subscriber('rumba/dock_status', DockStatus, self.statuses.append))
        for each in listeners:
            self.addCleanup(each.unregister)
        wait(self, lambda: all(each.get_num_connections() for each in [*self.talkers.values(), *listeners])
             and self.clock.get_num_connections() > 1, 'safe_drive')
        wait_for_service(self, 'rumba/stop')

    def _note(self, message, topic):
        """Do what the driver is told, as a Create does."""
        if topic in ('dock', 'undock'):
            self.mode = Mode.MODE_PASSIVE if topic == 'dock' else Mode.MODE_FULL
        if topic != 'cmd_vel' or message.linear.x:
            self.told.append((topic, getattr(message, 'duty_cycle', None)))

    def _tick(self, talker=None):
        """Pass DT, in which the driver and the laser talk, and perhaps the cleaner, until safe_drive has heard it."""
        self.now += rospy.Duration(DT)
        self.clock.publish(self.now)
        wait(self, lambda: rospy.Time.now() >= self.now, 'the clock')
        odometry = Odometry(header=Header(stamp=self.now))
        odometry.pose.pose.orientation.w = 1.0
        count = len(self.statuses)
        for name, message in (('mode', Mode(mode=self.mode)), ('charger', ChargingState(state=self.state)),
                              ('beams', UInt16(172)), ('scan', LaserScan())):
            self.talkers[name].publish(message)
        if talker is not None:
            self.talkers[talker].publish(AHEAD if talker == 'drive' else Empty())
        wait(self, lambda: self.talkers['odometry'].publish(odometry) or len(self.statuses) > count, 'dock_status',
             0.02)
        rospy.rostime.wallsleep(0.05)  # more than a look of safe_drive

    def _until(self, told, talker=None, most=WITHIN):
        """Pass time until the driver is told something."""
        for _ in range(round(most / DT)):
            if told in self.told:
                return
            self._tick(talker)
        self.assertIn(told, self.told)

    def _seek(self):
        self._until(('dock', None), 'seek', 5.0)
        self.told.clear()

    def _charge(self):
        self._seek()
        self.state = ChargingState.CHARGE_FULL
        for _ in range(3):
            self._tick('seek')

    def test_it_has_the_robot_dock_and_commands_nothing_meanwhile(self):
        self._seek()
        for _ in range(10):
            self._tick('seek')
        self.assertEqual(self.told, [])

    def test_a_robot_that_docks_by_itself_is_stopped_when_the_cleaner_falls_silent(self):
        self._seek()
        self._until(('undock', None))

    def test_the_service_stop_stops_it_too(self):
        self._seek()
        self.assertEqual(rospy.ServiceProxy('rumba/stop', SetBool)(True).message, 'stopped')
        self._until(('undock', None), 'seek', DT)

    def test_it_is_stopped_when_safe_drive_ends(self):
        self._seek()
        self._tick('seek')
        self.end()
        wait(self, lambda: ('undock', None) in self.told, 'a stop')

    def test_a_robot_that_charges_is_left_alone_until_it_is_to_drive(self):
        self._charge()
        for talker in [None] * 12 + ['seek'] * 3:
            self._tick(talker)
        self.assertEqual(self.told, [])
        self._until(('undock', None), 'drive')
        self.state = ChargingState.CHARGE_NONE
        self._until(('cmd_vel', None), 'drive')

    def test_it_says_whether_the_robot_is_docked_and_which_beams_it_gets(self):
        self._tick()
        self.assertEqual([self.statuses[-1].is_docked, self.statuses[-1].infrared_omni], [False, 12])
        self._charge()
        self.assertEqual([self.statuses[-1].is_docked, self.statuses[-1].dock_visible], [True, True])

    def test_brushes_turn_while_the_cleaner_drives_and_stand_if_it_falls_silent(self):
        wait_for_service(self, 'rumba/set_brushes_up')
        move = rospy.ServiceProxy('rumba/set_brushes_up', SetBool)
        move(False)
        self._until((MOTORS[2], 1.0), 'drive', 5.0)
        self.assertEqual(sorted(topic for topic, duty in self.told if duty == 1.0), sorted(MOTORS))
        self._until((MOTORS[2], 0.0), most=SILENT)
        self.told.clear()
        self._until((MOTORS[0], 1.0), 'drive')
        move(True)
        self._until((MOTORS[0], 0.0), 'drive')
