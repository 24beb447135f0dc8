"""What a person can do in the window: keys, buttons, and why one of them is not available. No ROS, no Qt."""

import math
from typing import Callable, Dict, List, NamedTuple, Optional, Tuple

from rumba_sim.model.simulation.robot import FIRST
from rumba_viewer.scene.snapshot import Snapshot

SPEEDS = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 0.0)  # that are offered [times real time]; 0: as fast as possible
TUNING = 'tuning/set_parameters'  # the service that changes the speed


class Act(NamedTuple):
    """One thing that a person can do.

    Attributes:
        name: which method does it.
        label: on its button.
        key: as Qt names it; empty if it has none.
        tip: what it does.
        lacks: why it is not available; empty if it is.
        warning: what is lost by it for good; if not empty, a person must ask for it twice.
    """

    name: str
    label: str
    key: str
    tip: str
    lacks: Callable[[Snapshot], str]
    warning: str = ''


def nothing(_: Snapshot) -> str:
    """It is always available."""
    return ''


def simulator(now: Snapshot) -> str:
    """It needs a simulator."""
    return '' if now.simulation.node else 'no simulator is running: roslaunch rumba_sim simulator.launch'


def service(name: str) -> Callable[[Snapshot], str]:
    """It needs a service of the simulator, by its name below that of the node."""
    def lacks(now: Snapshot) -> str:
        simulation = now.simulation
        is_there = name in simulation.services
        return simulator(now) or ('' if is_there else f'{simulation.node} has no service {name.split("/")[0]}')
    return lacks


def robot(now: Snapshot) -> str:
    """It needs the selected robot."""
    return '' if now.robot is not None else simulator(now) or f'there is no {now.selected}: T selects another robot'


def cleaner(now: Snapshot) -> str:
    """It needs a cleaner for the selected robot."""
    if now.robot is None or now.robot.has_cleaner:
        return robot(now)
    arguments = '' if now.selected == FIRST else f' __name:=cleaner_{now.selected} _robot:={now.selected}'
    return f'no cleaner is running: rosrun rumba_cleaning cleaner{arguments}'


def no_cleaning(now: Snapshot) -> str:
    """It needs a cleaner that is not cleaning."""
    mission = now.robot.mission if now.robot is not None else None
    is_cleaning = mission is not None and mission.is_cleaning
    return cleaner(now) or (f'{now.selected} is already cleaning: cancel that first' if is_cleaning else '')


def interrupted_cleaning(now: Snapshot) -> str:
    """It needs a cleaning that was interrupted; the cleaner refuses if the window does not know that there is none."""
    has_none = now.robot is not None and now.robot.can_resume is False
    return no_cleaning(now) or ('no cleaning was interrupted' if has_none else '')


def way(now: Snapshot) -> str:
    """It needs a cleaner, and a map in which a point can be named."""
    return cleaner(now) or ('' if now.map_frame is not None else f'{now.selected} has not begun a map yet')


def target(now: Snapshot) -> str:
    """It needs a cleaner and a target."""
    return way(now) or ('' if now.target is not None else 'there is no target: click on the floor first')


def dock(now: Snapshot) -> str:
    """It needs a cleaner and a dock."""
    lacks_dock = now.features.is_known and not now.features.docks
    return cleaner(now) or ('this map has no dock: `dock` in its YAML file' if lacks_dock else '')


def goal(now: Snapshot) -> str:
    """It needs a cleaner that has a goal."""
    mission = now.robot.mission if now.robot is not None else None
    return cleaner(now) or ('' if mission is not None and mission.is_active else 'the cleaner has no goal')


def paused(now: Snapshot) -> str:
    """It needs time to be paused."""
    return service('step')(now) or ('' if now.simulation.is_paused else 'time is running: pause it first')


def simulated(now: Snapshot) -> str:
    """It needs a simulator that can change the speed of time."""
    return service(TUNING)(now) or ('' if now.simulation.is_simulated else
                                    'time is real: start the simulator with another speed, such as speed:=2')


def another_robot(now: Snapshot) -> str:
    """It needs a robot that is not selected."""
    return '' if any(one.name != now.selected for one in now.robots) else 'there is no other robot'


