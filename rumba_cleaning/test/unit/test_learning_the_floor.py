"""What a robot knows goes on when the plan of its floor grows; frontiers; and a whole floor that it was not shown."""

import math

import numpy as np
import pytest
from rooms import room

from rumba_cleaning.behaviour import Status
from rumba_cleaning.belief import redrawing
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.control import act
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.strategies.frontiers import frontiers, route_to_frontier
from rumba_cleaning.pose_source import Belief, Mapped
from rumba_cleaning.survey import Survey
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import UNKNOWN, FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World

WHOLE = room(6.0, 3.0, 0.02, boxes=[(2.9, 0.0, 3.1, 2.0)])
HERE = Pose(1.0, 1.0, 0.0)


def part(left, right):
    """What a robot knows of a floor if it knows it from one x to another [m]."""
    first, last = round((left - WHOLE.origin[0]) / 0.02), round((right - WHOLE.origin[0]) / 0.02)
    return FloorPlan('a part', WHOLE.occupancy[:, first:last], 0.02, (WHOLE.origin[0] + first * 0.02, WHOLE.origin[1]))


class Told(Survey):
    """Tells plan after plan, and the key frames that a test sets."""

    def __init__(self, *plans):
        """Tell the last of the plans for ever."""
        self.rest, self.poses = list(plans), np.zeros((1, 3))

    def plan(self):
        """The next plan."""
        return self.rest.pop(0) if len(self.rest) > 1 else self.rest[0]

    def frames(self):
        """The key frames."""
        return self.poses


def context_of(*plans):
    """What a robot knows that learns plan after plan."""
    return Context(plans[0], RobotConfig(), CleaningConfig(), survey=Told(*plans))


def test_without_a_survey_the_plan_stays():
    context = Context(WHOLE, RobotConfig(), CleaningConfig())
    before = context.plan
    assert not context.learn(HERE)
    assert context.plan is before


def test_what_was_swept_met_and_felt_is_known_on_a_larger_plan():
    small, large = part(0.5, 2.0), part(-0.02, 6.02)
    context = context_of(small, large)
    context.learn(HERE)
    context.swept.begin(1.0, 1.0)
    context.swept.sweep(HERE, Pose(1.3, 1.0, 0.0))
    area = context.swept.coverage * context.swept.reachable_area
    context.ground.mark(1.5, 2.0, 0.05)
    context.cliff_map.note(HERE, (False, True, False, False), False)
    seen = context.cliff_map.seen[0]
    assert context.learn(HERE)
    assert context.plan is large
    assert context.swept.reachable_area > 3.0 * area
    assert context.swept.coverage * context.swept.reachable_area == pytest.approx(area, rel=0.01)
    assert context.ground.clearance[context.ground.node(1.5, 2.0)] == 0.0
    assert context.ground.fits.shape == (large.rows + 1, large.columns + 1)
    assert context.cliff_map.clearance_at(*seen) < 0.02 < context.cliff_map.clearance_at(4.0, 1.0)
    assert [context.cliff_map.are_known(np.array([[x, 1.0]]), 2) for x in (1.0, 4.0)] == [True, False]
    assert not context.learn(HERE)


@pytest.mark.parametrize('pose', [Pose(1.0, 1.0, 0.0), Pose(4.0, 1.0, 0.0), Pose(2.15, 1.0, 0.0)])
def test_what_cliffs_seem_to_cut_off_counts_if_the_robot_came_from_there(pose):
    cliff = np.zeros(WHOLE.occupancy.shape, np.bool_)
    cliff[:, 100] = True  # beyond x = 1.98
    context = context_of(WHOLE, FloorPlan('cut off', WHOLE.occupancy, 0.02, WHOLE.origin, cliff=cliff))
    context.learn(pose)
    context.swept.begin(4.0, 1.0)
    whole = context.swept.reachable_area
    context.ground.squeeze(True)
    assert context.learn(pose)
    assert 0.6 * whole < context.swept.reachable_area < 0.75 * whole


