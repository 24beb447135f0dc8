"""The install rule that compiles the kernel finds what was installed, also if DESTDIR puts it elsewhere."""

import os
import pathlib
import shutil
import subprocess

import pytest

TEMPLATE = pathlib.Path(__file__).parents[2] / 'cmake' / 'warm_up_installed.cmake.in'


@pytest.mark.parametrize('destdir, folder', [
    (None, '/opt/my ros/lib/python'), ('/tmp/x', '/tmp/x/opt/my ros/lib/python')])
def test_the_kernel_is_compiled_where_it_was_installed(tmp_path, destdir, folder):
    python = tmp_path / 'python'
    python.write_text('#!/bin/sh\necho "$PYTHONPATH: $*"\n')
    python.chmod(0o755)
    text = TEMPLATE.read_text()
    for name, value in (('CMAKE_COMMAND', shutil.which('cmake')), ('PYTHON_EXECUTABLE', str(python)),
                        ('CATKIN_GLOBAL_PYTHON_DESTINATION', 'lib/python'), ('module', 'rumba_sim.model.warm_up')):
        text = text.replace(f'@{name}@', value)
    script = tmp_path / 'script.cmake'
    script.write_text(text)
    environment = {name: value for name, value in os.environ.items() if name != 'DESTDIR'}
    environment['PYTHONPATH'] = '/of/others'
    if destdir:
        environment['DESTDIR'] = destdir
    done = subprocess.run(['cmake', '-DCMAKE_INSTALL_PREFIX=/opt/my ros', '-P', str(script)], env=environment,
                          stdout=subprocess.PIPE, universal_newlines=True, check=True)
    assert done.stdout == f'{folder}:/of/others: -m rumba_sim.model.warm_up\n'
