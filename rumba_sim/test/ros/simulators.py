"""What the tests of the simulator share: a simulator, started as by a user, its messages and its services."""

import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest
import uuid

import programs
import rosgraph
import rospy
from geometry_msgs.msg import Pose2D, Twist
from nav_msgs.msg import OccupancyGrid, Odometry
from nav_msgs.srv import GetMap
from ports import free_port
from rosgraph_msgs.msg import Clock, Log
from sensor_msgs.msg import BatteryState, LaserScan
from std_srvs.srv import SetBool, Trigger

from rumba_msg.msg import BatteryStatus, Bumper, CleaningStatus, Cliff, DockStatus, SimulatorState
from rumba_msg.srv import AddObstacle, Kill, RemoveObstacle, Spawn, Step, Teleport
from rumba_sim.ros.running import publisher_updates

TIMEOUT = 90.0  # [s] of the wall clock: on a busy machine, a mission takes half a minute as fast as it can
LOOK_PERIOD = 0.04  # [s] between two questions to a master
STEP_RATE = 50  # the simulator's default [Hz]
TICK = 1_000_000_000 // STEP_RATE  # [ns]
ENDS_WITHIN = 30.0  # [s]: a deadlock lasts longer, a busy machine does not
ROOM = {  # an empty room of 2 m, 40 x 40 cells
    'room.yaml': b'image: room.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\n'
                 b'free_thresh: 0.196\n',
    'room.pgm': b'P5 40 40 255\n' + 1600 * b'\xff'}
TOPICS = {
    'battery_status': BatteryStatus, 'battery_state': BatteryState, 'odom': Odometry, 'ground_truth': Odometry,
    'scan': LaserScan, 'bumper': Bumper, 'cliff': Cliff, 'dock_status': DockStatus, 'cleaning_status': CleaningStatus,
    'coverage': OccupancyGrid, 'clock': Clock, 'map': OccupancyGrid, 'rosout': Log, 'state': SimulatorState}
SERVICES = {
    'pause': Trigger, 'resume': Trigger, 'reset': Trigger, 'digest': Trigger, 'step': Step, 'spawn': Spawn,
    'kill': Kill, 'add_obstacle': AddObstacle, 'remove_obstacle': RemoveObstacle, 'set_brushes_up': SetBool,
    'teleport': Teleport, 'static_map': GetMap}

publisher_updates.use()  # what a test subscribes to must be heard on a busy machine too


def wait(test, condition, what='it', period=0.005):
    """Wait until a condition holds; returns what it returned. `period` [s] is long if to look takes long."""
    end = time.monotonic() + TIMEOUT
    while True:
        result = condition()
        if result:
            return result
        test.assertLess(time.monotonic(), end, f'waited in vain for {what}')
        time.sleep(period)


def lookup(service, master=None):
    """URI of a service at the master; None if there is none."""
    try:
        return rosgraph.Master('/test', master_uri=master).lookupService(service)
    except (rosgraph.MasterException, OSError):
        return None


def wait_for_service(test, service, process=None, master=None):
    """Wait until a service is registered; a process that shall register it must not end."""
    wait(test, lambda: process is not None and process.poll() is not None or lookup(service, master), service,
         LOOK_PERIOD)
    if process is not None:
        test.assertIsNone(process.poll(), f'what shall serve {service} ended')


def folder_of(test, contents):
    """A new folder with files, given by name and content, until the end of a test; returns its path."""
    folder = tempfile.TemporaryDirectory()
    test.addCleanup(folder.cleanup)
    path = pathlib.Path(folder.name).resolve()
    for name, content in contents.items():
        (path / name).write_bytes(content)
    return path


def shared(test_class):
    """A test whose cleanups are those of a whole class of tests."""
    test = unittest.TestCase()
    test.addCleanup = test_class.addClassCleanup
    return test


class Master:
    """A separate master, which does not run yet, and may be killed and started again at the same port."""

    def __init__(self, test):
        self._test = test
        self._port = free_port()
        self.uri = f'http://localhost:{self._port}'
        self.environment = {**os.environ, 'ROS_MASTER_URI': self.uri}
        self.api = rosgraph.Master('/test', master_uri=self.uri)

    def start(self):
        """Start it, and wait until it is there; returns itself. Roscore takes several times as long."""
        self._process = subprocess.Popen(['rosmaster', '--core', '-p', str(self._port)], stdout=subprocess.DEVNULL)
        self._test.addCleanup(self._process.wait)
        self._test.addCleanup(self._process.kill)
        wait(self._test, self.api.is_online, 'the master', LOOK_PERIOD)
        self.api.setParam('/run_id', str(uuid.uuid4()))  # as roscore does: some nodes wait for it
        return self

    def restart(self):
        """Kill it, so that it forgets everything, and start it again."""
        self._process.kill()
        self._process.wait(TIMEOUT)
        self.start()

    def wait_for(self, service):
        """Wait until a service is registered."""
        wait_for_service(self._test, service, master=self.uri)


def forget_parameters(node='/simulator'):
    """Delete the parameters that an earlier node of this name left at the master."""
    if rospy.has_param(node):
        rospy.delete_param(node)


