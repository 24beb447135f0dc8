"""The kernel is compiled and works wherever its cache cannot be kept; one line says so."""

import fcntl
import os
import pathlib
import shutil
import subprocess
import sys

import programs
import pytest

from rumba_sim.model.compiling import compiled

MODEL = pathlib.Path(compiled.__file__).parents[1]
LINE = 'rumba_sim: the kernel is compiled anew, which takes some seconds: '
ADVICE = '; NUMBA_CACHE_DIR can name a writable folder for its cache\n'
TURN = 'from rumba_sim.model.compiling.compiled import fast; print(fast.wrap(7.0) == 7.0 - 6.283185307179586)'
# numba has read another environment; and Python's bytecode of a source would outlive a change within the same second.
BEGIN = 'import numba, sys; numba.config.reload_config(); sys.dont_write_bytecode = True; '
SMALL_FILES = 'import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0)); '
GEOMETRY = pathlib.Path('rumba_sim', 'model', 'kernel', 'geometry.py')
NOBODY = 'import os, pwd; os.access = lambda *_: False; pwd.getpwuid = {}.__getitem__; '
# numba 0.57 and later have the counters of who uses an array only once they compile something.
LATER = """try:
    from numba.core import cpu
except ImportError:  # numba before 0.49
    from numba.targets import cpu
class Later:
    initialize = staticmethod(lambda context: None)
cpu.rtsys = Later
"""
ARRAY = """import numpy
from rumba_sim.model.compiling.compiled import fast
print(fast.interpolated(numpy.ones((3, 3)), 1.5, 0.5)[0])
"""


@pytest.fixture
def source(tmp_path):
    """A copy of the model whose folders for compiled code cannot be made."""
    folder = tmp_path / 'src' / 'rumba_sim'
    folder.mkdir(parents=True)
    (folder / '__init__.py').touch()
    shutil.copytree(str(MODEL), str(folder / 'model'), ignore=shutil.ignore_patterns('__pycache__'))
    for place in {path.parent for path in (folder / 'model').rglob('*.py')}:
        (place / '__pycache__').touch()  # where numba wants a folder; root can write into any
    return tmp_path / 'src'


def run(source, code=TURN, here='/', **changes):
    """Result and error output of Python code that uses the copy, in a process that has loaded numba but no model."""
    environment = {name: value for name, value in os.environ.items()
                   if name not in ('NUMBA_CACHE_DIR', 'XDG_CACHE_HOME', 'HOME')}
    program = source.parent / 'program'
    program.write_text(f'#!/usr/bin/env python3\n{BEGIN}{code}\n')
    process = programs.start_script(program, libraries=['numba_at_work'], stdout=subprocess.PIPE,
                                    stderr=subprocess.PIPE, cwd=str(here), universal_newlines=True,
                                    env={**environment, 'PYTHONPATH': str(source), **changes})
    return process.communicate(timeout=300.0)


def test_if_neither_the_install_nor_the_home_can_be_written_the_kernel_works_without_a_cache(source):
    out, error = run(source, HOME='/dev/null/home')
    assert out == 'True\n'
    assert error.startswith(LINE + 'cannot cache function') and error.count('\n') == 1


def test_if_there_is_a_place_for_the_cache_nothing_is_said_and_it_is_used(source, tmp_path):
    for _ in range(2):
        assert run(source, HOME=str(tmp_path / 'home')) == ('True\n', '')
    assert list((tmp_path / 'home').rglob('*.nbc'))


def test_code_from_the_cache_works_with_a_numba_that_has_counters_of_arrays_only_once_it_compiles(tmp_path):
    environment = {**os.environ, 'PYTHONPATH': str(MODEL.parents[1]), 'NUMBA_CACHE_DIR': str(tmp_path)}
    for code in (ARRAY, LATER + ARRAY):  # without the counters, a process ends by a segmentation fault
        process = subprocess.run([sys.executable, '-c', code], env=environment, stdout=subprocess.PIPE, check=True)
        assert process.stdout == b'1.0\n'


