"""From the frame of the map that a robot makes to that of the floor which is shown, and back."""

import dataclasses
from typing import Optional

import numpy as np

from rumba_sim.model.common.geometry import Pose, compose, inverse
from rumba_sim.model.maps.laid_over import points_in_parent
from rumba_viewer.scene.snapshot import Array, Point, Robot

SAME = Pose(0.0, 0.0, 0.0)


def on_floor(robot: Robot, frame: Optional[Pose]) -> Robot:
    """A robot with what it believes and plans where that is on the floor.

    Args:
        robot: where that is in the frame of the map.
        frame: pose of that frame on the floor; None: it is unknown, so that nothing of it can be shown.
    """
    if frame == SAME:
        return robot
    if frame is None:
        return dataclasses.replace(robot, believed=None, particles=None, planned=None, going_to=None)
    return dataclasses.replace(
        robot, believed=None if robot.believed is None else compose(frame, robot.believed),
        particles=_points(robot.particles, frame), planned=_points(robot.planned, frame),
        going_to=None if robot.going_to is None else Point(*compose(frame, Pose(*robot.going_to, 0.0))[:2]))


def on_map(point: Point, frame: Pose) -> Point:
    """A point of the floor in the frame of the map, by the pose of that frame on the floor."""
    return Point(*compose(inverse(frame), Pose(*point, 0.0))[:2])


def _points(points: Optional[Array], frame: Pose) -> Optional[Array]:
    return None if points is None else np.stack(points_in_parent(frame, *points.T), axis=1)
