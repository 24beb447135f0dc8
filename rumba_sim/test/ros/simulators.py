"""What the tests of the simulator share: a simulator as a user starts it, and what it says and is asked."""

import os
import signal
import subprocess
import time

import rosgraph
import rospy
from geometry_msgs.msg import Pose2D, Twist
from nav_msgs.msg import OccupancyGrid, Odometry
from nav_msgs.srv import GetMap
from rosgraph_msgs.msg import Clock, Log
from sensor_msgs.msg import BatteryState, LaserScan
from std_srvs.srv import SetBool, Trigger

from rumba_msg.msg import BatteryStatus, Bumper, CleaningStatus, Cliff, DockStatus
from rumba_msg.srv import Kill, Spawn, Step, Teleport

TIMEOUT = 30.0
STEP_RATE = 50  # the simulator's default [Hz]
TICK = 1_000_000_000 // STEP_RATE  # [ns]
ENDS_WITHIN = 5.0  # [s]: a deadlock lasts longer, a busy machine does not
TOPICS = {
    'battery_status': BatteryStatus, 'battery_state': BatteryState, 'odom': Odometry, 'ground_truth': Odometry,
    'scan': LaserScan, 'bumper': Bumper, 'cliff': Cliff, 'dock_status': DockStatus, 'cleaning_status': CleaningStatus,
    'coverage': OccupancyGrid, 'clock': Clock, 'map': OccupancyGrid, 'rosout': Log}
SERVICES = {
    'pause': Trigger, 'resume': Trigger, 'reset': Trigger, 'step': Step, 'spawn': Spawn, 'kill': Kill,
    'set_brushes_up': SetBool, 'teleport': Teleport, 'static_map': GetMap}


def wait(test, condition, what='it'):
    """Wait until a condition holds; returns what it returned."""
    end = time.monotonic() + TIMEOUT
    while True:
        result = condition()
        if result:
            return result
        test.assertLess(time.monotonic(), end, f'waited in vain for {what}')
        time.sleep(0.005)


def lookup(service, master=None):
    """URI of a service at the master; None where there is none."""
    try:
        return rosgraph.Master('/test', master_uri=master).lookupService(service)
    except (rosgraph.MasterException, OSError):
        return None


class Master:
    """A master of its own that is not there yet."""

    def __init__(self, test):
        self._test = test
        self._port = 11700 + os.getpid() % 1000
        self.uri = f'http://localhost:{self._port}'

    def start(self):
        """Let it be there soon."""
        process = subprocess.Popen(['roscore', '-p', str(self._port)], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, env={**os.environ, 'ROS_MASTER_URI': self.uri})
        self._test.addCleanup(process.wait)
        self._test.addCleanup(process.terminate)

    def wait_for(self, service):
        """Wait until it knows a service."""
        wait(self._test, lambda: lookup(service, self.uri), f'{service} at the new master')


def forget_parameters():
    """Take away what an earlier command line left at the master, as ROS does."""
    if rospy.has_param('/simulator'):
        rospy.delete_param('/simulator')


class Heard:
    """The messages of a topic, from the moment when the publisher is connected."""

    def __init__(self, test, topic, message=None):
        self._test = test
        self._topic = topic
        self.messages = []
        subscriber = rospy.Subscriber(topic, message or TOPICS[topic.split('/')[-1]], self.messages.append)
        test.addCleanup(subscriber.unregister)
        wait(test, subscriber.get_num_connections, f'a publisher of {topic}')

    def find(self, condition=lambda message: True):
        """The first message for which a condition holds."""
        return wait(self._test, lambda: next(filter(condition, self.messages[:]), None), f'a message on {self._topic}')

    def fresh(self, condition=lambda message: True):
        """The first such message that comes from now on."""
        self.messages.clear()
        return self.find(condition)

    def at(self, ticks):
        """The message of a tick of simulated time."""
        return self.find(lambda message: message.header.stamp.to_nsec() == ticks * TICK)


def stands_still(clock):
    """Whether the last two messages of /clock tell the same time: taken at once, while further ones may come."""
    last = clock.messages[-2:]
    return len(last) == 2 and last[0] == last[1]


class Simulator:
    """A simulator for one test; in simulated time its state is that of tick `ticks`, once it is paused."""

    def __init__(self, test, *arguments, master=None, environment=None, forget=True):
        self._test = test
        self.ticks = None
        if forget:
            forget_parameters()
        self.process = subprocess.Popen(['rosrun', 'rumba_sim', 'simulator', *arguments], env=environment)
        test.addCleanup(self.end)
        wait(test, lambda: self.process.poll() is not None or lookup('/simulator/tuning/set_parameters', master),
             'the simulator')
        test.assertIsNone(self.process.poll(), 'the simulator ended')

    def call(self, service, *arguments):
        """The answer of a service, by its name below the simulator or, as `rumba/teleport`, a robot."""
        kind = SERVICES[service.split('/')[-1]]
        name = '/' + service if '/' in service or service == 'static_map' else f'/simulator/{service}'
        return rospy.ServiceProxy(name, kind)(*arguments)

    def does(self, service, *arguments):
        """Call a service that must succeed; returns the answer."""
        answer = self.call(service, *arguments)
        self._test.assertTrue(answer.success, answer.message)
        return answer

    def refuses(self, pattern, service, *arguments):
        """Call a service that must not succeed, and say why."""
        answer = self.call(service, *arguments)
        self._test.assertFalse(answer.success)
        self._test.assertRegex(answer.message, pattern)

    def teleport(self, x, y, theta, robot='rumba'):
        """Put a robot somewhere."""
        self.does(f'{robot}/teleport', Pose2D(x, y, theta))

    def pause(self):
        """Pause, and learn which tick it is."""
        self.does('pause')
        clock = Heard(self._test, '/clock')
        wait(self._test, lambda: stands_still(clock), 'the pause')
        self.ticks, rest = divmod(clock.messages[-1].clock.to_nsec(), TICK)
        self._test.assertEqual(rest, 0)

    def step(self, ticks=1):
        """Let ticks pass, after a pause."""
        self.does('step', ticks)
        self.ticks += ticks

    def drive(self, v, w, truth):
        """Begin anew, one tick after a command from rest; needs a pause, and ground_truth at the step rate.

        A topic has no answer: it is tried until the command was there before the tick.
        """
        commands = Commands(self._test)
        while True:
            commands.send(v, w)
            self.does('reset')
            self.step()
            twist = truth.at(self.ticks).twist.twist
            if twist.linear.x or twist.angular.z:
                return

    def end(self, number=signal.SIGTERM):
        """End it, in time and cleanly."""
        if self.process.returncode is None:
            begin = time.monotonic()
            self.process.send_signal(number)
            try:
                self._test.assertEqual(self.process.wait(TIMEOUT), 0)
                self._test.assertLess(time.monotonic() - begin, ENDS_WITHIN)
            finally:
                self.process.kill()
                self.process.wait()


class Commands:
    """A publisher of cmd_vel with a robot that listens."""

    def __init__(self, test, robot='rumba'):
        self._publisher = rospy.Publisher(f'/{robot}/cmd_vel', Twist, queue_size=1000)
        test.addCleanup(self._publisher.unregister)
        wait(test, self._publisher.get_num_connections, 'the robot to listen')

    def is_heard(self):
        """Whether a robot listens."""
        return self._publisher.get_num_connections() > 0

    def send(self, v, w):
        """Command a velocity [m/s], [rad/s]."""
        twist = Twist()
        twist.linear.x, twist.angular.z = v, w
        self._publisher.publish(twist)
