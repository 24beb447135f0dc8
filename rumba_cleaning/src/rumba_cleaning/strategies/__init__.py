"""Cleaning strategies by name, those of other packages included.

A decorator registers a strategy: that of a function, or a class, which makes its behaviour from a `Context`:

    @strategy('zigzag')
    class Zigzag(Behaviour): ...
"""

import importlib
import os
import traceback
from typing import Callable, Dict, List, Set, TypeVar

from rumba_cleaning.behaviour import Behaviour
from rumba_cleaning.belief.context import Context
from rumba_sim.model.common.errors import StrategyError, quoted

Factory = Callable[[Context], Behaviour]
Made = TypeVar('Made', bound=Factory)
# Modules of rumba_cleaning.strategies.
OWN = ('bounce', 'spiral', 'wall_follow', 'wander', 'boustrophedon', 'explore_and_clean')

_factories: Dict[str, Factory] = {}
_needing_map: Set[str] = set()


def strategy(name: str, needs_map: bool = False) -> Callable[[Made], Made]:
    """Register a strategy by a name, and say whether it is of no use to robots without a map.

    Raises:
        StrategyError: the name is taken.
    """
    def register(factory: Made) -> Made:
        if name in _factories:
            raise StrategyError(f'two strategies are named {name!r}: {_factories[name]} and {factory}')
        _factories[name] = factory
        if needs_map:
            _needing_map.add(name)
        return factory
    return register


def load(modules: str) -> None:
    """Import modules, whose names are separated by commas, for the strategies that they register.

    Raises:
        StrategyError: a module cannot be imported.
    """
    for module in filter(None, (part.strip() for part in modules.split(','))):
        try:
            importlib.import_module(module)
        except StrategyError:
            raise
        except (Exception, SystemExit) as error:  # its code may do anything
            raise StrategyError(f'strategies of {quoted(module)}: {_describe(error)}') from None


def _describe(error: BaseException) -> str:
    """What went wrong in an import, and in which line of which file; without one, how modules are named."""
    frames = [frame for frame in traceback.extract_tb(error.__traceback__)
              if frame.filename not in (__file__, importlib.__file__) and not frame.filename.startswith('<')]
    if isinstance(error, SyntaxError):
        what, lines = error.msg, [f'{os.path.basename(error.filename or "")}:{error.lineno}']
    else:
        what, lines = str(error), [f'{os.path.basename(frame.filename)}:{frame.lineno}' for frame in frames]
    if not lines:
        return f'{what}; a module is named as in Python, my_package.my_module, and must be on the Python path'
    return f'{type(error).__name__}: {what} ({", from ".join(dict.fromkeys([lines[-1], lines[0]]))})'


def known() -> List[str]:
    """Names of all strategies."""
    for module in OWN:
        importlib.import_module(f'rumba_cleaning.strategies.{module}')
    return sorted(_factories)


def check(name: str) -> None:
    """Refuse a strategy that is not registered.

    Raises:
        StrategyError: there is none of that name.
    """
    if name not in known():
        raise StrategyError(f'unknown strategy {quoted(name)}: known are {", ".join(known())}')


def check_mapless(name: str) -> None:
    """Refuse a strategy that is not registered, or that needs a map.

    Raises:
        StrategyError: it is one of these.
    """
    check(name)
    if name in _needing_map:
        others = ', '.join(each for each in known() if each not in _needing_map)
        raise StrategyError(f'strategy {quoted(name)} needs a map: without one there are {others}')


def make(name: str, context: Context) -> Behaviour:
    """A new behaviour for a strategy.

    Raises:
        StrategyError: there is none of that name, or it makes something else.
    """
    check(name)
    behaviour = _factories[name](context)
    if not isinstance(behaviour, Behaviour):
        raise StrategyError(f'strategy {quoted(name)} makes {quoted(behaviour)}: must be a Behaviour')
    return behaviour
