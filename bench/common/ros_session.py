"""A roscore of its own on a free port, and nodes that are measured from outside."""

import contextlib
import os
import pathlib
import signal
import subprocess
import sys
import time

import rosgraph
import rospy
from common import checkouts, figures
from common.ports import free_port

from rumba_msg.msg import SimulatorState

PATIENCE = 60.0  # [s] for what should take a second or two
LISTENER = pathlib.Path(__file__).with_name('listener.py')


@contextlib.contextmanager
def process(command, stdout=subprocess.DEVNULL):
    """A process that runs as long as the block; its output is discarded unless `stdout` says otherwise."""
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
    # What a shell runs in its background would ignore SIGINT, and so would all that it starts.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    port = free_port()
    os.environ.pop('ROS_IP', None)
    os.environ.update(ROS_MASTER_URI=f'http://localhost:{port}', ROS_HOSTNAME='localhost')
    with process(['roscore', '-p', str(port)]):
        wait_until(lambda: rosgraph.is_master_online() and rosgraph.Master('/bench').hasParam('/run_id'))
        rospy.init_node('bench', disable_signals=True, disable_rostime=True, disable_rosout=True)
        yield


def wait_until(condition, patience=PATIENCE):
    """Wait until a function returns something true, for some seconds at most, and return that.

    Raises:
        TimeoutError: it never does.
    """
    deadline = time.monotonic() + patience
    while True:
        found = condition()
        if found:
            return found
        if time.monotonic() > deadline:
            raise TimeoutError(f'waited {patience:g} s')
        time.sleep(0.002)


class Node:
    """The simulator as a process of its own."""

    def __init__(self, pid):
        """Watch a process that was started."""
        self.pid = pid
        self._states = []
        self._subscriber = rospy.Subscriber('/simulator/state', SimulatorState, self._states.append)
        self._next_state()

    def close(self):
        """Stop watching."""
        self._subscriber.unregister()

    def _next_state(self):
        """Wait for the next state, which comes at least once a second.

        Returns:
            tuple of the wall clock [s], the CPU time of the node [s], and the simulated time [s].
        """
        known = len(self._states)
        wait_until(lambda: len(self._states) > known)
        state = self._states[-1]
        return time.monotonic(), figures.cpu_seconds(self.pid), state.tick / state.step_rate

    def watch(self, seconds):
        """Watch for so many seconds; returns seconds of simulated, wall and CPU time."""
        from_wall, from_cpu, from_simulated = wall, cpu, simulated = self._next_state()
        while wall < from_wall + seconds:
            wall, cpu, simulated = self._next_state()
        return simulated - from_simulated, wall - from_wall, cpu - from_cpu

    def simulated(self):
        """The simulated time that the next state tells [s]."""
        return self._next_state()[2]

    @property
    def resident(self):
        """Its memory [MB]."""
        return figures.resident_megabytes(self.pid)


def command(checkout=None, **parameters):
    """The command that starts the simulator, of another checkout unless that is None."""
    return checkouts.command(checkout, ['rosrun', 'rumba_sim', 'simulator', *(
        f'_{name}:={value}' for name, value in parameters.items())])


@contextlib.contextmanager
def fresh_parameters():
    """Delete what the nodes of the block leave on the parameter server."""
    yield
    server = rosgraph.Master('/bench')
    for name in ('/simulator', '/use_sim_time'):
        if server.hasParam(name):
            server.deleteParam(name)


@contextlib.contextmanager
def simulator(checkout=None, **parameters):
    """A simulator that runs as long as the block, of another checkout unless that is None."""
    with fresh_parameters(), process(command(checkout, **parameters)) as started:
        node = Node(started.pid)
        try:
            yield node
        finally:
            node.close()


@contextlib.contextmanager
def listener():
    """Subscribe to every topic in one more process; yields a dictionary that is filled at the end of the block.

    It holds, by topic, how many messages arrived and how many were sent.
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
