"""teleop_key: drives a Rumba from the keyboard of the terminal that it runs in.

A key counts for ~hold seconds of wall time; who holds it drives on, who lets go stops. Then the topic falls silent,
so that another node can drive.

Publishes:
  rumba/cmd_vel            geometry_msgs/Twist, at ~rate while a key counts, then zero a few times

Subscribes:
  rumba/battery_status     rumba_msg/BatteryStatus, for whether the brushes are up

Calls:
  rumba/set_brushes_up     std_srvs/SetBool, true lifts them

Parameters, as in `rosrun rumba_sim teleop_key _linear:=0.3 _angular:=1.5`:
"""

import dataclasses
import math
import queue
import signal
import threading
import time
from typing import Optional, Tuple

import rospy
from geometry_msgs.msg import Twist
from std_srvs.srv import SetBool

from rumba_msg.msg import BatteryStatus
from rumba_sim.model.config import setting
from rumba_sim.model.robot_config import DriveConfig
from rumba_sim.ros.common import node
from rumba_sim.ros.common.terminal import CTRL_C, CTRL_D, ESCAPE, Terminal

HELP = """\
Hold a key to drive {topic}; let go, and the robot stops.

    u   i   o      forward:   to the left, straight, to the right
    j   k   l      turn left, stop, turn right
    m   ,   .      backward:  to the left, straight, to the right

  arrow keys       forward, backward, turn left, turn right
  space, k         stop, as does every key that is not named here

    q   w   e      10 % faster:  both speeds, driving only, turning only
    z   x   c      10 % slower:  both speeds, driving only, turning only

    b              brushes up or down
  ?, h             show these keys again
  Esc              leave; Ctrl-C and Ctrl-D do so too
"""

# Shares of the linear and of the angular speed, and what a person calls that: m goes back along the arc that u came on.
FORWARD, BACKWARD = (1, 0, 'forward'), (-1, 0, 'backward')
LEFT, RIGHT, STOP = (0, 1, 'turn left'), (0, -1, 'turn right'), (0, 0, 'stop')
MOVES = {
    'u': (1, 1, 'forward left'), 'i': FORWARD, 'o': (1, -1, 'forward right'),
    'j': LEFT, 'k': STOP, 'l': RIGHT,
    'm': (-1, -1, 'backward left'), ',': BACKWARD, '.': (-1, 1, 'backward right'),
    'up': FORWARD, 'down': BACKWARD, 'left': LEFT, 'right': RIGHT,
}
# Factors of the linear and of the angular speed.
SPEEDS = {'q': (1.1, 1.1), 'z': (0.9, 0.9), 'w': (1.1, 1.0), 'x': (0.9, 1.0), 'e': (1.0, 1.1), 'c': (1.0, 0.9)}
LINEAR_RANGE = (0.02, DriveConfig.max_speed)
ANGULAR_RANGE = (0.1, DriveConfig.max_turn_rate)

# A single message could get lost on a poor connection.
ZEROS = 3
HELP_KEYS = ('?', 'h')
LEAVE = (ESCAPE, CTRL_C, CTRL_D)


@dataclasses.dataclass(frozen=True)
class Settings:
    """The node's private parameters."""

    linear: float = setting(0.2, 'driving speed to begin with', 'm/s', *LINEAR_RANGE)
    angular: float = setting(1.0, 'turning speed to begin with', 'rad/s', *ANGULAR_RANGE)
    rate: float = setting(10.0, 'commands a second, more than the robot needs not to stop by itself', 'Hz', 4.0, 100.0)
    hold: float = setting(0.7, 'how long a key counts: longer than a keyboard waits before it repeats', 's', 0.1, 5.0)


def main() -> None:
    """Run the node."""
    node.run('teleop_key', Settings, drive)


def drive(settings: Settings) -> None:
    """Drive as keys say, until one says to leave, a signal does, or ROS shuts down."""
    with Terminal() as terminal:
        Teleop(settings, terminal).run()


class Driver:
    """What keys do to the command; knows neither ROS nor the clock.

    Attributes:
        linear, angular: speeds at which a key drives [m/s], [rad/s].
        until: the last move key counts until then [s].
    """

    def __init__(self, settings: Settings) -> None:
        self.linear = settings.linear
        self.angular = settings.angular
        self.until = -math.inf
        self._hold = settings.hold
        self._move = STOP
        self._zeros_left = 0

    @property
    def doing(self) -> str:
        """What the robot is told, in words."""
        return self._move[-1]

    def press(self, key: str, now: float) -> bool:
        """Take a key at time `now` [s]: a speed key sets speeds, every other one starts a move or stops.

        Returns:
            Whether the command is news, which should not wait for its turn.
        """
        if key in SPEEDS:
            linear, angular = SPEEDS[key]
            self.linear = _clamp(self.linear * linear, LINEAR_RANGE)
            self.angular = _clamp(self.angular * angular, ANGULAR_RANGE)
            return False
        before, self._move = self._move, MOVES.get(key, STOP)
        self.until = now + self._hold
        self._zeros_left = ZEROS
        return self._move != before or self._move is STOP

    def forget(self) -> None:
        """Let no key count any longer; what stops the robot is the caller's."""
        self.until, self._move, self._zeros_left = -math.inf, STOP, 0

    def command(self, now: float) -> Optional[Tuple[float, float]]:
        """What to publish now [m/s], [rad/s]: the move while its key counts, then zero a few times, then nothing."""
        if now >= self.until:
            self._move = STOP
            if self._zeros_left == 0:
                return None
            self._zeros_left -= 1
        linear, angular, _ = self._move
        return linear * self.linear, angular * self.angular


