"""The robots with which a robot shares its floor: what they tell, and what that means for its own work.

Each robot tells its mates at each step where it is, whether it sweeps, and where it will drive. So each of them knows
what all of them swept, and what is left. Nobody is in charge: who needs work plans for what nobody has planned.
"""

import copy
import enum
from typing import Dict, List, NamedTuple, Optional, Sequence

from rumba_cleaning.route import Ahead
from rumba_sim.model.common.geometry import Pose


class Task(enum.IntEnum):
    """What a robot does, as its mates need to know; the constants of rumba_msg/TeamReport."""

    OFF = 0
    SEEKING = 1
    SWEEPING = 2
    RETURNING = 3
    DOCKING = 4
    DOCKED = 5


class Report(NamedTuple):
    """What a robot tells its mates."""

    pose: Pose  # [m, rad], map frame
    brushes_up: bool  # on the way there from the pose of the report before
    task: Task
    ahead: Optional[Ahead] = None  # where it will drive; None if it has no plan


class Mates:
    """The mates of one robot, and what each told last; in its order, each gives way to those before.

    Attributes:
        name: of the robot itself.
        reports: by the name of the mate; without those that have told nothing yet.
    """

    def __init__(self, name: str = '', team: Sequence[str] = ()) -> None:
        """Know the names of all robots of a team, that of the robot among them, in the order of precedence."""
        self.name = name
        self._before = tuple(team[:team.index(name)]) if name in team else ()
        self.reports: Dict[str, Report] = {}

    def copy(self) -> 'Mates':
        """The same mates and reports, which stay as they are if these change."""
        other = copy.copy(self)
        other.reports = dict(self.reports)
        return other

    def hear(self, name: str, report: Report) -> None:
        """Take note of what a mate tells."""
        self.reports[name] = report

    @property
    def rank(self) -> int:
        """How many mates come before the robot."""
        return len(self._before)

    def has_precedence(self, name: str) -> bool:
        """Whether a mate comes before the robot."""
        return name in self._before

    @property
    def are_busy(self) -> bool:
        """Whether any of them sweeps, or is about to."""
        return any(report.task in (Task.SEEKING, Task.SWEEPING) for report in self.reports.values())

    @property
    def plan_before(self) -> bool:
        """Whether one that comes before is planning: then it is not the turn of the robot to plan."""
        return any(name in self._before and report.task is Task.SEEKING for name, report in self.reports.items())

    @property
    def seeking(self) -> List[Pose]:
        """Where those of them are that need work."""
        return [report.pose for report in self.reports.values() if report.task is Task.SEEKING]

    def relief(self, name: str, plan: int) -> float:
        """Length [m] of the end of a plan, by the name of a robot and its number, that mates drive in its place."""
        return max((report.ahead.relief.length for report in self.reports.values()
                    if report.ahead is not None and report.ahead.relief is not None
                    and report.ahead.relief[:2] == (name, plan)), default=0.0)

    def sweeping(self) -> Dict[str, Ahead]:
        """What those that sweep will drive, by their names."""
        return {name: report.ahead for name, report in self.reports.items()
                if report.task is Task.SWEEPING and report.ahead is not None}
