"""Which rumba_msg is imported: the one with our definitions, although another one may come before it on sys.path.

The course has its learners write a package rumba_msg, with a message and a service of those that ours has. Python finds
that package first in a workspace that is built over ours.
"""

import os
import sys
from importlib.machinery import ModuleSpec, PathFinder
from importlib.util import module_from_spec
from typing import Optional

PACKAGE = 'rumba_msg'
MODULES = tuple(
    [f'msg/_{name}' for name in (
        'BatteryStatus', 'Bumper', 'CleanAction', 'CleaningStatus', 'Cliff', 'DockAction', 'DockStatus', 'GoToAction',
        'Lockstep', 'LockstepAnswer', 'MissionStatus', 'Outcome', 'SimulatorState', 'TeamPlan', 'TeamReport',
        'UndockAction')]
    + [f'srv/_{name}' for name in (
        'AddObstacle', 'Kill', 'RemoveObstacle', 'Spawn', 'Step', 'TargetPosition', 'Teleport')])


def take_ours() -> None:
    """Import the first rumba_msg that has all of our definitions, in place of one that was imported before.

    If there is none, the import of what is missing raises an ImportError, as always.
    """
    spec, present = _ours(), sys.modules.get(PACKAGE)
    if spec is None or spec.loader is None or present is not None and present.__file__ == spec.origin:
        return
    for name in [name for name in sys.modules if name.split('.')[0] == PACKAGE]:
        del sys.modules[name]
    module = sys.modules[PACKAGE] = module_from_spec(spec)
    spec.loader.exec_module(module)


def _ours() -> Optional[ModuleSpec]:
    """Where the first rumba_msg with all of our definitions is."""
    found = (PathFinder.find_spec(PACKAGE, [folder]) for folder in sys.path)
    return next((spec for spec in found if spec is not None and _has_all(spec)), None)


def _has_all(spec: ModuleSpec) -> bool:
    """Whether a package has all of our definitions; a folder that is no package of Python has none."""
    return spec.origin is not None and all(
        os.path.exists(os.path.join(os.path.dirname(spec.origin), f'{module}.py')) for module in MODULES)