def test_the_advice_helps(source, tmp_path):
    assert run(source, HOME='/dev/null/home', NUMBA_CACHE_DIR=str(tmp_path / 'cache')) == ('True\n', '')
    assert run(source, NOBODY + TURN, NUMBA_CACHE_DIR=str(tmp_path / 'cache')) == ('True\n', '')


def turned_around(source, path):
    """Copy the model to a folder, with an error in its kernel, and with a file of the same size and time."""
    shutil.copytree(str(source), str(path), symlinks=True)
    changed, original = path / GEOMETRY, source / GEOMETRY
    text = original.read_text()
    changed.write_text(text.replace('return angle if -math.pi < angle', 'return angle if -math.pi > angle'))
    os.utime(str(changed), ns=(original.stat().st_atime_ns, original.stat().st_mtime_ns))
    assert changed.read_text() != text and changed.stat().st_size == original.stat().st_size


ANGLE = 'from rumba_sim.model.compiling.compiled import fast; print(fast.wrap(-4.0) == -4.0)'


@pytest.mark.parametrize('place', ['HOME', 'NUMBA_CACHE_DIR'])
def test_two_copies_of_the_model_that_share_a_place_for_the_cache_share_no_code(source, tmp_path, place):
    turned_around(source, tmp_path / 'other')
    where = {'HOME': '/dev/null/home', place: str(tmp_path / 'place')}
    for _ in range(2):  # the second time from the cache
        assert run(source, ANGLE, **where) == ('False\n', '')
        assert run(tmp_path / 'other', ANGLE, **where) == ('True\n', '')


def test_what_was_cached_of_a_source_that_has_changed_is_not_used(source, tmp_path):
    home = {'HOME': str(tmp_path / 'home')}
    assert run(source, ANGLE, **home) == ('False\n', '')
    turned_around(source, tmp_path / 'other')
    shutil.copy2(str(tmp_path / 'other' / GEOMETRY), str(source / GEOMETRY))
    assert run(source, ANGLE, **home) == ('True\n', '')


def test_a_source_with_another_time_and_the_same_contents_needs_no_compiling(source, tmp_path):
    """As an installed copy has it."""
    home = {'HOME': str(tmp_path / 'home')}
    assert run(source, **home) == ('True\n', '')
    cached = {path: path.stat().st_mtime_ns for path in (tmp_path / 'home').rglob('*.nb[ci]')}
    os.utime(str(source / GEOMETRY), ns=(0, 1_000_000_000))
    assert run(source, **home) == ('True\n', '')
    assert cached == {path: path.stat().st_mtime_ns for path in (tmp_path / 'home').rglob('*.nb[ci]')}


SMALL = {  # the real ones take a minute
    'kernel/__init__.py': '',
    'kernel/part/__init__.py': '',
    'kernel/part/twice.py': 'def twice(x):\n    return 2.0 * x\n',
    'kernel/four_times.py': 'from rumba_sim.model.kernel.part.twice import twice\n\n\ndef four_times(x):\n'
                            '    return twice(twice(x))\n',
    'compiling/batch.py': 'from rumba_sim.model.kernel import four_times\n\n\ndef eight_times(x):\n'
                          '    return 2.0 * four_times.four_times(x)\n'}


@pytest.mark.parametrize('name, call, changed, result', [
    ('fast', 'four_times(3.0)', 'kernel/part/twice.py', 27.0),
    ('many', 'eight_times(1.5)', 'kernel/part/twice.py', 27.0),
    ('many', 'eight_times(1.5)', 'compiling/batch.py', 18.0)])
def test_what_was_cached_does_not_outlive_a_change_of_a_file_that_it_depends_on(
        source, tmp_path, name, call, changed, result):
    model, home = source / 'rumba_sim' / 'model', {'HOME': str(tmp_path / 'home')}
    shutil.rmtree(str(model / 'kernel'))
    (model / 'kernel' / 'part').mkdir(parents=True)
    for path, text in SMALL.items():
        (model / path).write_text(text)
    code = f'from rumba_sim.model.compiling.compiled import {name}; print({name}.{call})'
    for _ in range(2):  # the second time from the cache
        assert run(source, code, **home) == ('12.0\n', '')
    (model / changed).write_text(SMALL[changed].replace('2.0', '3.0'))
    assert run(source, code, **home) == (f'{result}\n', '')


