"""The functions of the public interface."""

from typing import Any, List, Optional, Sequence

import numpy as np

from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_evaluation.scoring.drawn_path import DrawnPath, PathError
from rumba_evaluation.scoring.guarded import Guarded
from rumba_evaluation.scoring.ride import Driven
from rumba_evaluation.trials import batch, score
from rumba_evaluation.trials.cases import Case, Conditions, Result
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps import map_file, named_maps
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig


def load_map(name: str, robot: Optional[RobotConfig] = None) -> FloorPlan:
    """The floor plan of a map: one of those of Rumba by its name, or the path of a map_server YAML file.

    Args:
        name: such as 'studio', or '/home/me/map.yaml'.
        robot: what the robots are like that drive there; None for a Rumba.

    Raises:
        RumbaError: there is no such map, or it cannot be used.
    """
    return map_file.load(named_maps.path(name), (robot or RobotConfig()).drive.radius)


def evaluate(plan: FloorPlan, strategy: str = 'boustrophedon', seeds: Sequence[int] = (1,), robots: int = 1,
             conditions: Optional[Conditions] = None) -> List[Result]:
    """Run a mission for each seed, in this process; returns how each went. The same seed gives the same result.

    Args:
        plan: the floor plan, of `load_map`.
        strategy: name of a strategy, such as 'bounce', or of one that `strategy` registered.
        seeds: of everything that is random.
        robots: how many share the floor.
        conditions: of all missions; None for the usual ones. The files that they may name are not read.

    Raises:
        RumbaError: the strategy is unknown, or the robots do not fit there.
    """
    return [batch.finish(Trial(plan, strategy, conditions or Conditions(), seed, robots)) for seed in seeds]


def score_path(plan: FloorPlan, points: Array, speed: float = CleaningConfig().speed, is_guarded: bool = False,
               robot: Optional[RobotConfig] = None) -> score.Score:
    """Have a robot drive along a path that somebody planned; returns what it swept, in which time, and at which cost.

    Args:
        plan: the floor plan, of `load_map`.
        points: float64 (any, 2) [m] in the frame of the map, at least two.
        speed: of the robot [m/s].
        is_guarded: whether it drives around what blocks it, as in a mission; else it stops there.
        robot: what the robot is like; None for a Rumba.

    Raises:
        RumbaError: a point is no finite number, lies outside the map or in a wall.
    """
    points = np.asarray(points, np.float64)
    if points.ndim != 2 or points.shape[1] != 2 or len(points) < 2:
        raise PathError(f'the shape of points is {points.shape}: must be (n, 2), with n of at least 2')
    if not np.isfinite(points).all():
        raise PathError('points has numbers that are not finite')
    path = DrawnPath('path', [f'point {number}' for number in range(1, len(points) + 1)], points, None, None)
    kind = Guarded if is_guarded else Driven
    ride = kind(plan, path, robot or RobotConfig(), speed)
    ride.run()
    return score.of_ride(Case(plan.name, path.source, 0, 1), ride)


def make_env(num_envs: Optional[int] = None, **arguments: Any) -> Any:
    """An environment of Gymnasium in which programs learn to clean: docs/environment.md has its arguments.

    Args:
        num_envs: None for one robot; a number for a vector environment of so many.
        arguments: of `CoverageEnv` and, for several robots, of `CoverageVectorEnv`.

    Raises:
        ImportError: Gymnasium is not installed.
        RumbaError: an argument cannot be used.
    """
    from rumba_evaluation.learning.environment import CoverageEnv
    if num_envs is None:
        return CoverageEnv(**arguments)
    from rumba_evaluation.learning.vector_environment import CoverageVectorEnv
    return CoverageVectorEnv(num_envs, **arguments)
