"""Has a function compiled by numba, as the kernel is: with a cache, if there is a place for one.

The same functions give the same results uncompiled. A compiled function can call only compiled functions.
"""

from typing import Any, Callable, TypeVar, cast

import numba

from rumba_sim.model import compiled as kernel

Function = TypeVar('Function', bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    """A decorator."""
    return cast(Function, kernel._cached(numba.njit(function), function.__code__.co_filename))
