"""The sockets on which processes wait for others, as Linux lists them."""

import collections
import ipaddress
import os
import pathlib
import subprocess
import time
from typing import Dict, List

from workspaces import TIMEOUT

LISTENING = '0A'
PROC = pathlib.Path('/proc')


def family(process: int) -> List[int]:
    """A process, all that it started, and so on."""
    children: Dict[int, List[int]] = collections.defaultdict(list)
    for path in PROC.glob('[0-9]*/stat'):
        try:
            children[int(path.read_text().rpartition(')')[2].split()[1])].append(int(path.parent.name))
        except OSError:
            pass  # it has ended
    found = [process]
    for pid in found:
        found += children[pid]
    return found


def open_to_others(process: int) -> Dict[str, int]:
    """By the name of each program of a family that listens: how many of its sockets another machine can reach.

    The XML-RPC server of roscpp, of which a node has one, listens on all interfaces, whatever ROS_HOSTNAME is.
    """
    reachable = {}
    for table in ('tcp', 'tcp6'):
        for line in (PROC / 'net' / table).read_text().splitlines()[1:]:
            fields = line.split()
            words = bytes.fromhex(fields[1].partition(':')[0])
            octets = b''.join(words[start:start + 4][::-1] for start in range(0, len(words), 4))
            if fields[3] == LISTENING:
                reachable[f'socket:[{fields[9]}]'] = not ipaddress.ip_address(octets).is_loopback
    found = {}
    for pid in family(process):
        try:
            words = (PROC / str(pid) / 'cmdline').read_text().split('\0')
            links = [os.readlink(str(link)) for link in (PROC / str(pid) / 'fd').iterdir()]
        except OSError:
            continue
        sockets = [reachable[link] for link in links if link in reachable]
        if sockets:
            found[os.path.basename(words[1] if 'python' in words[0] else words[0])] = sum(sockets)
    return found


def wait_for(process: subprocess.Popen, programs: Dict[str, int]) -> None:
    """Wait until these programs of a family listen, and this many sockets of each are open to others."""
    deadline = time.monotonic() + 3.0 * TIMEOUT
    while not programs.items() <= open_to_others(process.pid).items():
        assert time.monotonic() < deadline, f'{open_to_others(process.pid)} instead of {programs}'
        assert process.poll() is None, 'it has ended'
        time.sleep(0.2)
