"""Plans how to clean what was missed: region by region, along the walls, in lanes or in rings, and then the crumbs."""

from typing import Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from scipy import ndimage

from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.belief.swept import Swept
from rumba_cleaning.planning import improvement, tour
from rumba_cleaning.planning.edits import dense
from rumba_cleaning.planning.groups import Group, groups
from rumba_cleaning.planning.improvement import improved, with_detours
from rumba_cleaning.planning.layouts import Draft, drafts, laid_out, tries
from rumba_cleaning.planning.paper import drive
from rumba_cleaning.planning.rectangle import spiral_over
from rumba_cleaning.planning.regions import NARROW, Shapes, Ways, doors, regions, shapes
from rumba_cleaning.planning.rehearsal import Rehearsal
from rumba_cleaning.planning.rings import chains, rings, stretch
from rumba_cleaning.planning.stretches import Stretch
from rumba_cleaning.planning.surroundings import Surroundings
from rumba_cleaning.planning.tour import Tour
from rumba_cleaning.planning.transit import route_over
from rumba_cleaning.planning.turned_floor import Window, main_direction
from rumba_cleaning.planning.walls import Walls
from rumba_cleaning.route import Route
from rumba_sim.model.geometry import Pose
from rumba_sim.model.kernel import Array

# Our choice.
MOST = 0.5  # share of what was missed that lanes, rings and large crumbs must clean, for them to be driven
BEYOND = 0.03  # [m] from what the brush reaches, where an obstacle may leave more floor free than the robot knows
YIELD = 0.7  # share of a crumb that is swept in passing, about: small plans for more crumbs than the target needs
SPARE = 0.0005  # of coverage that is planned beyond the target, once the robot is past the lanes and rings
CULLS = 4  # rounds in which crumbs are left out that cost much time for their area: more make better choices
EFFORT = 10  # times as much as usual to search for tours on floors planned thoroughly: large drives less, small is fast


def plan(context: Context, pose: Pose, end: Optional[Pose] = None) -> Optional[Route]:
    """A route that cleans what was missed; None if nothing was missed, or none of it can be reached.

    An empty rectangle is swept in a spiral. Elsewhere, as long as lanes and rings clean most of it, crumbs are cleaned
    on detours from these, and the route is rebuilt and improved by rehearsal. The routes after that know where the
    robot really drove, and visit crumb after crumb; if no obstacles were met, they are improved too. All visit only as
    many crumbs as the target needs.

    Args:
        context: with the floor that was swept before; it is not changed.
        pose: from which the route begins, map frame.
        end: near which it should end; None: anywhere.
    """
    spiral = spiral_over(context, pose) if end is None else None
    if spiral is not None:
        return spiral
    ground, labels = context.ground, regions(context.ground)
    surroundings = Surroundings(context, pose, end, _around(context, pose), labels, Walls(ground))
    drafts = _drafts(surroundings)
    if not drafts:
        return _over_crumbs(surroundings)
    if improvement.rounds(context) == 0:
        return with_detours(surroundings, drafts[0].route, drafts[0].paper)
    paths = [part.variants[0].path() for drafted in drafts for part in drafted.stretches]
    return improved(surroundings, [drafted.route for drafted in drafts], paths)


class _Drafted(NamedTuple):
    """A route over lanes, rings and large crumbs."""

    route: Route
    stretches: List[Stretch]
    paper: Swept  # the floor after it, on paper


