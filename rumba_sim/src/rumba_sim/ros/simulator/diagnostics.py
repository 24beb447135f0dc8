"""Diagnostics of the simulation and of each battery, for people."""

from typing import Callable, List

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from diagnostic_updater import DiagnosticStatusWrapper, Updater

from rumba_sim.model.simulation.robot import Robot

LOW, CRITICAL = 10, 3  # [%] (the Create 3 goes home below 10 % and warns below 3 %)
SLOW = 0.9  # share of the wanted speed below which the simulation is too slow


class StampedUpdater(Updater):
    """An updater whose messages have the time of the simulation.

    Attributes:
        stamp: of the next message.
    """

    stamp = rospy.Time()

    def publish(self, statuses: List[DiagnosticStatus]) -> None:
        """Publish statuses as the base class does, but for the stamp."""
        for status in statuses:
            status.name = f'{rospy.get_name()[1:]}: {status.name}'
        message = DiagnosticArray(status=statuses)
        message.header.stamp = self.stamp
        self.publisher.publish(message)

    def addedTaskCallback(self, task: object) -> None:  # noqa: N802 (name of the base class)
        """Publish nothing yet."""


class Diagnostics:
    """Publishes how fast the simulation is, and the state of each battery."""

    def __init__(self, hardware: str) -> None:
        """Begin without batteries; `hardware` is the name of the map."""
        self._updater = StampedUpdater()
        self._updater.setHardwareID(hardware)
        self._speed, self._wanted, self._late, self._late_before = 0.0, 1.0, 0, 0
        self._updater.add('simulation', self._simulation)

    def add(self, robot: str, find: Callable[[], Robot]) -> None:
        """Report the battery of a robot from now on."""
        self._updater.add(f'battery of {robot}', lambda status: battery(status, find()))

    def remove(self, robot: str) -> None:
        """Report the battery of a robot no longer."""
        self._updater.removeByName(f'battery of {robot}')

    def update(self, stamp: rospy.Time, speed: float, wanted: float, late: int) -> None:
        """Publish; to be called once a second of the wall clock (REP 107).

        Args:
            stamp: time of the simulation.
            speed: reached since the last call [times real time].
            wanted: speed [times real time]; 0: as fast as possible.
            late: how often the simulator gave up to catch up.
        """
        self._speed, self._wanted = speed, wanted
        self._late, self._late_before = late, self._late
        self._updater.stamp = stamp
        self._updater.force_update()

    def _simulation(self, status: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        slow = self._speed < SLOW * self._wanted
        if self._late > self._late_before:
            status.summary(DiagnosticStatus.WARN, 'this machine is too slow for the wanted speed')
        else:
            status.summary(DiagnosticStatus.OK, 'paused or slowed down' if slow else 'as fast as wanted')
        status.add('speed [times real time]', f'{self._speed:.2f}')
        status.add('wanted speed [times real time]', f'{self._wanted:g}' if self._wanted else 'as fast as possible')
        status.add('late ticks', str(self._late))
        return status


def battery(status: DiagnosticStatusWrapper, robot: Robot) -> DiagnosticStatusWrapper:
    """Fill in the state of a battery."""
    state = robot.battery
    level, word = DiagnosticStatus.OK, 'charged'
    if state.percentage < CRITICAL:
        level, word = DiagnosticStatus.ERROR, 'nearly empty' if state.percentage else 'empty'
    elif state.percentage < LOW:
        level, word = DiagnosticStatus.WARN, 'low'
    status.summary(level, f'{word}: {state.percentage} %')
    status.add('charge [Ah]', f'{state.charge:.3f}')
    status.add('voltage [V]', f'{state.voltage:.2f}')
    status.add('current [A]', f'{state.current:.2f}')
    status.add('on the dock', str(robot.is_docked))
    return status
