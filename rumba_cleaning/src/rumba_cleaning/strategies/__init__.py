"""Cleaning strategies by name, those of other packages included.

A decorator registers a strategy: that of a function, or a class, which makes its behaviour from a `Context`:

    @strategy('zigzag')
    class Zigzag(Behaviour): ...
"""

import importlib
from typing import Callable, Dict, List, TypeVar

from rumba_cleaning.behaviour import Behaviour
from rumba_cleaning.belief.context import Context
from rumba_sim.model.errors import StrategyError

Factory = Callable[[Context], Behaviour]
Made = TypeVar('Made', bound=Factory)
OWN = ('bounce', 'spiral', 'wall_follow', 'boustrophedon')  # modules of rumba_cleaning.strategies

_factories: Dict[str, Factory] = {}


def strategy(name: str) -> Callable[[Made], Made]:
    """Register a strategy by a name.

    Raises:
        StrategyError: the name is taken.
    """
    def register(factory: Made) -> Made:
        if name in _factories:
            raise StrategyError(f'two strategies are named {name!r}: {_factories[name]} and {factory}')
        _factories[name] = factory
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
        except (ImportError, SyntaxError, TypeError) as error:  # TypeError: a relative name
            raise StrategyError(f'strategies of {module!r}: {error}; a module is named as in Python, '
                                'my_package.my_module, and must be on the Python path') from None


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
        raise StrategyError(f'unknown strategy {name!r}: known are {", ".join(known())}')


def make(name: str, context: Context) -> Behaviour:
    """A new behaviour for a strategy.

    Raises:
        StrategyError: there is none of that name.
    """
    check(name)
    return _factories[name](context)