def test_a_frontier_is_where_known_floor_ends_that_goes_on():
    cells = WHOLE.occupancy.copy()
    cells[:, 170:] = UNKNOWN  # beyond x = 3.38
    context = Context(FloorPlan('known', cells, 0.02, WHOLE.origin), RobotConfig(), CleaningConfig())
    found = context.ground.points(frontiers(context.ground, HERE))
    reach = RobotConfig().drive.radius
    assert len(found) and found[:, 0] == pytest.approx(3.38 - reach, abs=0.06)
    route = route_to_frontier(context, HERE, [])
    assert route.waypoints[0].tolist() == [1.0, 1.0]
    assert route.waypoints[-1][0] == pytest.approx(3.38 - reach, abs=0.06)
    assert route_to_frontier(context, HERE, [point for point in found]) is None


def test_a_floor_that_is_known_has_no_frontier():
    context = Context(WHOLE, RobotConfig(), CleaningConfig())
    assert not len(frontiers(context.ground, HERE))
    assert route_to_frontier(context, HERE, []) is None


def test_a_gap_through_which_no_robot_fits_is_no_frontier():
    plan = room(3.0, 2.0, 0.02)
    cells = plan.occupancy.copy()
    cells[40:55, -1] = UNKNOWN  # 0.3 m
    context = Context(FloorPlan('a gap', cells, 0.02, plan.origin), RobotConfig(), CleaningConfig())
    assert not len(frontiers(context.ground, HERE))


def test_a_floor_that_the_robot_was_not_shown_is_mapped_cleaned_and_left_for_the_dock():
    plan = room(4.0, 2.2, 0.02, boxes=[(2.0, 0.0, 2.1, 1.3)], dock=Pose(0.21, 1.1, math.pi))
    world = World(plan, RobotConfig(), seed=2)
    world.spawn('rumba', plan.dock, brushes_up=True)
    world.step()
    source = Mapped(world, 'rumba', plan.dock)
    context = Context(source.plan(), RobotConfig(), CleaningConfig(), survey=source)
    assert np.count_nonzero(context.plan.free) < 0.9 * np.count_nonzero(plan.free)
    mission, dt = Mission(context, 'explore_and_clean', 0.95), 0.0
    while mission.status is Status.RUNNING and world.time < 400.0:
        act(mission, world, 'rumba', dt, source)
        world.step(5)
        dt = 0.1
    assert mission.status is Status.SUCCEEDED, mission.message
    assert world.floor.coverage > 0.92
    assert world.robots['rumba'].is_docked


# --- maps that are redrawn ----------------------------------------------------------------------------------------

LEFT, RIGHT = Pose(1.0, 1.0, 0.3), Pose(4.5, 1.0, 0.0)  # key frames


def redrawn(by):
    """A robot that swept at both key frames, and whose map was then redrawn with the right one moved [m, m, rad]."""
    survey = Told(WHOLE, WHOLE)
    survey.poses = np.array([LEFT, RIGHT])
    context = Context(WHOLE, RobotConfig(), CleaningConfig(), survey=survey)
    context.swept.begin(1.0, 1.0)
    for x, y, _ in (LEFT, RIGHT):
        context.swept.follow(Pose(x, y, 0.0), False)
        context.swept.follow(Pose(x + 0.4, y, 0.0), False)
    context.ground.mark(1.5, 2.0, 0.05)
    context.cliff_map.note(HERE, (False, True, False, False), False)
    survey.poses = np.array([LEFT, Pose(*np.add(RIGHT, by))])
    return context


def is_swept(context, x, y):
    """Whether the floor about a point is swept [m]."""
    cells = context.swept.missing_share()
    row, column = (int((at - low) / context.plan.resolution) for at, low in zip((y, x), context.plan.origin[::-1]))
    return bool((cells[row - 1:row + 2, column - 1:column + 2] == 0.0).all())


