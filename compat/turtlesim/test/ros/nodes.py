"""What the tests of the nodes share: nodes started as a user starts them, their topics and services."""

import os
import signal
import subprocess
import time

import programs
import rosgraph
import rospy
from geometry_msgs.msg import Twist, Vector3
from PIL import Image
from rosgraph_msgs.msg import Clock, Log
from std_srvs.srv import Empty, Trigger

from turtlesim.msg import Color, Pose
from turtlesim.srv import Kill, SetPen, Spawn, TeleportAbsolute, TeleportRelative

TIMEOUT = 30.0
LOOK_PERIOD = 0.04  # [s] between two questions to a master
ENDS_WITHIN = 30.0  # [s]: a deadlock lasts longer, a busy machine does not
TOPICS = {'pose': Pose, 'color_sensor': Color, 'clock': Clock, 'rosout': Log, 'cmd_vel': Twist}
SERVICES = {'clear': Empty, 'reset': Empty, 'spawn': Spawn, 'kill': Kill, 'save_png': Trigger, 'set_pen': SetPen,
            'teleport_absolute': TeleportAbsolute, 'teleport_relative': TeleportRelative}
LIBRARIES = ['geometry_msgs.msg', 'PIL.Image', 'rosgraph', 'rosgraph_msgs.msg', 'roslib.packages', 'std_srvs.srv',
             'turtlesim.msg', 'turtlesim.srv', 'xmlrpc.server']  # of the nodes


def wait(test, condition, what='it', period=0.005):
    """Wait until a condition holds; return its value. `period` [s] is long if to look takes long."""
    end = time.monotonic() + TIMEOUT
    while True:
        result = condition()
        if result:
            return result
        test.assertLess(time.monotonic(), end, f'{what} did not come')
        time.sleep(period)


def is_served(service):
    """Whether the master knows a service."""
    try:
        return bool(rosgraph.Master('/test').lookupService(service))
    except rosgraph.MasterException:
        return False


def forget_parameters(*names):
    """Delete parameters that are there."""
    for name in names:
        if rospy.has_param(name):
            rospy.delete_param(name)


def without_display(**more):
    """Return the environment of this process without a display."""
    kept = {name: value for name, value in os.environ.items()
            if name not in ('DISPLAY', 'WAYLAND_DISPLAY', 'QT_QPA_PLATFORM')}
    return {**kept, **more}


def start(node, *arguments, **options):
    """Start a node, without a display unless an environment is given; `options` are those of Popen."""
    return programs.start('turtlesim', node, *arguments, **{'env': without_display(), **options}, libraries=LIBRARIES)


def run(node, *arguments, **options):
    """Run a node to its end, in the same way; returns it, with what it printed, as subprocess.run does."""
    return programs.run('turtlesim', node, *arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=TIMEOUT,
                        universal_newlines=True, env=without_display(), libraries=LIBRARIES, **options)


class Node:
    """A process that ends with its test."""

    def __init__(self, test, process):
        self._test = test
        self.process = process
        test.addCleanup(self.end)

    def end(self, number=signal.SIGINT):
        """End it; it must end in time and with exit code 0."""
        if self.process.returncode is None:
            begin = time.monotonic()
            self.process.send_signal(number)
            try:
                self._test.assertEqual(self.process.wait(TIMEOUT), 0)
                self._test.assertLess(time.monotonic() - begin, ENDS_WITHIN)
            finally:
                self.process.kill()
                self.process.wait()
        if self.process.stdout is not None:
            self._test.addCleanup(self.process.stdout.close)


class Turtlesim(Node):
    """A turtlesim_node; when it is created, all its services are available."""

    def __init__(self, test, *arguments, name='/turtlesim', **options):
        forget_parameters('/turtlesim')
        super().__init__(test, start('turtlesim_node', *arguments, **options))
        wait(test, lambda: self.process.poll() is not None or is_served(f'{name}/save_png'), 'turtlesim_node',
             LOOK_PERIOD)
        test.assertIsNone(self.process.poll(), 'turtlesim_node ended')

    def call(self, service, *arguments):
        """Call a service and return its answer."""
        return rospy.ServiceProxy(f'/{service}', SERVICES[service.split('/')[-1]])(*arguments)

    def refuses(self, pattern, service, *arguments):
        """Call a service, which must fail with a message that matches the pattern."""
        with self._test.assertRaisesRegex(rospy.ServiceException, f'service cannot process request: {pattern}'):
            self.call(service, *arguments)

    def picture(self):
        """Call save_png and return the picture."""
        answer = self.call('turtlesim/save_png')
        self._test.assertTrue(answer.success, answer.message)
        self._test.assertTrue(answer.message.startswith('saved /'), answer.message)
        return Image.open(answer.message[len('saved '):]).convert('RGB')


class Heard:
    """The messages of a topic, from the moment when the first publisher is connected."""

    def __init__(self, test, topic):
        self._test = test
        self._topic = topic
        self.messages = []
        subscriber = rospy.Subscriber(topic, TOPICS[topic.split('/')[-1]], self.messages.append)
        test.addCleanup(subscriber.unregister)
        wait(test, subscriber.get_num_connections, f'a publisher of {topic}')

    def find(self, condition=lambda message: True):
        """Return the first message for which a condition holds."""
        return wait(self._test, lambda: next(filter(condition, self.messages[:]), None), f'a message on {self._topic}')

    def fresh(self, condition=lambda message: True):
        """Return the first such message that was sent after this call; one may be on its way already."""
        self.messages.clear()
        self.find()
        self.messages.clear()
        return self.find(condition)


def commander(test, turtle='turtle1'):
    """Return a function that drives a turtle: forward, to the left [m/s], counter-clockwise [rad/s]."""
    publisher = rospy.Publisher(f'/{turtle}/cmd_vel', Twist, queue_size=100)
    test.addCleanup(publisher.unregister)
    wait(test, publisher.get_num_connections, f'{turtle} to listen')
    return lambda forward, left, turn: publisher.publish(Twist(Vector3(forward, left, 0.0), Vector3(0.0, 0.0, turn)))
