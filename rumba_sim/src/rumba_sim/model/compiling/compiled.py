"""The kernel, compiled by numba: the same functions with the same results, about a hundred times faster.

Compiled functions can call only compiled functions. So each module of the kernel has a twin, which differs from it only
in that all functions of the kernel, its own and those that it imports, are compiled. `batch` calls the kernel: its twin
calls the twins of the kernel.

Compiled code is cached until the contents of any file of the kernel change; that of `batch`, also until `batch` does.
Code from the cache loads in a fraction of a second; compiling takes some seconds. All of that waits for the first use
of `fast` or `many`, and so does the import of numba, which takes as long as that of rospy: a node that refuses its
input, or prints its help, needs none of it.

numba caches beside the source file, or in the user's home if that folder cannot be written. If neither can, or the
cache is damaged, or the disk is full, the kernel is compiled at each start.
"""

import contextlib
import fcntl
import functools
import hashlib
import importlib
import inspect
import os
import pkgutil
import sys
import threading
from types import FunctionType, ModuleType
from typing import Any, Callable, Dict, Iterator, List, Mapping, Sequence

from rumba_sim.model import kernel
from rumba_sim.model.common.errors import one_line
from rumba_sim.model.compiling import batch

Twins = Dict[Any, Any]  # of modules and of their functions, by those
LOCK = 'lock'  # file in the folder of a cache


def kernel_modules() -> List[ModuleType]:
    """The modules of the kernel as plain Python."""
    return [importlib.import_module(module.name)
            for module in pkgutil.walk_packages(kernel.__path__, f'{kernel.__name__}.')]


def _kernel_files() -> List[str]:
    return [inspect.getfile(module) for module in (kernel, *kernel_modules())]


def _compiled_kernel() -> Twins:
    return _twins(kernel_modules(), _kernel_files(), {})


def _compiled_batch() -> Twins:
    """The twin of `batch`, whose functions let other threads work meanwhile."""
    return _twins([batch], [batch.__file__, *_kernel_files()], fast.twins, nogil=True)


def _twins(modules: Sequence[ModuleType], paths: Sequence[str], others: Mapping[Any, Any], **options: Any) -> Twins:
    """The twins of modules and of their functions, compiled with options of numba.

    Args:
        modules: they may import each other and each other's functions.
        paths: the files that the compiled code depends on.
        others: twins of what else they import and call.
    """
    import numba
    twins: Twins = {module: ModuleType(module.__name__) for module in modules}
    for module in modules:
        names = twins[module].__dict__
        names.update(module.__dict__)
        for function in functions_of(module):
            copy = FunctionType(function.__code__, names, argdefs=function.__defaults__)
            twins[function] = _cached(numba.njit(copy, **options), *paths)
    known = {**others, **twins}
    for module in modules:
        twins[module].__dict__.update({name: known[value] for name, value in module.__dict__.items()
                                       if isinstance(value, (FunctionType, ModuleType)) and value in known})
    return twins


def functions_of(module: ModuleType) -> List[FunctionType]:
    """The functions that a module defines, without those that it imports."""
    return [function for _, function in inspect.getmembers(module, inspect.isfunction)
            if function.__module__ == module.__name__]


def _cached(function: Any, *paths: str) -> Any:
    """A compiled function with its cache, if there is a place for one; it depends on source files."""
    import numba
    folder = os.path.dirname(function.py_func.__code__.co_filename)
    if not (numba.config.CACHE_DIR or os.access(folder, os.W_OK) or _knows_home()):
        _say('no home folder is known')  # numba would take ~ for the name of a folder here, and make it
        return function
    try:
        function.enable_caching()
    except (RuntimeError, OSError) as exc:
        _say(str(exc))
    else:
        function._cache = _Cache(function._cache, paths)
    return function


def _knows_home() -> bool:
    return os.path.isabs(os.environ.get('XDG_CACHE_HOME') or os.path.expanduser('~'))


