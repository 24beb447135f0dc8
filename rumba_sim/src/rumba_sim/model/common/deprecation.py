"""How the public interface loses a function: it warns for a minor version at least before it goes."""

import functools
import warnings
from typing import Any, Callable, TypeVar, cast

Function = TypeVar('Function', bound=Callable[..., Any])


def deprecated(since: str, instead: str) -> Callable[[Function], Function]:
    """Have a function warn at each call that it will go.

    Args:
        since: the version that deprecates it.
        instead: what to use in its place.
    """
    def decorate(function: Function) -> Function:
        @functools.wraps(function)
        def warn(*arguments: Any, **named: Any) -> Any:
            warnings.warn(f'{function.__name__} is deprecated since {since}: use {instead}', DeprecationWarning, 2)
            return function(*arguments, **named)
        return cast(Function, warn)
    return decorate
