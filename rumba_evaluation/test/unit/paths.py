"""Shared by tests of paths: files of paths, paths without a file, and rides along them."""

import math

import numpy as np
from rooms import quiet, room

from rumba_evaluation.scoring.drawn_path import drawn_path
from rumba_evaluation.scoring.ride import AsDrawn, Driven

WIDTH = quiet().brush.width
SPEED, TURN_RATE = 0.3, quiet().drive.max_turn_rate
SQUARE = [(1.0, 1.0), (3.0, 1.0), (3.0, 3.0), (1.0, 3.0), (1.0, 1.0)]


def bare():
    """An empty room of 4 m x 4 m."""
    return room(4.0, 4.0, 0.05)


def path(points, headings=None, times=None):
    """A path through points."""
    arrays = [None if values is None else np.array(values, float) for values in (headings, times)]
    return drawn_path('a path', [f'pose {number}' for number in range(1, len(points) + 1)],
                      np.array(points, float).reshape(-1, 2), *arrays)


def rode(kind, points, plan=None, bound=12.0, **options):
    """A ride along points, to its end."""
    ride = kind(plan or bare(), path(points, options.pop('headings', None), options.pop('times', None)), quiet(),
                **options)
    ride.run(bound)
    return ride


def drawn(points, **options):
    """A ride exactly as drawn."""
    return rode(AsDrawn, points, **options)


def driven(points, **options):
    """A ride with the limits of a robot."""
    return rode(Driven, points, **options)


def spiral(pitch=0.2, inner=0.6, outer=1.6, centre=(2.0, 2.0)):
    """Points of an Archimedean spiral r = b * angle, 1 cm apart; and its length and the angle that it turns.

    The closed forms are those of any table of curves.
    """
    b = pitch / (2.0 * math.pi)
    angles = np.arange(inner / b, outer / b, 0.01 / outer)
    points = np.stack([centre[0] + b * angles * np.cos(angles), centre[1] + b * angles * np.sin(angles)], axis=1)
    lengths = [0.5 * b * (angle * math.sqrt(1.0 + angle ** 2) + math.asinh(angle)) for angle in angles[[0, -1]]]
    bearings = [angle + math.atan(angle) for angle in angles[[0, -1]]]
    return points, lengths[1] - lengths[0], bearings[1] - bearings[0]
