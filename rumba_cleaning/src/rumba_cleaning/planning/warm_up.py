"""Compiles the planner before its first use; the build runs `python3 -m rumba_cleaning.planning.warm_up`."""

import numpy as np

from rumba_cleaning.behaviours.follower import Follower, turn_rate
from rumba_cleaning.belief import paths
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.planning.planner import plan
from rumba_cleaning.planning.simulate.paper import drive
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig


def main() -> None:
    """Plan for two rooms, for what a drive on paper leaves of them, and for a way around the wall between them."""
    occupancy = np.full((60, 60), FREE, np.int8)
    occupancy[25:35, :40] = OCCUPIED
    floor = FloorPlan('two rooms', occupancy, 0.1, (0.0, 0.0))
    context = Context(floor, RobotConfig(), CleaningConfig(target_coverage=1.0))
    pose = Pose(1.0, 1.0, 0.0)
    context.swept.begin(pose.x, pose.y)
    route = plan(context, pose)
    assert route is not None
    follower = Follower(route, context.robot.drive)
    follower.velocity(pose, 0.1)
    follower.ahead(0.1)
    turn_rate(1.0, 0.1, context.robot.drive)
    drive(context.swept, route.waypoints)
    plan(context, pose)
    paths.between(context.ground, np.array([1.0, 1.0]), np.array([1.0, 5.0]))
    paths.lengths_to(context.ground, 1.0, 1.0)
    context.cliff_map.note(pose, 4 * (False,), False)
    context.cliff_map.are_known(np.array([[1.0, 1.0]]), 2)
    context.ground.is_marked(np.array([1.0, 1.0]), np.array([2.0, 1.0]))


if __name__ == '__main__':
    main()
