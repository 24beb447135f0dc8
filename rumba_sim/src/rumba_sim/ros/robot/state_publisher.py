"""The state of a simulator as a topic, and its settings as parameters."""

import dataclasses
import math
import time
import uuid
from typing import Any

import rospy
from std_msgs.msg import Header

from rumba_msg.msg import SimulatorState
from rumba_sim.ros.participants.simulator_client import SETTINGS, TOPIC

PERIOD = 1.0  # [s] of the wall clock between messages if nothing changes


class StatePublisher:
    """Publishes the state of the node at each change and once a second, and measures how fast time passes.

    Attributes:
        due: when to publish again, as a time of `time.monotonic`, if nothing changes before.
        real_time_factor: [times real time] in the last second of the wall clock; 0 before the first is over.
        resets: how often the world was reset since the node started.
    """

    def __init__(self, settings: Any, map_path: str, step_rate: float, is_time_simulated: bool,
                 run: str = '', is_lockstep: bool = False) -> None:
        """Set the parameters, and start to measure; services that others use must exist before the first `publish`.

        Args:
            settings: a frozen dataclass, the settings in force; has a `seed`.
            map_path: absolute path of the map.
            step_rate: [Hz] of ticks.
            is_time_simulated: whether time is that of /clock.
            run: identifies this run of the node; empty for a new text.
            is_lockstep: whether the world waits for those who take part.
        """
        tell_settings(settings)
        self._publisher = rospy.Publisher(TOPIC, SimulatorState, queue_size=10, latch=True)
        self._map_path = map_path
        self._seed = settings.seed
        self._step_rate = step_rate
        self._is_time_simulated = is_time_simulated
        self._is_lockstep = is_lockstep
        self._run = run or uuid.uuid4().hex
        self._ticks = 0
        self._begin = time.monotonic()
        self.due = self._begin + PERIOD
        self.real_time_factor = 0.0
        self.resets = 0

    def publish(self, ticks: int, stamp: rospy.Time, is_paused: bool = False, speed: float = math.nan) -> None:
        """Publish the state.

        Args:
            ticks: number of ticks since the node started.
            stamp: time of the robots.
            is_paused: whether the simulation is paused.
            speed: [times real time] wanted; 0: as fast as possible; NaN: another node decides.
        """
        now = time.monotonic()
        if now >= self.due:
            self.real_time_factor = (ticks - self._ticks) / self._step_rate / (now - self._begin)
            self._ticks, self._begin, self.due = ticks, now, now + PERIOD
        self._publisher.publish(SimulatorState(
            header=Header(stamp=stamp), node=rospy.get_name(), run=self._run, resets=self.resets, is_paused=is_paused,
            speed=speed, real_time_factor=self.real_time_factor, is_time_simulated=self._is_time_simulated,
            is_lockstep=self._is_lockstep, tick=ticks, step_rate=self._step_rate, map=self._map_path, seed=self._seed))


def tell_settings(settings: Any) -> None:
    """Set parameters to the settings in force."""
    rospy.set_param(f'~{SETTINGS}', dataclasses.asdict(settings))
