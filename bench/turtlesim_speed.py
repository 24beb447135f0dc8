"""What share of a core the stand-in for turtlesim takes, beside the figures of the original.

The original always has its window; its figures were measured with Qt's offscreen platform. The stand-in is measured
without a window, as on a machine without a display, and with a window on that platform.
"""

import contextlib
import pathlib
import subprocess
import sys
import time

import rospy
from common import figures, ros_session

from turtlesim.msg import Pose
from turtlesim.srv import Spawn

SECONDS = 10.0  # of a measurement of CPU time
LISTEN = 4.0  # [s] of a measurement of the rate
RATE = 62.5  # [Hz] promised; at each end of the measurement one message is uncertain
DRIVER = pathlib.Path(__file__).parent / 'common' / 'turtle_driver.py'
# Share of a core [%] by number of turtles: idle, one driven at 10 Hz, all driven at 10 Hz; nobody listens.
ORIGINAL = {1: (1.3, 5.1, 5.3), 10: (1.6, 6.1, 9.3), 50: (2.6, 8.6, 23.9), 100: (4.0, 12.1, 43.0),
            200: (7.3, 20.9, 82.0)}
NO_WINDOW, WINDOW = ['_gui:=false'], ['_gui:=true', '-platform', 'offscreen']
CASES = [('no window', NO_WINDOW, list(ORIGINAL)), ('its window on the offscreen platform', WINDOW, [1, 50, 200])]


def main():
    """Print the figures, with those of the original as their bounds."""
    with ros_session.master():
        for title, arguments, numbers in CASES:
            for turtles in numbers:
                figures.heading(f'turtlesim, {turtles} turtle{"s" if turtles > 1 else ""}, {title}')
                with ros_session.process(['rosrun', 'turtlesim', 'turtlesim_node', *arguments]) as started:
                    measure(started.pid, populate(turtles), ORIGINAL[turtles])


def populate(turtles):
    """Add turtles on a grid until there are `turtles` of them; returns their names."""
    rospy.wait_for_service('/spawn', ros_session.PATIENCE)
    spawn = rospy.ServiceProxy('/spawn', Spawn, persistent=True)
    names = ['/turtle1', *('/' + spawn(2.0 + number % 16 * 0.4, 1.0 + number // 16 * 0.4, 0.0, '').name
                           for number in range(turtles - 1))]
    spawn.close()
    return names


def measure(pid, names, bounds):
    """Print the share of a core that a node with turtles of these names takes, and its rate."""
    for what, driven, bound in zip(('nobody driven', 'one driven at 10 Hz', 'all driven at 10 Hz'),
                                   ([], names[:1], names), bounds):
        with driver(driven):
            figures.row(f'{what}: share of a core [%]', share(pid), below=bound)
            figures.row('  rate of pose [Hz]', rate(names[-1]), at_least=RATE - 2.0 / LISTEN)


@contextlib.contextmanager
def driver(names):
    """Drive turtles as long as the block."""
    if not names:
        yield
        return
    with ros_session.process([sys.executable, str(DRIVER), *names], stdout=subprocess.PIPE) as started:
        assert started.stdout.readline() == b'driving\n'
        yield


def share(pid):
    """Share of a core [%]."""
    begin, from_cpu = time.monotonic(), figures.cpu_seconds(pid)
    time.sleep(SECONDS)
    return 100.0 * (figures.cpu_seconds(pid) - from_cpu) / (time.monotonic() - begin)


def rate(name):
    """Poses of a turtle in a second, for one listener."""
    times = []
    subscriber = rospy.Subscriber(f'{name}/pose', Pose, lambda _: times.append(time.monotonic()))
    ros_session.wait_until(lambda: times and times[-1] - times[0] > LISTEN)
    subscriber.unregister()
    return (len(times) - 1) / (times[-1] - times[0])


if __name__ == '__main__':
    main()
