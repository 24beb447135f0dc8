"""Records each mission, and has a report made of it if a person asks for one, during the mission or after its end."""

import time
from typing import Any

from rumba_viewer.scene.acts import BY_NAME
from rumba_viewer.scene.snapshot import Snapshot
from rumba_viewer.window.files import new_file

LATER = 'report: the page is made when the mission ends, or when the button is pressed again'


class Reports:
    """One recording at a time: of a mission, or from a press of the button to the end of the next mission.

    Attributes:
        is_asked: whether a report will be made of what is being recorded.
    """

    def __init__(self, folder: str, actor: Any) -> None:
        """Save below a folder (empty: the default of `new_file`) by an actor, such as `Actor`."""
        self._folder, self._actor = folder, actor
        self._robot = ''  # whose mission is being recorded; empty: none
        self._begun = 0.0  # when that began, on the wall clock [s]
        self._has_cleaned = False  # since then
        self._is_tried = False  # whether to record the present mission was tried
        self._has_record = False  # of a mission that has ended
        self.is_asked = False

    @property
    def recorded(self) -> float:
        """How long the recording is by now [s]."""
        return time.monotonic() - self._begun if self._robot else 0.0

    @property
    def hint(self) -> str:
        """A line for the card at the end of a mission: how to get a report, or where it is."""
        act = BY_NAME['report']
        what = 'makes a page of this mission' if self._has_record else 'records the next mission and makes a page of it'
        return self._actor.report or f'{act.label} [{act.key}] {what}.'

    def switch(self, snapshot: Snapshot) -> None:
        """Ask for a report of a mission: at its end, or, if it has ended or this is asked twice, now."""
        if self.is_asked:
            self._end()
            self._make(snapshot.selected)
        elif self._robot or self._has_record or self._begin(snapshot, is_asked=True):
            if self._actor.keep_recording(new_file(self._folder, 'bag')):
                if self._has_record:
                    self._make(snapshot.selected)
                else:
                    self.is_asked = True
                    self._actor.notices.put(LATER)

    def follow(self, snapshot: Snapshot) -> None:
        """Begin to record a mission that has begun, and end that with the mission."""
        is_cleaning = any(robot.mission is not None and robot.mission.is_cleaning for robot in snapshot.robots
                          if robot.name == (self._robot or snapshot.selected))
        if is_cleaning and not self._robot and not self._is_tried:
            self._begin(snapshot)
        self._is_tried = is_cleaning
        self._has_cleaned = self._has_cleaned or is_cleaning
        if self._has_cleaned and any(robot.report for robot in snapshot.robots if robot.name == self._robot):
            robot, was_asked = self._robot, self.is_asked
            self._end()
            if was_asked:
                self._make(robot)

    def _begin(self, snapshot: Snapshot, is_asked: bool = False) -> bool:
        """Begin to record all robots; returns whether that is possible."""
        self._has_record = False
        if self._actor.record_mission([robot.name for robot in snapshot.robots], is_asked):
            self._robot, self._begun, self._has_cleaned = snapshot.selected, time.monotonic(), False
        return bool(self._robot)

    def _end(self) -> None:
        self._actor.end_recording()
        self._robot, self._has_record = '', True

    def _make(self, robot: str) -> None:
        self.is_asked = self._has_record = False
        self._actor.make_report(robot)