class Brushes:
    """The brushes of the robot that listens, by their service.

    Attributes:
        up: whether they are, by what the robot last said; None before it said so.
        trouble: what went wrong, a line each, for somebody to read.
    """

    def __init__(self) -> None:
        self.up: Optional[bool] = None
        self.trouble: 'queue.SimpleQueue[str]' = queue.SimpleQueue()
        self._service = rospy.ServiceProxy('rumba/set_brushes_up', SetBool)
        self._call: Optional[threading.Thread] = None
        rospy.Subscriber('rumba/battery_status', BatteryStatus, self._listen)

    def toggle(self) -> None:
        """Ask for the opposite of what is; returns at once, since driving must not wait for an answer."""
        if self._call and self._call.is_alive():
            self.trouble.put(f'{self._service.resolved_name} has not answered yet')
            return
        self._call = threading.Thread(target=self._set, args=(not self.up,), daemon=True)
        self._call.start()

    def _set(self, up: bool) -> None:
        try:
            answer = self._service(up)
        except (rospy.ServiceException, rospy.ROSException) as error:
            self.trouble.put(f'brushes: {error}')
            return
        if answer.success:
            self.up = up
        else:
            self.trouble.put(f'brushes: {answer.message}')

    def _listen(self, status: BatteryStatus) -> None:
        self.up = status.brushes_up


class Teleop:
    """The node: one loop that reads keys, publishes, and keeps the live line."""

    def __init__(self, settings: Settings, terminal: Terminal) -> None:
        self._period = 1.0 / settings.rate
        self._terminal = terminal
        self._driver = Driver(settings)
        self._brushes = Brushes()
        self._publisher = rospy.Publisher('rumba/cmd_vel', Twist, queue_size=10)
        self._due = 0.0
        self._leaving = self._suspending = False
        self._stopped = threading.Event()

    def run(self) -> None:
        """Drive until it is time to leave; whatever the reason, the last command is zero."""
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, self._leave)
        signal.signal(signal.SIGTSTP, self._suspend)
        rospy.on_shutdown(self._leave_and_wait)
        try:
            self._terminal.print(self._help())
            while not self._leaving:
                self._step()
        finally:
            self._stop()
            self._stopped.set()

    def _leave(self, *_: object) -> None:
        self._leaving = True

    def _leave_and_wait(self) -> None:
        """ROS asks for an end from a thread of its own, and closes the topic once this returns."""
        self._leave()
        self._stopped.wait(1.0)

    def _suspend(self, *_: object) -> None:
        self._suspending = True

    def _step(self) -> None:
        for key in self._terminal.keys(max(0.0, self._due - time.monotonic())):
            self._press(key)
        now = time.monotonic()
        if now >= self._due:
            self._publish(self._driver.command(now))
            self._due = now + self._period
            if now < self._driver.until < self._due:
                self._due = self._driver.until
        if self._suspending:
            self._suspending = False
            self._stop()
            self._terminal.suspend()
        while not self._brushes.trouble.empty():
            self._terminal.print(self._brushes.trouble.get())
        self._terminal.show(self._line())

    def _press(self, key: str) -> None:
        if key in LEAVE:
            self._leave()
        elif key == 'b':
            self._brushes.toggle()
        elif key in HELP_KEYS:
            self._terminal.print(self._help())
        elif self._driver.press(key, time.monotonic()):
            self._due = 0.0

    def _publish(self, command: Optional[Tuple[float, float]]) -> None:
        if command is not None:
            twist = Twist()
            twist.linear.x, twist.angular.z = command
            self._publisher.publish(twist)

    def _stop(self) -> None:
        """Publish zero whatever was pressed, with time for it to reach whoever listens."""
        self._driver.forget()
        self._terminal.show(self._line())
        for _ in range(ZEROS):
            self._publish((0.0, 0.0))
            time.sleep(0.05)

    def _help(self) -> str:
        return HELP.format(topic=self._publisher.resolved_name)

    def _line(self) -> str:
        brushes = {True: 'up', False: 'down', None: '?'}[self._brushes.up]
        heard = self._publisher.get_num_connections() > 0
        return (f'{self._driver.linear:.2f} m/s  {self._driver.angular:.2f} rad/s   {self._driver.doing:<14}   '
                f'brushes {brushes:<4}   {"?: show the keys" if heard else "nobody listens"}')


def _clamp(value: float, limits: Tuple[float, float]) -> float:
    low, high = limits
    return min(max(value, low), high)
