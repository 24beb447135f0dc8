"""What a behaviour knows of the floor that it works on, and what it remembers of it."""

import copy
import dataclasses
from concurrent.futures import Executor, Future
from typing import TYPE_CHECKING, Any, Callable, List, Optional, Sequence, TypeVar, Union

import numpy as np

from rumba_cleaning.behaviour import Observation
from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.belief.mates import Mates, Report
from rumba_cleaning.belief.recent import Recent
from rumba_cleaning.belief.surroundings import blank
from rumba_cleaning.belief.swept import Swept
from rumba_cleaning.belief.track import Track
from rumba_cleaning.cleaning_config import CleaningConfig, attainable
from rumba_cleaning.edges.cliff_map import SPARE, CliffMap
from rumba_cleaning.executors import InPlace
from rumba_cleaning.survey import Survey
from rumba_sim.model.common.config import updated
from rumba_sim.model.common.geometry import Pose, hypot
from rumba_sim.model.floors.reachability import SLACK
from rumba_sim.model.floors.sweep import Part
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig

if TYPE_CHECKING:
    from rumba_cleaning.belief.sight import Sight

Result = TypeVar('Result')
Seed = Union[int, Sequence[int]]
CUT_OFF = 0.02  # of the reachable floor: less than a room, more than corners beside things; our choice
SHUT_IN = 0.2  # of the reachable floor: a room, for which it is worth waiting minutes; our choice
NOT_COPIED = ('sight', 'cliff_map', 'generator')  # attributes that what is submitted does without
OPENED = 0.05  # [m^2] half of what a robot covers: a gap that opens less is not worth squeezing through; our choice


def _sight(plan: FloorPlan) -> 'Sight':
    """What a laser sees; it is imported here, since a cleaner without one starts sooner."""
    from rumba_cleaning.belief.sight import Sight
    return Sight(plan)


def own_seed(seed: int, robot: str) -> List[int]:
    """The seed of a robot, by its name, in a run with a seed: robots draw different random numbers."""
    return [seed, *robot.encode()]


