"""The kernel, compiled by numba: the same functions with the same results, about a hundred times faster.

Compiled functions can call only compiled functions, and compiled code is cached until the contents of the source file
change. So the file of the kernel is executed a second time, as a separate module in which every function is replaced by
its compiled version. `batch` calls the kernel: its copy calls the compiled one, and its cache also lasts only until the
file of the kernel changes. Code from the cache loads in a fraction of a second; compiling takes some seconds. All of
that waits for the first use of `fast` or `many`, and so does the import of numba, which takes as long as that of rospy:
a node that refuses its input, or prints its help, needs none of it.

numba caches beside the source file, or in the user's home if that folder cannot be written. If neither can, or the
cache is damaged, or the disk is full, the kernel is compiled at each start.
"""

import contextlib
import functools
import hashlib
import importlib.util
import inspect
import os
import sys
import threading
from typing import Any, Callable, List

from rumba_sim.model import batch, kernel
from rumba_sim.model.errors import one_line


def _compiled(name: str, path: str, **options: Any) -> Any:
    """The module of a source file with all its functions compiled, with options of numba."""
    import numba
    spec = importlib.util.spec_from_file_location(f'{__name__}_{name}', path)
    if spec is None or spec.loader is None:
        raise ImportError(f'{path} is not a Python module')
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # numba looks for the module there when it loads code from its cache
    spec.loader.exec_module(module)
    for name, function in inspect.getmembers(module, inspect.isfunction):
        setattr(module, name, _cached(numba.njit(function, **options), path))
    return module


def _compiled_kernel() -> Any:
    return _compiled('kernel', kernel.__file__)


def _compiled_batch() -> Any:
    """The functions of `batch`, which call the compiled kernel, and let other threads work meanwhile."""
    module = _compiled('batch', batch.__file__, nogil=True)
    module.kernel = fast.module
    for _, function in inspect.getmembers(module, lambda member: isinstance(getattr(member, '_cache', None), _Cache)):
        function._cache.depends_on(batch.__file__, kernel.__file__)
    return module


def _cached(function: Any, path: str) -> Any:
    """A compiled function of a source file with its cache, if there is a place for one."""
    import numba
    if not (numba.config.CACHE_DIR or os.access(os.path.dirname(path), os.W_OK) or _knows_home()):
        _say('no home folder is known')  # numba would take ~ for the name of a folder here, and make it
        return function
    try:
        function.enable_caching()
    except (RuntimeError, OSError) as exc:
        _say(str(exc))
    else:
        function._cache = _Cache(function._cache)
        function._cache.depends_on(path)
    return function


def _knows_home() -> bool:
    return os.path.isabs(os.environ.get('XDG_CACHE_HOME') or os.path.expanduser('~'))


class _Cache:
    """A cache of numba whose errors are no reason to fail."""

    def __init__(self, cache: Any) -> None:
        self._cache = cache

    def __getattr__(self, name: str) -> Any:
        return getattr(self._cache, name)

    def depends_on(self, *paths: str) -> None:
        """Count what is in the cache as out of date once one of these files has other contents.

        numba would go by their time: then a copy of the files would need compiling again, as an installation is one.
        """
        self._cache._cache_file._source_stamp = [_digest(path) for path in paths]

    def load_overload(self, *what: Any) -> Any:
        """The compiled code, or None if it is not in the cache or cannot be read."""
        try:
            return self._cache.load_overload(*what)
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
    """A compiled module, which is loaded when its first function is asked for."""

    def __init__(self, load: Callable[[], Any]) -> None:
        self._load = load
        self._module: Any = None

    @property
    def module(self) -> Any:
        """The module itself."""
        with _loading:  # another thread may ask too
            if self._module is None:
                self._module = self._load()
        return self._module

    def __getattr__(self, name: str) -> Any:
        function = getattr(self.module, name)
        setattr(self, name, function)
        return function


_said: List[str] = []
_loading = threading.RLock()  # the batch loads the kernel
fast: Any = _Fast(_compiled_kernel)
many: Any = _Fast(_compiled_batch)
