"""teleop_key: drives a Rumba from the keyboard of the terminal in which it runs.

A key counts for ~hold seconds of wall time: the robot drives while you hold the key, and stops when you let go. While
you drive, and for 0.5 s after, your commands override those on rumba/cmd_vel; then another node drives again.

Publishes:
  rumba/teleop/cmd_vel     geometry_msgs/Twist, at ~rate while a key counts, then zero a few times

Subscribes:
  rumba/battery_status     rumba_msg/BatteryStatus, to show whether the brushes are up

Calls:
  rumba/set_brushes_up     std_srvs/SetBool, true lifts the brushes

A robot without teleop/cmd_vel, such as a turtle, is driven by a remapping: rumba/teleop/cmd_vel:=turtle1/cmd_vel.

Parameters, as in `rosrun rumba_sim teleop_key _linear:=0.3 _angular:=1.5`:
"""

import signal
import threading
import time
from typing import Optional, Tuple

import rospy
from geometry_msgs.msg import Twist

from rumba_sim.ros.common import teleop
from rumba_sim.ros.running import node
from rumba_sim.ros.running.terminal import CTRL_C, CTRL_D, ESCAPE, Terminal
from rumba_sim.ros.teleop_key.brushes import Brushes
from rumba_sim.ros.teleop_key.driver import ZEROS, Driver
from rumba_sim.ros.teleop_key.settings import Settings

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
HELP_KEYS = ('?', 'h')
LEAVE = (ESCAPE, CTRL_C, CTRL_D)


def main() -> None:
    """Run the node."""
    node.run('teleop_key', Settings, drive)


def drive(settings: Settings) -> None:
    """Drive by keys, until a key or a signal ends it, or ROS shuts down."""
    with Terminal() as terminal:
        Teleop(settings, terminal).run()


class Teleop:
    """The node: one loop that reads keys, publishes, and keeps the live line."""

    def __init__(self, settings: Settings, terminal: Terminal) -> None:
        """Open the node's topics."""
        self._period = 1.0 / settings.rate
        self._terminal = terminal
        self._driver = Driver(settings)
        self._brushes = Brushes()
        self._publisher = rospy.Publisher(f'rumba/{teleop.TOPIC}', Twist, queue_size=10)
        self._due = 0.0
        self._leaving = self._suspending = False
        self._stopped = threading.Event()

    def run(self) -> None:
        """Drive until it is time to leave; the last command is always zero."""
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
        """ROS calls this in a thread of its own, and closes the topic after it."""
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
        """Publish zero, and give the messages time to arrive."""
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
