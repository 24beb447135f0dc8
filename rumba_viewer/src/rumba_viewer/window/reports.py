"""Records a mission, and has its report made when it has ended."""

import time
from typing import Any, Optional

from rumba_viewer.scene.acts import BY_NAME
from rumba_viewer.scene.snapshot import Robot, Snapshot
from rumba_viewer.window.files import new_file


class Reports:
    """A recording from a press of the button to another one, or to the end of the mission."""

    def __init__(self, folder: str, actor: Any) -> None:
        """Save below a folder (empty: the default of `new_file`) by an actor, such as `Actor`."""
        self._folder, self._actor = folder, actor
        self._robot = ''  # that is recorded; empty: none
        self._begun = 0.0  # when that began, on the wall clock [s]
        self._has_cleaned = False  # since then

    @property
    def is_recording(self) -> bool:
        """Whether a mission is being recorded."""
        return bool(self._robot)

    @property
    def recorded(self) -> float:
        """How long the recording is by now [s]."""
        return time.monotonic() - self._begun if self.is_recording else 0.0

    @property
    def hint(self) -> str:
        """A line for the card at the end of a mission: how to get a report, or where it is."""
        act = BY_NAME['report']
        return self._actor.report or f'{act.label} [{act.key}] records the next mission and makes a page of it.'

    def switch(self, robot: str) -> None:
        """Begin to record a robot; if one is recorded, end that."""
        if self.is_recording:
            self._end()
        elif self._actor.record_mission(robot, new_file(self._folder, 'bag')):
            self._robot, self._begun, self._has_cleaned = robot, time.monotonic(), False

    def follow(self, snapshot: Snapshot) -> None:
        """End the recording if the mission that was recorded has ended."""
        robot: Optional[Robot] = next((one for one in snapshot.robots if one.name == self._robot), None)
        if robot is None or robot.mission is None:
            return
        self._has_cleaned = self._has_cleaned or robot.mission.is_cleaning
        if self._has_cleaned and robot.report:
            self._end()

    def _end(self) -> None:
        self._robot = ''
        self._actor.make_report()