class _Cache:
    """A cache of numba whose errors are no reason to fail."""

    def __init__(self, cache: Any, paths: Sequence[str]) -> None:
        """Count what is in the cache as out of date once one of these files has other contents.

        numba would go by their time: then a copy of the files would need compiling again, as an installation is one.
        """
        self._cache = cache
        cache._cache_file._source_stamp = [_digest(path) for path in paths]
        cache._cache_file = _LockedFiles(cache._cache_file, os.path.join(cache.cache_path, LOCK))

    def __getattr__(self, name: str) -> Any:
        return getattr(self._cache, name)

    def load_overload(self, *what: Any) -> Any:
        """The compiled code, or None if it is not in the cache or cannot be read.

        Before, numba's own method loads all that it takes to compile anything, for a fifth of a second: whatever is
        not in the cache is compiled all the same, since the compiler begins with that too. Of all that, the code needs
        the functions by which it counts who uses an array: numba 0.56 has them ready anyway, later ones have not.
        """
        try:
            from numba.core.runtime import rtsys
        except ImportError:  # numba before 0.49
            from numba.runtime import rtsys
        _, context = what
        rtsys.initialize(context)
        try:
            return self._cache._load_overload(*what)
        except Exception as exc:  # whatever reading a damaged file leads to
            _say(f'{self.cache_path}: {exc}')
            with contextlib.suppress(OSError):
                self._cache.flush()
            return None

    def save_overload(self, *what: Any) -> None:
        """Keep compiled code for the next start, if that is possible."""
        try:
            self._cache.save_overload(*what)
        except Exception as exc:
            _say(f'{self.cache_path}: {exc}')


class _LockedFiles:
    """The files of a cache, which one process writes while no other reads or writes them.

    numba names the file of compiled code by what it has read in the index. Two processes that compile one function for
    different arguments at the same time would give both the same name, and later run the code of one for the other.
    """

    def __init__(self, files: Any, lock: str) -> None:
        """Guard files by a lock, a path."""
        self._files, self._lock = files, lock

    def __getattr__(self, name: str) -> Any:
        return getattr(self._files, name)

    def load(self, key: Any) -> Any:
        """What is in the cache for a key; None if nothing is."""
        with self._locked(fcntl.LOCK_SH):
            return self._files.load(key)

    def save(self, key: Any, data: Any) -> None:
        """Put data into the cache."""
        with self._locked(fcntl.LOCK_EX):
            self._files.save(key, data)

    def flush(self) -> None:
        """Empty the cache."""
        with self._locked(fcntl.LOCK_EX):
            self._files.flush()

    @contextlib.contextmanager
    def _locked(self, kind: int) -> Iterator[None]:
        with contextlib.ExitStack() as until_done:
            with contextlib.suppress(OSError):  # in a folder that cannot be written nobody writes
                fcntl.flock(until_done.enter_context(open(self._lock, 'ab')), kind)
            yield


@functools.lru_cache(maxsize=None)
def _digest(path: str) -> str:
    with open(path, 'rb') as file:
        return hashlib.sha256(file.read()).hexdigest()


def _say(reason: str) -> None:
    """Say, once in a process, why the kernel does not come from a cache."""
    if not _said:
        _said.append(reason)
        print(f'rumba_sim: the kernel is compiled anew, which takes some seconds: {one_line(reason)}; '
              'NUMBA_CACHE_DIR can name a writable folder for its cache', file=sys.stderr)


class _Fast:
    """The compiled functions of modules by their names, which are loaded when the first is asked for."""

    def __init__(self, load: Callable[[], Twins]) -> None:
        self._load = load
        self._twins: Twins = {}

    @property
    def twins(self) -> Twins:
        """The twins of the modules and of their functions."""
        with _loading:  # another thread may ask too
            if not self._twins:
                self._twins = self._load()
        return self._twins

    def __getattr__(self, name: str) -> Any:
        for plain, twin in self.twins.items():
            if plain.__name__ == name:
                setattr(self, name, twin)
                return twin
        raise AttributeError(f'there is no compiled function {name!r}')


_said: List[str] = []
_loading = threading.RLock()  # the batch loads the kernel
fast: Any = _Fast(_compiled_kernel)
many: Any = _Fast(_compiled_batch)