ACTS = (
    Act('clean', 'Clean', 'C', 'clean the floor by the chosen strategy, then return to the dock', no_cleaning),
    Act('resume_cleaning', 'Resume cleaning', 'R', 'continue the cleaning that was interrupted', interrupted_cleaning),
    Act('go_there', 'Go there', 'Enter', 'send the robot to the target', target),
    Act('dock', 'Dock', 'H', 'return to the dock', dock),
    Act('undock', 'Undock', 'U', 'leave the dock', cleaner),
    Act('cancel', 'Cancel', 'Esc', 'cancel what the cleaner does (first clears a target)', goal),
    Act('pause', 'Pause', 'Space', 'pause or unpause time', service('pause')),
    Act('step', 'Step', 'N', 'advance the paused time by 5 ticks', paused),
    Act('brushes', 'Brushes', 'B', 'lift or lower the brushes', robot),
    Act('reset', 'Reset', 'Ctrl+R', 'make the floor dirty again and put all robots back', service('reset'),
        'what was cleaned is forgotten and the robots are put back'),
    Act('slower', 'Slower', '-', 'make time pass slower', simulated),
    Act('faster', 'Faster', '+', 'make time pass faster', simulated),
    Act('laser', 'Laser', 'L', 'show or hide what the laser measures', nothing),
    Act('path', 'Path', 'P', 'show or hide the path driven', nothing),
    Act('field', 'Dock beams', 'I', 'show or hide where the beams of the dock are received', nothing),
    Act('fit', 'Fit', 'Home', 'show the whole map', nothing),
    Act('next_robot', 'Next robot', 'T', 'select the next robot', another_robot),
    Act('more', 'More', 'M', 'show or hide the buttons for time and robot', nothing),
    Act('save', 'Save PNG', 'Ctrl+S', 'save a picture of the window', nothing),
    Act('record', 'Record', 'Ctrl+G', 'start or stop recording the floor as a GIF', nothing),
    Act('report', 'Report', 'Ctrl+B', 'make a page about the mission: at its end, or, pressed again, now', robot),
    Act('legend', 'Keys', 'F1', 'show or hide this list', nothing),
)
BY_NAME: Dict[str, Act] = {act.name: act for act in ACTS}

# Shares of the linear and of the angular speed.
DRIVE = {'Up': (1, 0), 'W': (1, 0), 'Down': (-1, 0), 'S': (-1, 0),
         'Left': (0, 1), 'A': (0, 1), 'Right': (0, -1), 'D': (0, -1)}
MOUSE = (
    ('Arrows, W A S D', 'drive while held; the cleaner waits meanwhile'),
    ('Tab, Shift+Tab', 'go to the next or last button; Space or Enter presses it'),
    ('Click', 'choose a target on the floor; select a robot'),
    ('Double click', 'send the robot to that point'),
    ('Drag the robot', 'put it elsewhere; the wheel turns it'),
    ('Wheel', 'zoom'),
    ('Drag with middle or right button', 'move the map'),
)


def next_speed(wanted: float, direction: int) -> float:
    """The next of SPEEDS that is faster (1) or slower (-1) than the wanted one; the same if there is none."""
    def rank(speed: float) -> float:
        return speed or math.inf
    beyond = [speed for speed in SPEEDS if direction * rank(speed) > direction * rank(wanted)]
    return min(beyond, key=lambda speed: direction * rank(speed)) if beyond else wanted


def speeds_with(wanted: Optional[float]) -> List[float]:
    """The offered speeds, and the wanted one if it is another; the slowest first."""
    more = [] if wanted is None or wanted in SPEEDS else [wanted]
    return sorted([*SPEEDS, *more], key=lambda speed: speed or math.inf)


def legend() -> Tuple[Tuple[str, str], ...]:
    """What keys and mouse do, one row each."""
    return MOUSE + tuple((act.key, act.tip) for act in ACTS)


class Steering:
    """The command of the keys that are held down; does not know the time."""

    ZEROS = 3  # a single message could get lost on a poor connection

    def __init__(self) -> None:
        """Start with no key."""
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
        """Shares of the linear and the angular speed, and whether to publish them: after the last key a few zeros."""
        if not self._held:
            is_due, self._zeros = self._zeros > 0, max(self._zeros - 1, 0)
            return (0, 0), is_due
        linear, angular = (sum(share[axis] for share in set(self._held.values())) for axis in (0, 1))
        return (linear, -angular if linear < 0 else angular), True