def test_what_was_swept_stays_at_the_key_frames_of_a_redrawn_map():
    context = redrawn((-0.5, 0.6, 0.5 * math.pi))
    area = context.swept.coverage
    assert context.follow(HERE) and not context.follow(HERE)
    assert is_swept(context, 1.2, 1.0)  # beside the left frame, as before
    assert is_swept(context, 4.0, 1.8)  # which lay ahead of the right one, as it lies to its left now
    assert not is_swept(context, 4.7, 1.0)
    assert not is_swept(context, 4.0, 1.4) and not is_swept(context, 4.2, 1.6)
    assert context.swept.coverage == pytest.approx(area, rel=0.03)


def test_obstacles_and_edges_are_forgotten_with_the_map_on_which_they_were_met():
    context = redrawn((0.1, 0.0, 0.0))
    context.follow(HERE)
    assert not context.ground.has_marks and not context.cliff_map.seen
    assert not context.cliff_map.are_known(np.array([[1.0, 1.0]]), 1)


def test_a_jump_of_the_pose_with_the_map_sweeps_nothing():
    context = redrawn((0.1, 0.0, 0.0))
    context.follow(HERE)
    swept = context.swept.coverage
    context.swept.follow(Pose(5.2, 1.0, 0.0), False)
    assert context.swept.coverage == swept


def test_more_key_frames_or_the_same_ones_move_nothing():
    context = redrawn((0.0, 0.0, 2.0 * math.pi))
    assert not context.follow(HERE) and context.ground.has_marks
    context.survey.poses = np.array([LEFT, RIGHT, HERE])
    assert not context.follow(HERE) and context.ground.has_marks


def test_the_way_back_leads_from_a_moved_frame_to_where_it_was():
    back = redrawing.way_back(np.array([LEFT, RIGHT]), np.array([LEFT, Pose(4.0, 1.5, 0.5 * math.pi)]))
    assert back(np.array([[1.1, 0.9], [3.9, 1.8]])) == pytest.approx(np.array([[1.1, 0.9], [4.8, 1.1]]))


def test_the_key_frames_that_a_mapping_robot_tells_are_those_of_its_map_when_that_grows_and_when_it_is_redrawn():
    plan = room(6.0, 5.0, 0.02, boxes=[(3.1, 0.0, 3.2, 3.2)])
    world = World(plan, RobotConfig(), seed=2)
    robot = world.spawn('rumba', HERE)
    source = Mapped(world, 'rumba', HERE)
    before, mapper = source.frames(), source.mapper
    assert before is source.frames() and len(before) == 1
    for _ in range(40):
        robot.command(0.3, 0.2, world.tick)
        world.step(5)
        source(world, 'rumba')
    assert len(source.frames()) > 5 and source.frames() == pytest.approx(np.array(mapper.frames))
    mapper.redrawn += 1
    mapper.frames[:] = [pose._replace(x=pose.x + 0.1) for pose in mapper.frames]
    assert source.frames() == pytest.approx(np.array(mapper.frames)) and source.frames() is source.frames()


BY = 0.3  # [m] along x


def test_a_mission_goes_on_when_the_map_is_redrawn_and_its_account_stays_right():
    shifted = FloorPlan('redrawn', WHOLE.occupancy, 0.02, (WHOLE.origin[0] + BY, WHOLE.origin[1]))
    world, survey, is_shifted = World(WHOLE, RobotConfig(), seed=2), Told(WHOLE), False
    world.spawn('rumba', HERE)
    context = Context(WHOLE, RobotConfig(), CleaningConfig(), survey=survey)
    mission, dt = Mission(context, 'explore_and_clean', 0.9), 0.0

    def believe(world, name):
        pose = world.robots[name].pose
        return Belief(pose._replace(x=pose.x + BY) if is_shifted else pose)

    while mission.status is Status.RUNNING and world.time < 600.0:
        act(mission, world, 'rumba', dt, believe)
        world.step(5)
        dt = 0.1
        if not is_shifted and world.floor.coverage > 0.4:
            is_shifted, survey.rest = True, [shifted]
            survey.poses = survey.poses + (BY, 0.0, 0.0)
    assert is_shifted and mission.status is Status.SUCCEEDED, mission.message
    assert world.floor.coverage == pytest.approx(context.swept.coverage, abs=0.01)
    assert world.robots['rumba'].bumps < 30
