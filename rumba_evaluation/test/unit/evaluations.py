"""Shared by tests of evaluations: simple strategies, a map in a file, results without running a mission."""

import sys

import numpy as np
from sheets import B, W, write

from rumba_cleaning import strategies
from rumba_cleaning.outcome import Outcome
from rumba_evaluation.trials.cases import Case, Result


def register_simple_strategies(monkeypatch):
    """Register the strategies of `simple_strategies` during one test."""
    strategies.known()
    monkeypatch.setattr(strategies, '_factories', dict(strategies._factories))
    monkeypatch.delitem(sys.modules, 'simple_strategies', raising=False)
    strategies.load('simple_strategies')


def small_map(folder):
    """Write a map into a folder: an empty room of 1.5 m x 1 m with a dock; returns its path."""
    pixels = np.full((22, 32), B, np.uint8)
    pixels[1:-1, 1:-1] = W
    return write(folder, pixels, resolution=0.05, origin=[-0.05, -0.05, 0.0], dock=[1.32, 0.5, 0.0])


def result(curve=(), **changes):
    """A result; T is 100 s."""
    values = dict(
        outcome=Outcome.SUCCEEDED, message='99.0 % swept', area=5.1, ideal_time=100.0, coverage=0.99, dirt_left=0.1,
        time=150.0, charging_time=0.0, charges=0, distance=40.0, turns=12.0, collisions=3, charge_used=0.1,
        energy=1.5, energy_per_area=0.3, docked=1, penetrated=False, x=1.0, y=2.0, theta=0.5, ticks=7500,
        digest='5f1c', curve=tuple(curve))
    return Result(**{**values, **changes})


def steady(multiple, until=99, **changes):
    """The result of a mission that sweeps at a constant rate, 100 % in a multiple of T."""
    return result([percent * multiple for percent in range(1, until + 1)], **changes)


def case(**changes):
    """A case."""
    return Case(**{**dict(map='room', strategy='bounce', seed=1, robots=1), **changes})
