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

from rumba_evaluation.submissions import keeper

MEGABYTE = 1_000_000
FILE, DATA = 256 * MEGABYTE, 2_000 * MEGABYTE  # [bytes] of one file, and of the data of one process
SYSTEM = ('/usr', '/bin', '/sbin', '/lib', '/lib32', '/lib64', '/libx32', '/etc', '/opt')
TRIAL_PATIENCE = 20.0  # [s] of the wall clock
# Of a node: its log file is not for it to choose, and roslaunch names one that it cannot see.
WITHOUT_LOG = 'for each; do shift; case $each in __log:=*) ;; *) set -- "$@" "$each" ;; esac; done'
LIMITED = f'cd "$1" && shift && ulimit -c 0 && ulimit -f {FILE // 512} && ulimit -d {DATA // 1000} && exec "$@"'
# Ends what a command leaves behind. By its path: a module would be looked for in the present folder first.
KEEPER = (sys.executable, keeper.__file__)


class Plain:
    """No sandbox: all runs as the user who marks, and nothing is hidden; what a test has started ends with it."""

    is_closed = False

    def around_test(self, command: Sequence[str]) -> List[str]:
        """The command that runs a test, or a build."""
        return [*KEEPER, *command]

    def around_build(self, command: Sequence[str], own: str) -> List[str]:
        """The command that builds a submission in the folder that it owns."""
        return self.around_test(self.around_node(command, own))

    def around_node(self, command: Sequence[str], own: str) -> List[str]:
        """The command that runs a node of a submission, which owns a folder."""
        return ['sh', '-c', LIMITED, 'sh', own, *command]


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
        # What bwrap itself gets, a program in the sandbox could read in /proc/1.
        found = clean({'PATH': os.environ['PATH']}, [
            'bwrap', '--die-with-parent', '--unshare-user', '--unshare-pid', '--unshare-ipc', '--cap-drop', 'ALL',
            *options])
        for path in SYSTEM:
            found += (['--symlink', os.readlink(path), path] if os.path.islink(path) else
                      ['--ro-bind-try', path, path])
        found += ['--proc', '/proc', '--dev', '/dev', '--bind', f'{own}/shm', '/dev/shm', '--bind', f'{own}/tmp',
                  '/tmp', '--dir', '/run', '--dir', '/var']
        for path in self._visible:
            found += ['--ro-bind', path, path]
        for path in self._hidden:
            found += ['--tmpfs', path]
        return [*found, '--bind', own, own, 'sh', '-c', LIMITED, 'sh', own, *command]


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


def clean(environment: Mapping[str, str], command: Sequence[str]) -> List[str]:
    """The command that runs another one in an environment, of which nothing counts before: it may be hostile too."""
    return ['env', '-i', *(f'{name}={value}' for name, value in sorted(environment.items())), *command]


def script(command: Sequence[str], passed_on: Iterable[str]) -> str:
    """A shell script that runs a command with the arguments of the script but for __log.

    Args:
        command: what `clean` has made, maybe in another such command.
        passed_on: names of variables of the script that it gets too.
    """
    passed = ' '.join(f'${{{name}:+"{name}=${name}"}}' for name in passed_on)
    words = ' '.join(f'-i {passed}' if word == '-i' else shlex.quote(word) for word in command)
    return '\n'.join(['#!/bin/sh', WITHOUT_LOG, f'exec {words} "$@"', ''])


def _is_below(path: str, folders: Iterable[str]) -> bool:
    return any(f'{path}/'.startswith(f'{folder}/') for folder in folders)
