"""Ports for masters of tests and of benches."""

import random
import socket

# Above well-known ones, and below those that Linux gives to whoever asks for any, also to each connection of a client:
# on a machine with many nodes, these may be taken between the choice and the start of the master, or its restart.
LOWEST, END = 12000, 32768


def free_port():
    """A port that nobody listens at."""
    while True:
        port = random.randrange(LOWEST, END)
        with socket.socket() as trial:
            try:
                trial.bind(('localhost', port))
            except OSError:
                continue
        return port