def _drafts(surroundings: Surroundings) -> List[_Drafted]:
    """Routes that clean most of what was missed; none, if that is little."""
    swept, area = surroundings.context.swept, surroundings.context.swept.reachable_area
    missing = float((swept.missing_share() * surroundings.around).sum()) * surroundings.context.plan.resolution ** 2
    ringed: Dict[Tuple[bytes, float], Tuple[List[Stretch], Swept]] = {}  # by where they are, and how far apart
    found: Dict[bytes, _Drafted] = {}  # by their paths: two drafts may come to the same
    for draft, shape in _shaped(surroundings):
        which = shape.has_lanes.tobytes(), draft.ring_pass
        if which not in ringed:
            paper = swept.copy()
            ringed[which] = _rings(surroundings, paper, shape, draft), paper
        along_rings, beside_rings = ringed[which]
        paper = beside_rings.copy()
        stretches = along_rings + _lanes(surroundings, paper, shape, draft)
        stretches += _strips(surroundings, paper, draft)
        paths = b''.join(part.variants[0].path().tobytes() for part in stretches)
        is_much = paths not in found and paper.coverage - swept.coverage > MOST * missing / area
        route = _through(surroundings, stretches) if is_much else None
        if route is not None:
            found[paths] = _Drafted(route, stretches, paper)
    return list(found.values())


def _shaped(surroundings: Surroundings) -> List[Tuple[Draft, Shapes]]:
    """The drafts to rehearse, with what suits the regions by each; none for rings or shapes that no region has."""
    context = surroundings.context
    worth = improvement.rounds(context) if improvement.is_thorough(context) else 0
    usual, *others = [(draft, shapes(context.ground, surroundings.labels, draft.narrow)) for draft in drafts(worth)]
    return [usual, *(other for other in others if _is_of_use(*other, usual[1]))]


def _is_of_use(draft: Draft, shape: Shapes, usual: Shapes) -> bool:
    """Whether some region suits a draft: has another shape than usual, or is in rings, if the draft is for such."""
    has_others = draft.narrow == NARROW or bool((shape.has_lanes != usual.has_lanes).any())
    is_for_rings = draft.apart > 0.0
    return has_others and not (is_for_rings and shape.has_lanes[1:].all())


def _around(context: Context, pose: Pose) -> Array:
    """The cells that a robot at a pose can sweep beside the obstacles it met, about: bool (rows, columns)."""
    ground = context.ground
    if not ground.has_marks:
        return np.ones(ground.plan.occupancy.shape, bool)
    return ground.around(pose.x, pose.y, 0.5 * context.robot.brush.width + BEYOND)


def _over_crumbs(surroundings: Surroundings) -> Optional[Route]:
    """A route that visits crumb after crumb; None if there are none, or none can be reached.

    Beside obstacles that the robot met, no rehearsal would be true: how large they are is known by a few contacts.
    """
    context = surroundings.context
    found = surroundings.crumbs(context.swept)
    route = _through(surroundings, found)
    if route is None or improvement.rounds(context) == 0 or context.ground.has_marks:
        return route
    begun = Rehearsal(context, surroundings.pose, dense(route)).begun
    return improved(surroundings, [begun], [part.variants[0].path() for part in found])


def _through(surroundings: Surroundings, found: List[Stretch]) -> Optional[Route]:
    """A route over stretches between poses; of crumbs, only over as many as the target needs. None: there is none."""
    if not found:
        return None
    context, pose = surroundings.context, surroundings.pose
    tours = _tours(context, pose, surroundings.end, surroundings.labels, groups(found))
    if all(part.is_crumb for part in found):
        _cull(context, tours)
    return route_over(context, pose, _legs(tours))


def _rings(surroundings: Surroundings, paper: Swept, shape: Shapes, draft: Draft) -> List[Stretch]:
    """Rings that clean what was missed along walls, and where there are to be no lanes; they are driven on paper."""
    ground, brush = surroundings.context.ground, surroundings.context.robot.brush.width
    found = rings(ground, paper, surroundings.labels, shape, brush, draft.ring_pass)
    return [stretch(chain, brush) for chain in chains(found)]


def _lanes(surroundings: Surroundings, paper: Swept, shape: Shapes, draft: Draft) -> List[Stretch]:
    """Lanes that clean what was missed beside the rings, but for crumbs; they are driven on paper."""
    context, labels = surroundings.context, surroundings.labels
    ground, angle = context.ground, main_direction(surroundings.walls.outlines)
    missed = (paper.missing_share() > draft.missed) & surroundings.around
    layouts = draft.layouts[:tries(float(missed.sum()) * ground.plan.resolution ** 2)]
    found: List[Stretch] = []
    for region, part, window in _by_region(ground, missed, labels):
        if shape.has_lanes[region]:
            found += laid_out(context, paper, part, region, angle, layouts, window)
    return found


