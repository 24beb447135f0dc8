"""A trial: blows one after another on a fresh ground, and all questions after each of them."""

import contextlib
import pathlib
import tempfile

from stress import oracles, wire
from stress.ground import Ground


@contextlib.contextmanager
def ground(scenario, publishers):
    """A ground, as long as the block."""
    with tempfile.TemporaryDirectory(prefix='rumba_stress_') as folder:
        path = pathlib.Path(folder, 'ground')
        path.mkdir()
        with Ground(scenario, path, publishers) as started:
            oracles.check(started, 0)
            yield started


def strike(here, blow):
    """Strike one blow, and ask everything.

    Raises:
        Failure: the ground does not bear it.
    """
    try:
        blow.kind.strike(here, blow.chance, blow)
    except wire.WireError as error:
        oracles.explain(here, error)
    oracles.check(here, blow.inputs)
