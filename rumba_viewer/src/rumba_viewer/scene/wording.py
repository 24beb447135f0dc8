"""A mission in words, for the terminal and the window."""

import math
from typing import List, NamedTuple, Optional

from rumba_viewer.scene.forecast import CLEANING
from rumba_viewer.scene.snapshot import Battery, Cleaning, Mission

UNKNOWN = '-'
PLANNING = 'planning'  # so the message of a mission ends while the robot stands and plans


def percent(share: float, digits: int = 0) -> str:
    """A share 0..1; one below its target does not read like it, so it is rounded down."""
    if not math.isfinite(share):
        return UNKNOWN
    scale = 10.0 ** (digits + 2)
    return f'{math.floor(share * scale + 1e-6) / 10.0 ** digits:.{digits}f} %'


def span(seconds: float) -> str:
    """A time [s] as m:ss, or h:mm:ss."""
    whole = max(int(seconds), 0)
    hours = f'{whole // 3600}:{whole // 60 % 60:02d}' if whole >= 3600 else f'{whole // 60}'
    return f'{hours}:{whole % 60:02d}'


def about(seconds: float) -> str:
    """An estimate of a time [s]: as exact as it can be taken for."""
    if seconds < 60.0:
        return 'less than 1 min'
    minutes = math.ceil(seconds / 60.0)
    return f'about {minutes} min' if minutes < 120 else f'about {minutes / 60.0:.1f} h'


def taken(elapsed: Optional[float], left: Optional[float]) -> str:
    """How long a mission takes already, and still [s]; empty if both are unknown."""
    known = [] if elapsed is None else [span(elapsed)]
    return ', '.join(known if left is None else [*known, f'{about(left)} left'])


def live_lines(mission: Optional[Mission], cleaning: Optional[Cleaning], battery: Battery,
               elapsed: Optional[float], left: Optional[float]) -> List[str]:
    """A mission in one line: all of it, and shorter lines for narrow terminals; each keeps battery and time."""
    figures = [f'{percent(cleaning.coverage, 1):>6} swept' if cleaning is not None else 'no floor',
               f'battery {percent(battery.share)}']
    whole, short = (taken(elapsed, one) for one in (left, None))
    state = doing(mission)
    strategy = f' by {mission.strategy}' if mission is not None and state == CLEANING and mission.strategy else ''
    lines = [(whole, state + strategy), (whole, state), (short, state), (short, '')]
    return list(dict.fromkeys('  '.join(filter(None, [*figures, *parts])) for parts in lines))


def doing(mission: Optional[Mission]) -> str:
    """What a robot does, in one or two words."""
    if mission is None:
        return 'no cleaner'
    return PLANNING if mission.message.rpartition('; ')[2] == PLANNING else mission.state


class Effort(NamedTuple):
    """What a mission took: time [s], distance [m], number of charges; None: not seen."""

    time: Optional[float] = None
    distance: Optional[float] = None
    charges: Optional[int] = None

    def words(self) -> List[str]:
        """What is known of it."""
        return [*([] if self.time is None else [span(self.time)]),
                *([] if self.distance is None else [f'{self.distance:.1f} m driven']),
                *([] if self.charges is None else [f'{self.charges} charge{"" if self.charges == 1 else "s"}'])]


def closing(robot: str, mission: Mission, cleaning: Cleaning, battery: Battery, effort: Effort) -> List[str]:
    """A small report at the end of a mission."""
    return [
        f'{robot}: {percent(cleaning.coverage, 1)} of the floor is swept: {cleaning.cleaned_area:.1f} of '
        f'{cleaning.reachable_area:.1f} m², {percent(cleaning.dirt, 1)} of the dirt is left',
        ', '.join([*effort.words(), f'battery {percent(battery.share)}'])
        + (f'; {mission.message}' if mission.state == 'stranded' else '')]
