"""What a submission can see and change: a sandbox made by bubblewrap, or none where the system allows none.

Around a whole test there is a network of its own, with nothing but the loopback. In it, each node of the submission has
a sandbox: it sees the system and the packages of ROS, and cannot change them; it sees no other processes, no hidden
tests, and no other submissions. A build is in such a sandbox too, without any network.
"""

import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from typing import Iterable, List, Mapping, Sequence

MEGABYTE = 1_000_000
FILE, DATA = 256 * MEGABYTE, 2_000 * MEGABYTE  # [bytes] of one file, and of the data of one process
SYSTEM = ('/usr', '/bin', '/sbin', '/lib', '/lib32', '/lib64', '/libx32', '/etc', '/opt')
TRIAL_PATIENCE = 20.0  # [s] of the wall clock
# Of a node: its log file is not for it to choose, and roslaunch names one that it cannot see.
WITHOUT_LOG = 'for each; do shift; case $each in __log:=*) ;; *) set -- "$@" "$each" ;; esac; done'
LIMITED = f'ulimit -c 0 && ulimit -f {FILE // 512} && ulimit -d {DATA // 1000} && exec "$@"'


KEEPER = (sys.executable, '-m', 'rumba_evaluation.submissions.keeper')  # ends what a command leaves behind


class Plain:
    """No sandbox: all runs as the user who marks, and nothing is hidden; what a test has started ends with it."""

    is_closed = False

    def around_test(self, command: Sequence[str]) -> List[str]:
        """The command that runs a test, or a build."""
        return [*KEEPER, *command]

    def around_build(self, command: Sequence[str], own: str) -> List[str]:
        """The command that builds a submission in the folder that it owns."""
        return self.around_test(['sh', '-c', LIMITED, 'sh', *command])

    def around_node(self, command: Sequence[str], own: str) -> List[str]:
        """The command that runs a node of a submission, which owns a folder."""
        return ['sh', '-c', LIMITED, 'sh', *command]


class Bubblewrap:
    """A sandbox."""

    is_closed = True

    def __init__(self, visible: Iterable[str], hidden: Iterable[str]) -> None:
        """Show folders that are no part of the system, but not what is in others, which may be below them."""
        self._visible = sorted({path for each in visible for path in (each, os.path.realpath(each))
                                if os.path.isdir(path) and not _is_below(path, SYSTEM)})
        aims = {os.path.realpath(path) for path in hidden if os.path.isdir(path)}
        self._hidden = sorted({path + aim[len(os.path.realpath(path)):] for path in self._visible for aim in aims
                               if _is_below(aim, [os.path.realpath(path)])})

    def around_test(self, command: Sequence[str]) -> List[str]:
        """The command that runs a test: what is not trusted in it is in a sandbox of its own."""
        return [*KEEPER, 'bwrap', '--die-with-parent', '--unshare-net', '--unshare-ipc', '--dev-bind', '/', '/',
                *command]

    def around_build(self, command: Sequence[str], own: str) -> List[str]:
        """The command that builds a submission in the folder that it owns."""
        return [*KEEPER, *self._closed(['--unshare-net'], command, own)]

    def around_node(self, command: Sequence[str], own: str) -> List[str]:
        """The command that runs a node of a submission, which owns a folder; it has the network of its test."""
        return self._closed([], command, own)

    def _closed(self, options: Sequence[str], command: Sequence[str], own: str) -> List[str]:
        found = ['bwrap', '--die-with-parent', '--unshare-user', '--unshare-pid', '--unshare-ipc', '--cap-drop',
                 'ALL', *options]
        for path in SYSTEM:
            found += (['--symlink', os.readlink(path), path] if os.path.islink(path) else
                      ['--ro-bind-try', path, path])
        found += ['--proc', '/proc', '--dev', '/dev', '--bind', f'{own}/shm', '/dev/shm', '--bind', f'{own}/tmp',
                  '/tmp', '--dir', '/run', '--dir', '/var']
        for path in self._visible:
            found += ['--ro-bind', path, path]
        for path in self._hidden:
            found += ['--tmpfs', path]
        return [*found, '--bind', own, own, '--chdir', own, 'sh', '-c', LIMITED, 'sh', *command]


def trouble() -> str:
    """Why there can be no sandbox on this system, in words; empty if there can."""
    if shutil.which('bwrap') is None:
        return 'bubblewrap is not installed'
    sandbox = Bubblewrap([], [])
    with tempfile.TemporaryDirectory() as own:
        for name in ('shm', 'tmp'):
            os.mkdir(os.path.join(own, name))
        done = subprocess.run(sandbox.around_test(sandbox.around_node(['true'], own)), stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=TRIAL_PATIENCE, check=False)
    told = done.stdout.decode(errors='replace').strip().split('\n')[-1]
    return told or f'bwrap ended with exit code {done.returncode}' if done.returncode else ''


def script(environment: Mapping[str, str], passed_on: Iterable[str], command: Sequence[str]) -> str:
    """A shell script that runs a command with the arguments of the script but for __log.

    Args:
        environment: of the command.
        passed_on: names of what it gets too from the environment of the script.
        command: with its arguments.
    """
    given = [shlex.quote(f'{name}={value}') for name, value in sorted(environment.items())]
    given += [f'${{{name}:+"{name}=${name}"}}' for name in passed_on]
    words = ' '.join(map(shlex.quote, command))
    return '\n'.join(['#!/bin/sh', WITHOUT_LOG, f'exec env -i {" ".join(given)} {words} "$@"', ''])


def _is_below(path: str, folders: Iterable[str]) -> bool:
    return any(f'{path}/'.startswith(f'{folder}/') for folder in folders)
