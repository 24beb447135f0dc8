"""Findings about a map in about ten lines."""

from typing import List

import numpy as np

from rumba_evaluation.inspection.barriers import Barrier, Kind
from rumba_evaluation.inspection.findings import Closed, Findings
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED
from rumba_sim.model.maps.map_file import SPECK

WIDTH = 9  # of the first column


def lines(found: Findings) -> List[str]:
    """A line for each matter, with its name in front."""
    rows = [('map', _map(found)), ('cells', _cells(found)), ('robot', _robot(found)), ('start', _start(found)),
            ('reached', _reached(found))]
    rows += [(f'closed {number}', _closed(found, part)) for number, part in enumerate(found.closed, 1)]
    if found.smaller[0]:
        rows.append(('closed', f'{found.smaller[0]} more, with {found.smaller[1]:.2f} m2 for the centre of a robot'))
    rows += [('specks', _specks(found)), ('mission', _mission(found)), ('to add', _to_add(found))]
    return [*found.sheet.header.remarks, *(f'{name:{WIDTH}} {text}' for name, text in rows)]


def _map(found: Findings) -> str:
    sheet = found.sheet
    return (f'{found.plan.name}: {sheet.format}, {sheet.columns} x {sheet.rows} pixels of {found.plan.resolution:g} m, '
            f'mode {sheet.header.mode}')


def _cells(found: Findings) -> str:
    plan = found.plan
    left, bottom, right, top = plan.bounds
    free, wall = (np.count_nonzero(plan.occupancy == kind) * plan.resolution ** 2 for kind in (FREE, OCCUPIED))
    text = (f'cut to {plan.columns} x {plan.rows}, x {left:.2f} to {right:.2f} m, y {bottom:.2f} to {top:.2f} m: '
            f'{free:.1f} m2 free, {wall:.1f} m2 wall')
    elsewhere = found.sheet.free - free
    return text + (f'; {elsewhere:.1f} m2 more are free far from there' if elsewhere >= 0.05 else '')


def _robot(found: Findings) -> str:
    return (f'radius {found.robot.drive.radius:.3f} m, brush {found.robot.brush.width:.3f} m: drives through gaps of '
            f'{found.gap:.3f} m')


def _start(found: Findings) -> str:
    if found.is_start_chosen:
        what = 'the most open place of the largest part'
    else:
        what = 'start of the map' if found.plan.start is not None else 'the dock'
    docks = len(found.plan.docks)
    return f'{_place(found.start)}, {what}; {docks or "no"} dock{"" if docks == 1 else "s"}'


def _reached(found: Findings) -> str:
    plan, area = found.plan, found.expected.area
    free = np.count_nonzero(plan.free) * plan.resolution ** 2
    return f'{area:.1f} m2 by the brush, {100.0 * area / free:.0f} % of the free floor'


def _closed(found: Findings, part: Closed) -> str:
    text = f'{part.area:.1f} m2 around {_place(part.pose)}'
    return text if part.barrier is None else f'{text}: {_why(found, part.barrier)}'


def _why(found: Findings, barrier: Barrier) -> str:
    (x, y), (to_x, to_y) = barrier.ends
    middle = _place(Pose(0.5 * (x + to_x), 0.5 * (y + to_y), 0.0))
    if barrier.kind is not Kind.GAP:
        return f'behind {barrier.kind.value}, {barrier.width:.2f} m across at {middle}'
    if barrier.width >= found.gap:
        return f'behind a bend at {middle}, where {barrier.width:.3f} m are free'
    short = 1000.0 * (found.gap - barrier.width)
    return f'behind a gap of {barrier.width:.3f} m at {middle}, {short:.0f} mm too narrow'


def _specks(found: Findings) -> str:
    header, area = found.sheet.header, np.count_nonzero(found.specks) * found.plan.resolution ** 2
    if header.fill_unknown:
        return f'filled up to {header.fill_unknown:g} m2 each'
    return f'{found.specks.max()} of unknown cells, {area:.2f} m2 in all, count as walls' if area else 'none'


def _mission(found: Findings) -> str:
    expected = found.expected
    text = f'about {_time(expected.working + expected.charging)} with one robot'
    if not expected.charges:
        return f'{text}, without a charge'
    if not found.plan.docks:
        text = f'about {_time(expected.working)} of work'
    return f'{text}, {expected.charges} charge{"s" if expected.charges > 1 else ""} on the way'


def _to_add(found: Findings) -> str:
    wanted = []
    if found.dock is not None:
        wanted.append(f'dock: {_listed(found.dock)}')
    if found.closed and found.closed[0].area > found.expected.area:
        wanted.append(f'start: {_listed(found.closed[0].pose)}')
    if found.specks.any():
        wanted.append(f'fill_unknown: {SPECK}')
    return '; '.join(wanted) or 'nothing'


def _time(seconds: float) -> str:
    return f'{seconds / 3600.0:.1f} h' if seconds >= 5400.0 else f'{max(seconds / 60.0, 1.0):.0f} min'


def _place(pose: Pose) -> str:
    return f'({pose.x:.2f}, {pose.y:.2f}) m'


def _listed(pose: Pose) -> str:
    return f'[{pose.x:.3f}, {pose.y:.3f}, {pose.theta:.4f}]'