CHAIN = {  # each calls the one before
    'twice': 'return 2.0 * x', 'four_times': 'return twice(twice(x))', 'eight_times': 'return 2.0 * four_times(x)'}


def write_chain(folder, factor):
    """Write three modules with one compiled function each, of which the first multiplies by a factor."""
    folder.mkdir(exist_ok=True)
    before = ''
    for name, body in CHAIN.items():
        body = body.replace('2.0 * x', f'{factor} * x')
        (folder / f'{name}.py').write_text(f'from rumba_sim.model.compiling.jit import compiled\n{before}\n\n'
                                           f'@compiled\ndef {name}(x):\n    {body}\n')
        before = f'from {name} import {name}\n'


def test_what_was_cached_by_the_decorator_does_not_outlive_a_change_of_what_it_calls(source, tmp_path):
    own, home = tmp_path / 'own', {'HOME': str(tmp_path / 'home')}
    code = f'import sys; sys.path.append({str(own)!r}); from eight_times import eight_times; print(eight_times(1.5))'
    write_chain(own, 2.0)
    for _ in range(2):  # the second time from the cache
        assert run(source, code, **home) == ('12.0\n', '')
    write_chain(own, 3.0)
    assert run(source, code, **home) == ('27.0\n', '')


def test_a_full_disk_does_no_harm(source, tmp_path):
    out, error = run(source, SMALL_FILES + TURN, HOME=str(tmp_path / 'home'))
    assert out == 'True\n'
    assert error.startswith(LINE + str(tmp_path / 'home')) and error.endswith('File too large' + ADVICE)
    assert error.count('\n') == 1


@pytest.mark.parametrize('pattern, content', [('*.nbi', b''), ('*.nbi', b'damaged'), ('*.nbc', b'damaged')])
def test_a_damaged_cache_is_made_anew(source, tmp_path, pattern, content):
    home = {'HOME': str(tmp_path / 'home')}
    assert run(source, **home) == ('True\n', '')
    for path in (tmp_path / 'home').rglob(pattern):
        path.write_bytes(content)
    out, error = run(source, **home)
    assert out == 'True\n' and error.startswith(LINE) and error.count('\n') == 1
    assert run(source, **home) == ('True\n', '')


def test_without_a_home_no_folder_named_like_one_is_made(source, tmp_path):
    here = tmp_path / 'here'
    here.mkdir()
    out, error = run(source, NOBODY + TURN, here)
    assert (out, error) == ('True\n', LINE + 'no home folder is known' + ADVICE)
    assert not list(here.iterdir())


class Files:
    """The files of a cache, which look at each use whether another process could read or write them."""

    def __init__(self, lock):
        self._lock = lock
        self.seen = []

    def load(self, key):
        self._look()
        return key

    def save(self, key, data):
        self._look()

    def flush(self):
        self._look()

    def _look(self):
        allowed = []
        for name, kind in (('read', fcntl.LOCK_SH), ('write', fcntl.LOCK_EX)):
            with open(self._lock, 'ab') as file:
                try:
                    fcntl.flock(file, kind | fcntl.LOCK_NB)
                    allowed.append(name)
                except BlockingIOError:
                    pass
        self.seen.append(allowed)


def test_one_process_writes_into_a_cache_while_no_other_reads_or_writes(tmp_path):
    files = Files(tmp_path / 'lock')
    locked = compiled._LockedFiles(files, str(tmp_path / 'lock'))
    locked.save('key', 'data')
    assert locked.load('key') == 'key'
    locked.flush()
    assert files.seen == [[], ['read'], []]


def test_a_cache_in_a_folder_that_is_not_there_is_used_without_a_lock(tmp_path):
    assert compiled._LockedFiles(Files(tmp_path / 'lock'), '/nowhere/lock').load('key') == 'key'


def test_the_caches_of_the_kernel_and_of_the_batch_are_locked():
    for function in (compiled.fast.wrap, compiled.many.advance):
        assert isinstance(function._cache._cache_file, compiled._LockedFiles)
