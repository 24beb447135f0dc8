"""Two commands of ./rumba in one checkout at the same time, as in two terminals: one waits for the other."""

import os
import subprocess

import pytest
from checkouts import commands, make_checkout, surroundings
from workspaces import BUILD_TIMEOUT

ALONE = '''
        execute_process(COMMAND mkdir "${CMAKE_BINARY_DIR}/alone" RESULT_VARIABLE code)
        if(code)
          message(FATAL_ERROR "another build is at work")
        endif()
        execute_process(COMMAND sleep 1)
        execute_process(COMMAND rmdir "${CMAKE_BINARY_DIR}/alone")'''


@pytest.fixture
def checkout(tmp_path):
    """A checkout with spaces in its path."""
    return make_checkout(tmp_path / 'a checkout')


def at_once(checkout, *command, **environment):
    """What two commands of the same kind say, and their exit codes."""
    both = [subprocess.Popen([checkout / 'rumba', *command], text=True, stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, env=surroundings(**environment)) for _ in range(2)]
    said = [process.communicate(timeout=BUILD_TIMEOUT)[0] for process in both]
    return said, [process.returncode for process in both]


def alone(lock, then='', before=''):
    """A command that fails beside another one of its kind, and otherwise goes on."""
    return f'#!/bin/sh\n{before}\nmkdir {lock} || exit 1\nsleep 0.5\n{then}\nrmdir {lock}\n'


def installed(but=':'):
    """A dpkg-query that finds all packages, unless a command fails."""
    return f'#!/bin/sh\n{but} || exit 1\nshift 3\nprintf \'installed %s\\n\' "$@"\n'


def test_one_installs_and_the_other_waits(checkout, tmp_path):
    asked = tmp_path / 'asked'
    path = commands(tmp_path / 'bin', **{
        'apt-get': alone(tmp_path / 'lock', f'echo "$1" >>{asked}',
                         'case "$*" in *print-uris*) exit 0 ;; esac'), 'apt-cache': '#!/bin/sh\n',
        'id': '#!/bin/sh\necho 0\n', 'dpkg-query': installed(f'grep -q install {asked}')})
    said, _ = at_once(checkout, 'lint', PATH=f'{path}:{os.environ["PATH"]}')
    assert asked.read_text().split() == ['update', 'install']
    assert sorted('rumba: installing' in lines for lines in said) == [False, True]
    assert not any('rumba: cannot' in lines for lines in said)


def test_one_makes_the_site_and_the_other_waits(checkout, tmp_path):
    source = checkout / 'rumba_evaluation' / 'src' / 'rumba'  # if there is a Sphinx
    source.mkdir(parents=True)
    (source / '__init__.py').touch()
    (checkout / 'docs').mkdir()
    (checkout / 'docs' / 'conf.py').touch()
    (checkout / 'index.rst').touch()
    path = commands(tmp_path / 'bin', **{
        'dpkg-query': installed(), 'sphinx-apidoc': '#!/bin/sh\n', 'sphinx-build': alone(tmp_path / 'lock')})
    said, codes = at_once(checkout, 'docs', PATH=f'{path}:{os.environ["PATH"]}')
    assert codes == [0, 0], said


def test_one_builds_and_the_other_waits(checkout, tmp_path):
    """They took each other's half-made links for packages that are gone, and deleted what was built."""
    with (checkout / 'sample' / 'CMakeLists.txt').open('a') as listing:
        listing.write(ALONE)
    said, codes = at_once(checkout, 'shell', 'true', XDG_CACHE_HOME=str(tmp_path / 'cache'))
    assert codes == [0, 0], said
    assert sorted('rumba: building' in lines for lines in said) == [False, True]
