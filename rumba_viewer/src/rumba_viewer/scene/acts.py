"""What a person can do in the window: keys, buttons, and why one of them cannot act now. No ROS, no Qt."""

import math
from typing import Callable, Dict, NamedTuple, Tuple

from rumba_sim.model.robot import FIRST
from rumba_viewer.scene.snapshot import Snapshot

SPEEDS = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 0.0)  # that are offered; 0: as fast as it can


class Act(NamedTuple):
    """Something to do.

    Attributes:
        name: of the method that does it.
        label: on its button.
        key: as Qt names it; empty where there is none.
        tip: what it does.
        lacks: why it cannot be done now; empty where it can.
    """

    name: str
    label: str
    key: str
    tip: str
    lacks: Callable[[Snapshot], str]


def nothing(_: Snapshot) -> str:
    """It can always be done."""
    return ''


def simulator(now: Snapshot) -> str:
    """It needs a simulator."""
    return '' if now.simulation.is_controlled else 'no simulator is running: roslaunch rumba_sim simulator.launch'


def robot(now: Snapshot) -> str:
    """It needs the selected robot."""
    return '' if now.robot is not None else simulator(now) or f'there is no {now.selected}: Tab takes another robot'


def cleaner(now: Snapshot) -> str:
    """It needs a cleaner for the selected robot."""
    if now.robot is None or now.robot.has_cleaner:
        return robot(now)
    arguments = '' if now.selected == FIRST else f' __name:=cleaner_{now.selected} _robot:={now.selected}'
    return f'no cleaner is running: rosrun rumba_cleaning cleaner{arguments}'


def home(now: Snapshot) -> str:
    """It needs a dock too."""
    lacks_dock = now.place.is_known and now.place.dock is None
    return cleaner(now) or ('this map has no dock: `dock` in its YAML file' if lacks_dock else '')


def goal(now: Snapshot) -> str:
    """It needs a cleaner that is at something."""
    mission = now.robot.mission if now.robot is not None else None
    return cleaner(now) or ('' if mission is not None and mission.is_active else 'the cleaner does nothing')


def paused(now: Snapshot) -> str:
    """It needs time to stand still."""
    return simulator(now) or ('' if now.simulation.is_paused else 'time is running: pause it first')


def simulated(now: Snapshot) -> str:
    """It needs time that is not the wall clock's."""
    return simulator(now) or ('' if now.simulation.is_simulated else
                              'time is real: start the simulator with another speed, as speed:=2')


def another_robot(now: Snapshot) -> str:
    """It needs a robot that is not selected."""
    return '' if any(one.name != now.selected for one in now.robots) else 'there is no other robot'


ACTS = (
    Act('clean', 'Clean', 'C', 'leave the dock, clean by the strategy beside, come home', cleaner),
    Act('dock', 'Dock', 'H', 'go home, into the dock', home),
    Act('undock', 'Undock', 'U', 'leave the dock backward', cleaner),
    Act('cancel', 'Cancel', 'Esc', 'stop what the cleaner does', goal),
    Act('pause', 'Pause', 'Space', 'let time stand still, or go on', simulator),
    Act('step', 'Step', 'N', 'let 5 ticks pass while time stands still', paused),
    Act('brushes', 'Brushes', 'B', 'lift or lower the brushes', robot),
    Act('reset', 'Reset', 'Ctrl+R', 'make the floor dirty, and put robots back', simulator),
    Act('slower', 'Slower', '-', 'let time pass slower', simulated),
    Act('faster', 'Faster', '+', 'let time pass faster', simulated),
    Act('laser', 'Laser', 'L', 'show what the laser sees', nothing),
    Act('path', 'Path', 'P', 'show the way driven', nothing),
    Act('field', 'Beams', 'I', 'show where the dock is heard', nothing),
    Act('fit', 'Fit', 'Home', 'show the whole map', nothing),
    Act('next_robot', 'Next robot', 'Tab', 'take the next robot', another_robot),
    Act('save', 'Save PNG', 'Ctrl+S', 'save a picture of the window', nothing),
    Act('record', 'Record GIF', 'Ctrl+G', 'begin or end to record the floor', nothing),
    Act('legend', 'Keys', 'F1', 'show or hide the keys', nothing),
)
BY_NAME: Dict[str, Act] = {act.name: act for act in ACTS}

# Shares of the linear and of the angular speed.
DRIVE = {'Up': (1, 0), 'W': (1, 0), 'Down': (-1, 0), 'S': (-1, 0),
         'Left': (0, 1), 'A': (0, 1), 'Right': (0, -1), 'D': (0, -1)}
MOUSE = (
    ('Arrows, W A S D', 'drive; let go, and the robot stops'),
    ('Click', 'have the cleaner go there; take the robot clicked on'),
    ('Drag the robot', 'put it elsewhere; the wheel turns it meanwhile'),
    ('Wheel', 'zoom'),
    ('Drag with middle or right button', 'move the map'),
)


def next_speed(wanted: float, direction: int) -> float:
    """The next of SPEEDS that is faster (1) or slower (-1) than the one that is wanted; itself where there is none."""
    def rank(speed: float) -> float:
        return speed or math.inf
    beyond = [speed for speed in SPEEDS if direction * rank(speed) > direction * rank(wanted)]
    return min(beyond, key=lambda speed: direction * rank(speed)) if beyond else wanted


def legend() -> Tuple[Tuple[str, str], ...]:
    """What keys and mouse do, a row each."""
    return MOUSE + tuple((act.key, act.tip) for act in ACTS)


class Steering:
    """Which way the keys that are held down drive; knows no clock."""

    ZEROS = 3  # a single message could get lost on a poor connection

    def __init__(self) -> None:
        """Begin with no key."""
        self._held: Dict[str, Tuple[int, int]] = {}
        self._zeros = 0

    def press(self, key: str) -> bool:
        """A key went down; returns whether it drives."""
        if key in DRIVE:
            self._held[key] = DRIVE[key]
            self._zeros = self.ZEROS
        return key in DRIVE

    def release(self, key: str) -> bool:
        """A key went up; returns whether it drove."""
        return self._held.pop(key, None) is not None

    def command(self) -> Tuple[Tuple[int, int], bool]:
        """Shares of the linear and the angular speed, and whether to say so: after the last key a few times zero."""
        if not self._held:
            is_due, self._zeros = self._zeros > 0, max(self._zeros - 1, 0)
            return (0, 0), is_due
        linear, angular = (sum(share[axis] for share in set(self._held.values())) for axis in (0, 1))
        return (linear, -angular if linear < 0 else angular), True
