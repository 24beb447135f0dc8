"""Has a function compiled by numba, as the kernel is: with a cache, if there is a place for one.

The same functions give the same results uncompiled. A compiled function can call only compiled functions: those of its
own module, and those that this imports. Compiled code is cached until the contents of any of their files change.
"""

from types import FunctionType
from typing import Any, Callable, List, Tuple, TypeVar, cast

import numba

from rumba_sim.model.compiling import compiled as kernel

Function = TypeVar('Function', bound=Callable[..., Any])
Named = TypeVar('Named', bound=Tuple[Any, ...])


def compiled(function: Function) -> Function:
    """A decorator."""
    return cast(Function, kernel._cached(numba.njit(function), *_files(cast(FunctionType, function))))


def plain(named: Named) -> Named:
    """A named tuple as compiled functions are to get it from others: without its names.

    The compiled function gives them back: `drive = Drive(*drive)`. numba 0.56 knows types by texts that hold the names
    of fields, but it loses the first 40 characters of a longer text: then it often takes the type for a new one, which
    takes time, and keeps that for good.
    """
    return cast(Named, tuple(named))


def _files(function: FunctionType) -> List[str]:
    """The file of a function, and those of the compiled functions that its module imports, and so on."""
    own = function.__code__.co_filename
    found = {own}
    for value in function.__globals__.values():
        plain = getattr(value, 'py_func', None)  # of a function that numba has compiled
        if plain is not None and plain.__code__.co_filename != own:
            found.update(_files(plain))
    return sorted(found)
