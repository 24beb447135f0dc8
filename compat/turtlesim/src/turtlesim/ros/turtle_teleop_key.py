"""turtle_teleop_key: drives turtle1 with the arrow keys of the terminal that it runs in; q quits.

A key moves the turtle for one second, or until the next key: hold a key to keep driving.

Publishes:
  turtle1/cmd_vel    geometry_msgs/Twist, one for each key

Parameters of the namespace of the node, as in `rosparam set scale_linear 1`:
  scale_linear       speed of a key [m/s]; default 2
  scale_angular      turn rate of a key [rad/s]; default 2
"""

import contextlib
import os
import re
import select
import sys
import termios
import tty
from typing import Iterator, List

import rospy
from geometry_msgs.msg import Twist, Vector3

from turtlesim.model.errors import TurtlesimError
from turtlesim.ros import node

HELP = """\
Arrow keys drive {topic}: up forward, down backward, left and right turn.
q quits."""
SCALES: node.Parameters = {  # not private, as in turtlesim
    'scale_linear': node.number(2.0, -1000.0, 1000.0, 'speed of a key [m/s]'),
    'scale_angular': node.number(2.0, -1000.0, 1000.0, 'turn rate of a key [rad/s]'),
}
# The last character that a terminal sends for an arrow key, in both of its modes: shares of speed and turn rate.
MOVES = {'A': (1.0, 0.0), 'B': (-1.0, 0.0), 'C': (0.0, -1.0), 'D': (0.0, 1.0)}
KEY = re.compile(r'\x1b[\[O][A-D]|.', re.DOTALL)
QUIT = ('q', 'Q', '\x04')  # the last one: Ctrl-D, and also what `next_keys` returns if the terminal is gone
POLL = 0.1  # [s] between two checks for a shutdown of ROS


def main() -> None:
    """Run the node."""
    node.run('teleop_turtle', {}, drive)


def drive() -> None:
    """Drive by keys until q is pressed or ROS shuts down.

    Raises:
        TurtlesimError: the standard input is not a terminal.
    """
    if not sys.stdin.isatty():
        raise TurtlesimError('the standard input is not a terminal: start this node with rosrun')
    speed, turn_rate = node.read(SCALES, *SCALES, prefix='')
    publisher = rospy.Publisher('turtle1/cmd_vel', Twist, queue_size=10)
    print(HELP.format(topic=publisher.resolved_name), flush=True)
    with single_keys():
        while not rospy.is_shutdown():
            for key in next_keys():
                if key in QUIT:
                    return
                if len(key) > 1:
                    forward, turn = MOVES[key[-1]]
                    publisher.publish(Twist(Vector3(forward * speed, 0.0, 0.0), Vector3(0.0, 0.0, turn * turn_rate)))


@contextlib.contextmanager
def single_keys() -> Iterator[None]:
    """Make the terminal deliver each key at once and show none; restore its settings at the end."""
    found = termios.tcgetattr(sys.stdin)
    tty.setcbreak(sys.stdin)
    try:
        yield
    finally:
        with contextlib.suppress(termios.error):  # the terminal is gone
            # TCSAFLUSH discards keys that are not read yet: they are for the turtle, not for the shell.
            termios.tcsetattr(sys.stdin, termios.TCSAFLUSH, found)


def next_keys() -> List[str]:
    """Return the keys typed since the last call; if there are none, wait up to POLL for one."""
    if not select.select([sys.stdin], [], [], POLL)[0]:
        return []
    try:
        text = os.read(sys.stdin.fileno(), 1000).decode('latin-1')
    except OSError:
        text = ''
    return KEY.findall(text or '\x04')
