"""Maps, images and settings are read from regular files only; anything else is one line at once."""

import contextlib
import os
import signal
import socket

import pytest
from sheets import write

from rumba_sim.model.common import regular_file, yaml_file
from rumba_sim.model.common.errors import LONGEST, ConfigError, MapError
from rumba_sim.model.maps import map_file


@contextlib.contextmanager
def in_time():
    """Fail a test that waits for something that never comes."""
    def fail(*_):
        raise AssertionError('waits for ever')

    before = signal.signal(signal.SIGALRM, fail)
    signal.alarm(20)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


@pytest.fixture(params=[
    'a named pipe', 'a directory', 'a device', 'a socket', 'a link to a named pipe', 'a loop of links'])
def odd(request, tmp_path):
    """The path of something that is not a regular file, and how an error calls it."""
    path = tmp_path / 'odd'
    if request.param == 'a directory':
        path.mkdir()
    elif request.param == 'a device':
        path.symlink_to('/dev/zero')
    elif request.param == 'a socket':
        with socket.socket(socket.AF_UNIX) as listening:
            listening.bind(str(path))
    elif request.param == 'a loop of links':
        path.symlink_to(path)
        return path, 'Too many levels of symbolic links'
    else:
        os.mkfifo(str(tmp_path / 'pipe'))
        path.symlink_to(tmp_path / 'pipe')
        return path, 'is a named pipe: must be a regular file'
    return path, f'is {request.param}: must be a regular file'


def test_what_is_no_regular_file_is_refused_at_once_as_map_image_layer_and_settings(tmp_path, odd):
    path, message = odd
    for load in (lambda: map_file.load(path), lambda: map_file.load(write(tmp_path, image='odd')),
                 lambda: map_file.load(write(tmp_path, carpet='odd')),
                 lambda: yaml_file.read_mapping(str(path), MapError)):
        with in_time(), pytest.raises(MapError, match=rf'^({tmp_path}/flat\.yaml: \w+: )?{path}: {message}$'):
            load()


def test_a_named_pipe_that_appears_after_the_check_is_not_waited_for(tmp_path):
    os.mkfifo(str(tmp_path / 'pipe'))
    with in_time():
        with open(str(tmp_path / 'pipe'), 'rb', opener=regular_file._without_waiting) as pipe:
            assert pipe.read() == b''


@pytest.mark.parametrize('path', [5, 0, True, None, ['a'], {'a': 1}, b'a', 1.5, ''], ids=repr)
def test_what_is_no_path_is_refused_and_no_file_descriptor_is_closed(path):
    reading, writing = os.pipe()
    try:
        with in_time(), pytest.raises(ConfigError, match='^the path of a file is .*: must be text$'):
            yaml_file.read_mapping(reading if path == 5 else path, ConfigError)
        os.fstat(reading)
    finally:
        os.close(reading)
        os.close(writing)


@pytest.mark.parametrize('path, message', [
    ('flat\0.png', r'^flat\\x00.png: is not a path: .*embedded null (byte|character in path)$'),
    ('\ud800', r'^\\ud800: is not a path: '), ('x' * 3_000_000, '^xxx.*xxx: File name too long$'),
    ('\x1b[2J', r'^\\x1b\[2J: No such file or directory$')], ids=['null', 'surrogate', 'long', 'escape'])
def test_a_path_that_no_file_can_have_is_one_short_line(path, message):
    with pytest.raises(ConfigError, match=message) as caught:
        yaml_file.read_mapping(path, ConfigError)
    assert len(str(caught.value)) <= LONGEST