class Context:
    """One robot's knowledge, shared by all its behaviours.

    Attributes:
        survey: of a floor that is being mapped; None if the plan does not change.
        robot: what the robot is like.
        config: speeds and thresholds for its work; it can drive at the speeds.
        target_coverage: share of the reachable floor to sweep [0..1].
        generator: what random choices are drawn from.
        executor: what runs long computations, as `submit` does.
        ground: where the robot can go, with the obstacles that it met.
        mates: the robots with which it shares the floor.
        swept: what its brush passed over, and those of its mates, of the floor that it reaches with the margin.
        cliff_map: where the floor ends.
        sight: what its laser sees; None if it does without.
        has_map: whether the plan, and the pose of the robot on it, can be relied on; without, the plan is blank, and
            poses are those of the odometry, which err more with every metre.
        has_dock: whether the robot can charge on one, and ends there.
        docks_itself: whether it finds the contacts by itself, if it is told to before its dock.
        end: where a robot without a dock ends; None: where it began.
    """

    has_map = has_dock = True
    _recent: Optional[Recent] = None  # without a map
    docks_itself = False
    end: Optional[Pose] = None

    def __init__(self, plan: FloorPlan, robot: RobotConfig, config: CleaningConfig, seed: Seed = 0,
                 executor: Optional[Executor] = None, survey: Optional[Survey] = None,
                 mates: Optional[Mates] = None) -> None:
        """Know a floor plan, with nothing met or swept yet.

        Without an executor, what is submitted runs at once in the calling thread, so that a run can be repeated.
        """
        plan = plan.refined()
        self.robot = robot
        self.config = attainable(config, robot)
        self.target_coverage = config.target_coverage
        self.generator = np.random.default_rng(seed)
        self.executor = executor if executor is not None else InPlace()
        self.survey = survey
        self._frames: Array = np.empty((0, 3)) if survey is None else survey.frames()  # of the map that is known
        self._surveyed = plan  # the plan as the survey told it
        self._track = Track()  # on a floor that is being mapped
        self.mates = mates if mates is not None else Mates()
        self._berth = self.mates.rank  # number of the dock to which the robot returns; past the last, from the first on
        self.ground = Ground(plan, robot)
        self.swept = Swept(plan, updated(robot, {'drive': {'radius': robot.drive.radius + config.margin}}, 'margin'),
                           is_exact=survey is None)
        self.cliff_map = CliffMap(plan, robot)
        self.sight = _sight(plan) if config.laser else None

    @classmethod
    def without_map(cls, robot: RobotConfig, config: CleaningConfig, seed: Seed = 0) -> 'Context':
        """What a robot knows that has neither a map nor a laser."""
        context = cls(blank(Pose(0.0, 0.0, 0.0)), robot, dataclasses.replace(config, laser=False), seed)
        context.has_map, context._recent = False, Recent()
        return context

    @property
    def plan(self) -> FloorPlan:
        """The refined floor plan, as it is known now."""
        return self.ground.plan

    def sense(self, observation: Observation) -> Observation:
        """Remember what the cliff sensors see; what behaviours go by: without a map, the pose is corrected."""
        if self._recent is None:
            self._note_cliffs(observation)
            return observation
        observation = self._recent.corrected(observation)
        forgets, observations = self._recent.noted(observation)
        if forgets:
            self.begin_anew(observation.pose)
        for each in observations:
            self._note_cliffs(each)
        return observation

    def _note_cliffs(self, observation: Observation) -> None:
        before = len(self.cliff_map.seen)
        self.cliff_map.note(observation.pose, observation.cliffs, observation.is_docked)
        for x, y in self.cliff_map.seen if before and not self.ground.has_marks else self.cliff_map.seen[before:]:
            self.ground.mark(x, y, SPARE)

    def learn(self, pose: Pose) -> bool:
        """Take the newest plan of a floor that is being mapped; returns whether there is one.

        What can be reached is counted from the robot, or, if that is more, from where it was counted before: cliffs
        that the robot has found may seem to cut the way off on which it came.

        Args:
            pose: of the robot.
        """
        if self.survey is None:
            return False
        plan = self.survey.plan()
        if plan is self._surveyed:
            return False
        self._take(plan, pose)
        return True

    def follow(self, pose: Pose) -> bool:
        """Remember the way of the robot; if the map was redrawn, have what was swept move with it.

        Obstacles and edges are forgotten then: the map shows those that the robot has met.

        Args:
            pose: of the robot, on the map as it is now.

        Returns:
            Whether the map was redrawn.
        """
        if self.survey is None:
            return False
        is_redrawn = self.survey.frames() is not self._frames and self._take_redrawn(self.survey, pose)
        self._track.follow(pose)
        return is_redrawn

    def _take_redrawn(self, survey: Survey, pose: Pose) -> bool:
        """Take new key frames; returns whether old ones have moved, since the map was redrawn."""
        from rumba_cleaning.belief import redrawing  # here, where loops have closed: a cleaner starts sooner without it
        before, after = self._frames, survey.frames()
        self._frames = after
        if not redrawing.is_redrawn(before, after):
            return False
        self._track.move(redrawing.way_back(after, before))
        self.forget_obstacles()
        self._take(survey.plan(), pose, redrawing.way_back(before, after))
        self.cliff_map.forget()
        return True

    def _take(self, plan: FloorPlan, pose: Pose, way_back: Optional[Callable[[Array], Array]] = None) -> None:
        """Go on with a newer plan, on which the robot can go where it has been; see `Swept.learn`."""
        self._surveyed, plan = plan, self._track.on(plan, self.ground.reach + SLACK)
        self.ground.learn(plan)
        self.cliff_map.learn(plan)
        if self.sight is not None:
            self.sight.learn(plan)
        usual = self.cleaned_ground()
        usual.squeeze(False)
        self.swept.learn(plan, usual.places([pose[:2], self.swept.start]), way_back)

    def cleaned_ground(self) -> Ground:
        """The ground on which plans clean: a copy, with the margin to walls that the settings ask for."""
        ground = self.ground.copy()
        ground.keep_off(self.config.margin)
        return ground

    def begin_anew(self, pose: Pose) -> None:
        """Without a map, know nothing of the floor around a pose: nothing was met there, or seen."""
        plan = blank(pose)
        self.ground.learn(plan)
        self.cliff_map.learn(plan)
        self.forget_obstacles()
        self.cliff_map.forget()

    def moor(self, pose: Pose) -> None:
        """Make the dock that is nearest to a pose the home of the robot."""
        dock = self.nearest_dock(pose)
        self._berth = self._berth if dock is None else self.plan.docks.index(dock)

    def nearest_dock(self, pose: Pose) -> Optional[Pose]:
        """The dock that is nearest to a pose, as the crow flies; None without docks."""
        docks = self.plan.docks
        return min(docks, key=lambda dock: hypot(dock.x - pose.x, dock.y - pose.y)) if docks else None

    @property
    def home(self) -> Optional[Pose]:
        """The dock to which the robot returns: where it began, or by its place among its mates; None without docks."""
        docks = self.plan.docks
        return docks[self._berth % len(docks)] if docks else None

    # --- obstacles --------------------------------------------------------------------------------------------------

    def look(self, observation: Observation) -> None:
        """Take note of what the laser sees; `show_seen` has paths lead around it."""
        if self.sight is not None and observation.scan is not None:
            mates = [report.pose for report in self.mates.reports.values()]
            self.sight.look(observation.pose, observation.scan, mates, observation.dt)

    def show_seen(self) -> None:
        """Have the ground show what is seen."""
        if self.sight is not None:
            self.ground.show(self.sight.seen())

    def is_cut_off(self, pose: Pose) -> bool:
        """Whether obstacles that stay, as a closed door, keep a robot at a pose from a part of the floor."""
        return self._is_cut_off(self.ground, pose, CUT_OFF)

    def is_shut_in(self, pose: Pose) -> bool:
        """Whether they keep it from much of the floor, as from a room, unless it squeezes past them."""
        return self._is_cut_off(self._usual_ground(), pose, SHUT_IN)

    def _is_cut_off(self, ground: Ground, pose: Pose, share: float) -> bool:
        return ground.has_lasting and ground.cut_off(pose.x, pose.y) > share * self.swept.reachable_area

    def _usual_ground(self) -> Ground:
        """The ground as it is if nothing is squeezed past: a copy."""
        usual = self.ground.copy()
        usual.squeeze(False)
        return usual

    def may_squeeze(self, pose: Pose) -> bool:
        """Whether squeezing past obstacles opens floor to a robot at a pose."""
        return self.ground.opened(pose.x, pose.y) > OPENED

    def forget_doubtful(self) -> None:
        """As that of the ground."""
        self._lose_sight_of(self.ground.forget_doubtful())

    def forget_barring(self, pose: Pose) -> None:
        """As that of the ground, for a robot at a pose."""
        self._lose_sight_of(self.ground.forget_barring(pose.x, pose.y))

    def forget_obstacles(self) -> None:
        """Forget all obstacles."""
        if self.sight is not None:
            self._lose_sight_of(np.concatenate(self.sight.seen()))
        self.ground.forget()

    def _lose_sight_of(self, points: Array) -> None:
        if self.sight is not None:
            self.sight.forget(points)

    # --- mates, and work --------------------------------------------------------------------------------------------

    def hear(self, name: str, report: Report) -> None:
        """Take note of what a mate tells: what it sweeps is swept."""
        self.mates.hear(name, report)
        self.swept.follow(report.pose, report.brushes_up, name)

    def with_target(self, target_coverage: float) -> 'Context':
        """A context with another target that shares everything else, ground and swept included, with this one."""
        other = copy.copy(self)
        other.target_coverage = target_coverage
        return other

    def beside_obstacles(self, pose: Optional[Pose] = None) -> Part:
        """What can be reached of the floor, without straits, beside the obstacles that were met and stay.

        Nothing is squeezed past: where the robot did that, it may have seen that little lies behind.

        Args:
            pose: of the robot; if it can reach more from there than from where it began, that counts.
        """
        if not self.ground.has_lasting and not self.swept.has_straits:
            return Part(1.0, self.swept.coverage)
        usual = self._usual_ground()
        points = [self.swept.start] if pose is None else [self.swept.start, pose[:2]]
        return self.swept.within(usual.lasting_clearance(), *usual.places(points)[0])

    def beside_marks(self, pose: Pose) -> Part:
        """What a robot at a pose can reach beside all obstacles that are known, as it takes them to be now."""
        if not self.ground.has_marks and not self.swept.has_straits:
            return Part(1.0, self.swept.coverage)
        (x, y), = self.ground.points(np.array([self.ground.standing_at(pose.x, pose.y)])).tolist()
        return self.swept.within(self.ground.clearance, x, y)

    def is_met_beside_obstacles(self, pose: Pose) -> bool:
        """Whether the target is met of what can be reached; obstacles may keep a robot from less than a room."""
        if not self.ground.has_lasting and self.swept.coverage < self.target_coverage * self.swept.planned:
            return False  # even if all that was swept lies before straits: a quick answer to what missions often ask
        return not self.is_shut_in(pose) and self.beside_obstacles(pose).coverage >= self.target_coverage

    def is_all_swept(self, pose: Pose) -> bool:
        """The same if they keep it from no more than corners: then there is nothing to wait for."""
        return not self.is_cut_off(pose) and self.is_met_beside_obstacles(pose)

    def submit(self, function: Callable[..., Result], *args: Any) -> 'Future[Result]':
        """Have the executor compute `function(context, *args)` with a copy of this context as it is now.

        The function may run in another thread, while this context changes. So the copy has a ground, swept floor and
        mates of its own; the ground shows what the laser has seen. It has neither sight nor cliff map nor generator:
        these would be those of this context, and to use them is an AttributeError.
        """
        self.show_seen()
        snapshot = copy.copy(self)
        snapshot.ground, snapshot.swept, snapshot.mates = self.ground.copy(), self.swept.copy(), self.mates.copy()
        for name in NOT_COPIED:
            delattr(snapshot, name)
        return self.executor.submit(function, snapshot, *args)