class Heard:
    """The messages of a topic since the publisher is connected; it is waited for, unless it starts only later."""

    def __init__(self, test, topic, message=None, waits=True):
        self._test = test
        self._topic = topic
        self.messages = []
        subscriber = rospy.Subscriber(topic, message or TOPICS[topic.split('/')[-1]], self.messages.append)
        test.addCleanup(subscriber.unregister)
        if waits:
            wait(test, subscriber.get_num_connections, f'a publisher of {topic}')

    def find(self, condition=lambda message: True):
        """The first message that meets a condition."""
        return wait(self._test, lambda: next(filter(condition, self.messages[:]), None), f'a message on {self._topic}')

    def fresh(self, condition=lambda message: True):
        """The first such message from now on."""
        self.messages.clear()
        return self.find(condition)

    def last(self, condition):
        """Wait until the newest message meets a condition; returns it."""
        return wait(self._test, lambda: next(filter(condition, self.messages[-1:]), None), f'the end on {self._topic}')

    def at(self, ticks):
        """The message of a tick of simulated time."""
        return self.find(lambda message: message.header.stamp.to_nsec() == ticks * TICK)


def stands_still(clock):
    """Whether the last two messages of /clock have the same time; more may arrive meanwhile."""
    last = clock.messages[-2:]
    return len(last) == 2 and last[0] == last[1]


class Simulator:
    """A simulator for one test; after a pause in simulated time, `ticks` is the number of ticks that have passed."""

    def __init__(self, test, *arguments, node='/simulator', master=None, environment=None, forget=True, folder=None):
        self._test = test
        self._node = node
        self.ticks = None
        if forget:
            forget_parameters(node)
        self.process = programs.start('rumba_sim', 'simulator', *arguments, env=environment, cwd=folder)
        test.addCleanup(self.end)
        wait_for_service(test, f'{node}/tuning/set_parameters', self.process, master)

    def call(self, service, *arguments):
        """The answer of a service, given by its name below that of the simulator, or with a robot: `rumba/teleport`."""
        kind = SERVICES[service.split('/')[-1]]
        name = '/' + service if '/' in service or service == 'static_map' else f'{self._node}/{service}'
        return rospy.ServiceProxy(name, kind)(*arguments)

    def does(self, service, *arguments):
        """Call a service that must succeed; returns the answer."""
        answer = self.call(service, *arguments)
        self._test.assertTrue(answer.success, answer.message)
        return answer

    def refuses(self, pattern, service, *arguments):
        """Call a service that must fail with a message that matches a pattern."""
        answer = self.call(service, *arguments)
        self._test.assertFalse(answer.success)
        self._test.assertRegex(answer.message, pattern)

    def digest(self):
        """The digest of the world and its tick."""
        digest, tick = self.does('digest').message.split()
        return digest, int(tick)

    def teleport(self, x, y, theta, robot='rumba'):
        """Teleport a robot."""
        self.does(f'{robot}/teleport', Pose2D(x, y, theta))

    def pause(self):
        """Pause, and find the number of the tick."""
        self.does('pause')
        clock = Heard(self._test, '/clock')
        wait(self._test, lambda: stands_still(clock), 'the pause')
        self.ticks, rest = divmod(clock.messages[-1].clock.to_nsec(), TICK)
        self._test.assertEqual(rest, 0)

    def step(self, ticks=1):
        """Simulate ticks, after a pause."""
        self.does('step', ticks)
        self.ticks += ticks

    def drive(self, v, w, truth):
        """Reset, command the robot, and simulate one tick; needs a pause, and ground_truth at the step rate.

        A topic has no answer: this is repeated until the command arrives before the tick. One that comes late is waited
        for, or it would count as a second one.
        """
        commands = Commands(self._test)
        is_late = True
        while is_late:
            self.does('reset')
            commands.send(v, w)
            self.step()
            is_late = not self._moves(truth)
            while not self._moves(truth):
                self.step()

    def _moves(self, truth):
        """Whether the robot moved in the last tick."""
        twist = truth.at(self.ticks).twist.twist
        return bool(twist.linear.x or twist.angular.z)

    def end(self, number=signal.SIGTERM):
        """End it; it must end in time and without an error."""
        if self.process.returncode is None:
            begin = time.monotonic()
            self.process.send_signal(number)
            try:
                self._test.assertEqual(self.process.wait(TIMEOUT), 0)
                self._test.assertLess(time.monotonic() - begin, ENDS_WITHIN)
            finally:
                self.process.kill()
                self.process.wait()

    def kill(self):
        """Kill it, and have the master forget its last service, so that waiting for the next simulator makes sense."""
        self.process.kill()
        self.process.wait(TIMEOUT)
        service = f'{self._node}/tuning/set_parameters'
        rosgraph.Master(self._node).unregisterService(service, lookup(service))


class Commands:
    """A publisher of velocities to which a robot listens."""

    def __init__(self, test, robot='rumba', topic='cmd_vel'):
        self._publisher = rospy.Publisher(f'/{robot}/{topic}', Twist, queue_size=1000)
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
