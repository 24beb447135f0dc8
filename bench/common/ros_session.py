"""A roscore of its own on a free port, and nodes that are measured from outside."""

import contextlib
import os
import pathlib
import signal
import socket
import subprocess
import sys
import time

import rosgraph
import rospy
from common import figures
from diagnostic_msgs.msg import DiagnosticArray

PATIENCE = 60.0  # [s] for what should take a second or two
LISTENER = pathlib.Path(__file__).with_name('listener.py')
SPEED = 'speed [times real time]'  # what the simulator calls it in /diagnostics


@contextlib.contextmanager
def process(command, stdout=subprocess.DEVNULL):
    """A process that runs as long as the block; its output is thrown away, unless it goes elsewhere."""
    started = subprocess.Popen(command, stdout=stdout, stderr=subprocess.DEVNULL, start_new_session=True)
    try:
        yield started
    finally:
        started.send_signal(signal.SIGINT)
        try:
            started.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            os.killpg(started.pid, signal.SIGKILL)
            started.wait()


@contextlib.contextmanager
def master():
    """A roscore for this process, which becomes a node of it, and for those that it starts."""
    with socket.socket() as free:
        free.bind(('localhost', 0))
        port = free.getsockname()[1]
    os.environ.pop('ROS_IP', None)
    os.environ.update(ROS_MASTER_URI=f'http://localhost:{port}', ROS_HOSTNAME='localhost')
    with process(['roscore', '-p', str(port)]):
        wait_until(lambda: rosgraph.is_master_online() and rosgraph.Master('/bench').hasParam('/run_id'))
        rospy.init_node('bench', disable_signals=True, disable_rostime=True, disable_rosout=True)
        yield


def wait_until(condition):
    """Wait until a function returns something true, and return that.

    Raises:
        TimeoutError: it does not.
    """
    deadline = time.monotonic() + PATIENCE
    while True:
        found = condition()
        if found:
            return found
        if time.monotonic() > deadline:
            raise TimeoutError(f'waited {PATIENCE:g} s')
        time.sleep(0.002)


class Node:
    """The simulator as a process of its own."""

    def __init__(self, pid):
        """Look at a process that was started."""
        self.pid = pid
        self._speeds = []
        self._subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, self._on_diagnostics)
        self._next_speed()

    def close(self):
        """Look no longer."""
        self._subscriber.unregister()

    def _on_diagnostics(self, message):
        self._speeds += [float(pair.value) for status in message.status for pair in status.values if pair.key == SPEED]

    def _next_speed(self):
        """Wait until the simulator tells its speed, which it does once a second; returns what is known then.

        Returns:
            tuple of the time [s], the CPU time of the node [s], and how many speeds were told.
        """
        known = len(self._speeds)
        wait_until(lambda: len(self._speeds) > known)
        return time.monotonic(), figures.cpu_seconds(self.pid), len(self._speeds)

    def watch(self, seconds):
        """Look on for so long; returns seconds of simulated, wall and CPU time."""
        from_time, from_cpu, first = self._next_speed()
        while time.monotonic() < from_time + seconds:
            time_now, cpu_now, last = self._next_speed()
        speeds = self._speeds[first:last]
        wall = time_now - from_time
        return sum(speeds) / len(speeds) * wall, wall, cpu_now - from_cpu

    @property
    def resident(self):
        """Its memory [MB]."""
        return figures.resident_megabytes(self.pid)


def command(**parameters):
    """The command that starts the simulator."""
    return ['rosrun', 'rumba_sim', 'simulator', *(f'_{name}:={value}' for name, value in parameters.items())]


@contextlib.contextmanager
def fresh_parameters():
    """What nodes of the block leave on the parameter server is gone after it."""
    yield
    server = rosgraph.Master('/bench')
    for name in ('/simulator', '/use_sim_time'):
        if server.hasParam(name):
            server.deleteParam(name)


@contextlib.contextmanager
def simulator(**parameters):
    """A simulator that runs, as long as the block."""
    with fresh_parameters(), process(command(**parameters)) as started:
        node = Node(started.pid)
        try:
            yield node
        finally:
            node.close()


@contextlib.contextmanager
def listener():
    """One subscriber to every topic there is, in one further process; yields a function to call after the block.

    It returns by topic how many messages came, and how many were sent meanwhile.
    """
    started = subprocess.Popen([sys.executable, str(LISTENER)], stdout=subprocess.PIPE, universal_newlines=True,
                               start_new_session=True)
    counts = {}
    try:
        assert started.stdout.readline().strip() == 'listening'
        yield counts
    finally:
        started.send_signal(signal.SIGINT)
        for line in started.communicate(timeout=PATIENCE)[0].splitlines():
            topic, came, sent = line.split()
            counts[topic] = int(came), int(sent)