def _strips(surroundings: Surroundings, paper: Swept, draft: Draft) -> List[Stretch]:
    """What rings and lanes leave in large pieces, as in the middle of corridors; it is driven on paper."""
    found = surroundings.crumbs(paper, draft.strip, draft.apart)
    for part in found:
        drive(paper, part.variants[0].path())
    return found


def _by_region(ground: Ground, missed: Array, labels: Array) -> Iterator[Tuple[int, Array, Window]]:
    """The label of each region, the cells to clean in it, bool (rows, columns), and the window that holds them."""
    cells = np.argwhere(missed)
    nodes = ground.standing(cells)
    of_cells = np.zeros(missed.shape, labels.dtype)
    of_cells[missed] = labels[nodes[:, 0], nodes[:, 1]]
    for label, window in enumerate(ndimage.find_objects(of_cells), 1):
        if window is not None:
            part = np.zeros(missed.shape, bool)  # not zeros_like, which writes to all of it
            part[window] = of_cells[window] == label
            yield label, part, window


def _tours(context: Context, pose: Pose, end: Optional[Pose], labels: Array,
           parts: Sequence[Group]) -> List[Tuple[Group, Tour]]:
    """Groups of stretches in the order in which they are cleaned, with a tour in each from door to door."""
    ground, speed = context.ground, context.config.transit_speed
    fixed = [pose] if end is None else [pose, end]
    places = np.array([*(part.middle() for part in parts), *(each[:2] for each in fixed)])
    of_fixed = [int(labels[ground.standing_at(each.x, each.y)]) for each in fixed]
    ways = Ways(doors(ground, labels), places, [*(part.region for part in parts), *of_fixed])
    start, goal = len(parts), None if end is None else len(parts) + 1
    seconds = ways.metres[:start + 1] / speed
    visits = tour.order(seconds[:, :start], None if goal is None else seconds[:, goal])
    effort = EFFORT if improvement.is_thorough(context) else 1
    tours, here, entry = [], start, places[start]
    for place, following in zip(visits, [*visits[1:], goal]):
        if here != start or parts[place].region != of_fixed[0]:
            door = ways.doors(here, place)[1]
            entry = places[here] if door is None else door
        leave = None
        if following is not None:
            door = ways.doors(place, following)[0]
            leave = places[following] if door is None else door
        tours.append((parts[place], Tour(ground, entry, parts[place].stretches, leave, speed, effort)))
        here = place
    return tours


def _cull(context: Context, tours: List[Tuple[Group, Tour]]) -> None:
    """Leave out crumbs that cost most time for their area, as long as the target can be met without them."""
    swept = context.swept
    needed = (context.target_coverage + SPARE - swept.coverage) * swept.reachable_area / YIELD  # [m^2]
    for last in range(CULLS, 0, -1):
        rows: List[Tuple[float, float, int, int]] = []
        for number, (group, route) in enumerate(tours):
            for saved, index in route.saved():
                part = group.stretches[int(index)]
                rows.append((float(saved + part.delay) / part.area, part.area, number, int(index)))
        spare = (sum(row[1] for row in rows) - needed) / last
        dropped: Dict[int, List[int]] = {}
        for _, area, number, index in sorted(rows, key=lambda row: -row[0]):
            spare -= area
            if spare < 0.0:
                break
            dropped.setdefault(number, []).append(index)
        for number, indices in dropped.items():
            tours[number][1].leave_out(indices)


def _legs(tours: List[Tuple[Group, Tour]]) -> Iterator[Tuple[Optional[Array], Array]]:
    """The way to each stretch of tours, if it is known, and the path over that: float64 (any, 2) [m] each."""
    for group, route in tours:
        for number, leg in enumerate(route.legs()):
            path = group.stretches[leg.stretch].variants[leg.variant].path()
            yield leg.way if number > 0 else None, path
