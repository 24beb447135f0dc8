"""A mission in words, for the terminal and the window."""

import math
from typing import List, Optional

from rumba_viewer.scene.forecast import CLEANING, Forecast
from rumba_viewer.scene.snapshot import Battery, Cleaning, Mission

UNKNOWN = '-'


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


def doing(mission: Optional[Mission]) -> str:
    """What a robot does."""
    if mission is None:
        return 'no cleaner'
    strategy = f' by {mission.strategy}' if mission.state == CLEANING and mission.strategy else ''
    return f'{mission.state}{strategy}'


def live_line(mission: Optional[Mission], cleaning: Optional[Cleaning], battery: Battery,
              elapsed: Optional[float], left: Optional[float]) -> str:
    """A mission in one line, the most important first, since a narrow terminal shows its beginning."""
    parts = [f'{percent(cleaning.coverage, 1):>6} swept' if cleaning is not None else 'no floor',
             f'battery {percent(battery.share)}']
    time = taken(elapsed, left)
    if time:
        parts.append(time)
    return '  '.join((*parts, doing(mission)))


def closing(robot: str, mission: Mission, cleaning: Cleaning, begin: Optional[Cleaning], battery: Battery,
            forecast: Forecast) -> List[str]:
    """A small report at the end of a mission."""
    charges = forecast.charges
    time = f'{span(forecast.elapsed)}, ' if forecast.is_whole else ''
    driven = cleaning.distance - (begin.distance if begin is not None else 0.0)
    return [
        f'{robot}: {percent(cleaning.coverage, 1)} of the floor is swept: {cleaning.cleaned_area:.1f} of '
        f'{cleaning.reachable_area:.1f} m², {percent(cleaning.dirt, 1)} of the dirt is left',
        f'{time}{max(driven, 0.0):.1f} m driven, {charges} charge{"" if charges == 1 else "s"}, '
        f'battery {percent(battery.share)}' + (f'; {mission.message}' if mission.state == 'stranded' else '')]
