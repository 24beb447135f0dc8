"""The modules on which safety depends, and what the robot says of itself, and the tests that shall find their faults.

Paths are relative to the folder of the package.
"""

from typing import NamedTuple, Tuple


class Judged(NamedTuple):
    """A module, and the unit tests that judge it."""

    package: str
    module: str  # below the package's folder of sources
    tests: Tuple[str, ...]  # names of files in test/unit, without test_ and .py

    @property
    def name(self) -> str:
        """Its last part, by which it is called."""
        return self.module.split('/')[-1]

    @property
    def path(self) -> str:
        """Of the source, in the checkout."""
        return f'{self.package}/src/{self.package}/{self.module}.py'

    @property
    def test_paths(self) -> Tuple[str, ...]:
        """Of the tests, in the checkout."""
        return tuple(f'{self.package}/test/unit/test_{name}.py' for name in self.tests)


JUDGED = {judged.name: judged for judged in (
    Judged('rumba_cleaning', 'behaviours/travel', ('travel', 'go_to')),
    Judged('rumba_cleaning', 'edges/guard', ('guard', 'slip', 'backing_off')),
    Judged('rumba_cleaning', 'mission/battery_watch', ('battery_watch',)),
    Judged('rumba_cleaning', 'strategies/boustrophedon', ('boustrophedon', 'planned_path', 'confinement', 'margin')),
    Judged('rumba_cleaning', 'belief/sight', ('sight',)),
    Judged('rumba_cleaning', 'mission/mission', ('mission', 'returning', 'interruptions', 'relocation')),
    Judged('rumba_localisation', 'mapping/mapper', ('mapper', 'loop_closure')),
    Judged('rumba_localisation', 'matcher', ('matching',)),
    Judged('rumba_sim', 'model/kernel/ticking/movers', ('movers', 'obstacles')),
    Judged('rumba_viewer', 'scene/forecast', ('forecast', 'page_forecast')),
    Judged('rumba_viewer', 'page/feeds', ('page_feeds', 'page_frames', 'page_held')))}
