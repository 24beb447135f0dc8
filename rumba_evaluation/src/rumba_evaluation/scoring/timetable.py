"""Where a robot is at each tick if it follows a drawn path exactly, whether or not a real robot could."""

from typing import Optional, Tuple

import numpy as np

from rumba_evaluation.scoring.drawn_path import LEAST_LENGTH, LONGEST, DrawnPath, PathError
from rumba_sim.model.kernel import Array

CORNER = 0.5  # [rad] a sharper one is turned on the spot, a bend of less while driving; our choice: 30 degrees
STILL = 1e-9  # [m] points nearer to each other are one
ASIDE = 0.5  # [rad] between heading and way: more is driven sideways; our choice
SLACK = 0.01  # [m/s]


def timetable(path: DrawnPath, speed: float, turn_rate: float, rate: float) -> Array:
    """Poses at all ticks, from the first pose to the last: float64 (any, 3) [m, m, rad].

    With the times of the path, the robot is at each pose at its time. Without, it drives at a constant speed, and turns
    on the spot at corners. Between two poses it goes straight, and its heading changes evenly. Without headings, it
    looks along the path.

    Args:
        path: the path.
        speed: where the path has no times [m/s].
        turn_rate: the same [rad/s].
        rate: ticks per second [Hz].

    Raises:
        PathError: it takes longer than a day.
    """
    points, headings, times = path.points, path.headings, path.times
    if headings is None:
        points, headings, times = _along(points, times)
    headings = np.unwrap(headings)
    if times is None:
        lengths, turns = np.hypot(*np.diff(points, axis=0).T), np.abs(np.diff(headings))
        times = np.concatenate([[0.0], np.cumsum(np.maximum(lengths / speed, turns / turn_rate))])
    if times[-1] > LONGEST:
        raise PathError(f'{path.source}: takes {times[-1]:.0f} s: must take a day at most')
    ticks = np.arange(int(np.ceil(times[-1] * rate - 1e-6)) + 1) / rate
    return np.stack([np.interp(ticks, times, values) for values in (*points.T, headings)], axis=1)


def beyond_robots(poses: Array, rate: float, fastest: float) -> str:
    """What of a drive no robot with two wheels can do, in words; empty if there is nothing.

    Args:
        poses: at all ticks, float64 (any, 3) [m, m, rad].
        rate: ticks per second [Hz].
        fastest: speed of its wheels [m/s].
    """
    moves, headings = np.diff(poses[:, :2], axis=0), 0.5 * (poses[1:, 2] + poses[:-1, 2])
    lengths = np.hypot(*moves.T)
    beside = np.abs(np.cos(headings) * moves[:, 1] - np.sin(headings) * moves[:, 0])
    aside = float(np.sum(lengths[beside > np.sin(ASIDE) * np.maximum(lengths, STILL)]))
    speed = float(np.max(lengths, initial=0.0)) * rate
    words = [f'{aside:.1f} m of it sideways'] if aside > LEAST_LENGTH else []
    if speed > fastest + SLACK:
        words.append(f'up to {speed:.1f} m/s')
    return f' ({", ".join(words)}, which no robot can do)' if words else ''


def _along(points: Array, times: Optional[Array]) -> Tuple[Array, Array, Optional[Array]]:
    """Points, headings and times of a path along which a robot looks ahead; corners become two poses at one point."""
    steps = np.diff(points, axis=0)
    moves = np.flatnonzero(np.hypot(*steps.T) > STILL)
    ahead = moves[np.searchsorted(moves, np.arange(len(steps))).clip(max=len(moves) - 1)]  # where it stands, look ahead
    bearings = np.unwrap(np.arctan2(steps[ahead, 1], steps[ahead, 0]))
    before, after = np.concatenate([bearings[:1], bearings]), np.concatenate([bearings, bearings[-1:]])
    is_bend = np.abs(after - before) <= CORNER
    before, after = np.where(is_bend, 0.5 * (before + after), before), np.where(is_bend, 0.5 * (before + after), after)
    twice = np.where(is_bend, 1, 2)
    headings = np.repeat(before, twice)
    headings[np.cumsum(twice) - 1] = after
    return np.repeat(points, twice, axis=0), headings, None if times is None else np.repeat(times, twice)
