"""Floors that are hard to clean, drawn from a seed at any resolution.

Each floor is a function of x and y that says where walls and cliffs are. A cell is a wall if any of the points that are
looked at in it is one, so that thin walls and legs do not vanish on large cells.
"""

import math
from typing import Callable, NamedTuple, Optional

import numpy as np

from rumba_sim.model.floor_plan import FREE, OCCUPIED, FloorPlan
from rumba_sim.model.geometry import Pose

SAMPLE = 0.025  # [m] between the points that are looked at within a cell, at most
WALL = 0.1  # [m] thickness
LEG = 0.02  # [m] radius of the leg of a chair or a table
DOOR = 0.8  # [m]
DOCKING = 0.7  # [m] around a place before a dock, where there are no pits


class Drawing(NamedTuple):
    """A floor; its corner lies at (0, 0)."""

    width: float  # [m]
    height: float  # [m]
    is_wall: Callable  # of x and y, arrays [m]: bool
    is_cliff: Optional[Callable] = None
    dock: Optional[Pose] = None


def drawn(name, drawing, resolution):
    """The floor plan of a drawing with cells of a resolution [m]."""
    columns, rows = (math.ceil(side / resolution - 1e-6) + 2 for side in (drawing.width, drawing.height))
    count = max(math.ceil(resolution / SAMPLE - 1e-6), 1)
    wall, cliff = np.zeros((2, rows, columns), bool)
    for up in (np.arange(count) + 0.5) / count:
        for right in (np.arange(count) + 0.5) / count:
            x = ((np.arange(columns) + right - 1.0) * resolution)[np.newaxis]
            y = ((np.arange(rows) + up - 1.0) * resolution)[:, np.newaxis]
            inside = (x > 0.0) & (x < drawing.width) & (y > 0.0) & (y < drawing.height)
            wall |= ~inside | drawing.is_wall(x, y)
            if drawing.is_cliff is not None:
                cliff |= drawing.is_cliff(x, y)
    return FloorPlan(name, np.where(wall, OCCUPIED, FREE), resolution, (-resolution, -resolution),
                     cliff=None if drawing.is_cliff is None else cliff & ~wall, dock=drawing.dock)


# --- shapes: functions of x and y -----------------------------------------------------------------------------------

def union(shapes):
    """Where any of the shapes is."""
    def shape(x, y):
        found = np.zeros(np.broadcast(x, y).shape, bool)
        for part in shapes:
            found |= part(x, y)
        return found
    return shape


def box(left, bottom, right, top):
    """A rectangle along the axes."""
    return lambda x, y: (x > left) & (x < right) & (y > bottom) & (y < top)


def disc(centre_x, centre_y, radius):
    """A disc."""
    return lambda x, y: np.hypot(x - centre_x, y - centre_y) < radius


def pentagon(centre_x, centre_y, radius):
    """A pentagon with equal sides; `radius` [m] is that of the circle in it."""
    sides = [(math.cos(angle), math.sin(angle)) for angle in 0.4 * math.pi * np.arange(5)]
    return lambda x, y: np.max([(x - centre_x) * cos + (y - centre_y) * sin for cos, sin in sides], axis=0) < radius


def turned(shape, angle, about):
    """A shape turned about a point."""
    cos, sin = math.cos(angle), math.sin(angle)
    return lambda x, y: shape(about[0] + cos * (x - about[0]) + sin * (y - about[1]),
                              about[1] - sin * (x - about[0]) + cos * (y - about[1]))


def outside(shape):
    """Everything but a shape."""
    return lambda x, y: ~shape(x, y)


def legs(x, y, width, depth, angle=0.0):
    """Four legs of a table or a chair around a point."""
    corners = [(x + a * width / 2, y + b * depth / 2) for a in (-1, 1) for b in (-1, 1)]
    return turned(union([disc(*corner, LEG) for corner in corners]), angle, (x, y))


# --- floors: functions of a random generator ------------------------------------------------------------------------

def spiral(generator, corridor):
    """A square spiral of one corridor, so wide [m]."""
    pitch, turns = corridor + WALL, int(generator.integers(3, 5))
    side = 2 * turns * pitch + WALL
    corners = [(0.0, 0.0)]
    for turn in range(turns):
        low, high = turn * pitch, side - WALL - turn * pitch
        corners += [(high, low), (high, high), (low, high), (low, low + pitch)]
    walls = [box(min(x, to_x), min(y, to_y), max(x, to_x) + WALL, max(y, to_y) + WALL)
             for (x, y), (to_x, to_y) in zip(corners, corners[1:])]
    return Drawing(side, side, union(walls))


def chairs(generator):
    """Chairs and tables all over a room: nothing but their legs touches the floor."""
    width, height = generator.uniform(4.0, 7.0, 2)
    places = [(x, y) for x in np.arange(0.9, width - 0.8, 1.3) for y in np.arange(0.9, height - 0.8, 1.3)]
    shapes = []
    for x, y in places:
        side = 0.42 if generator.random() < 0.7 else 0.8
        dx, dy = generator.uniform(-0.2, 0.2, 2)
        shapes.append(legs(x + dx, y + dy, side, side, generator.uniform(0.0, math.pi)))
    return Drawing(width, height, union(shapes))


def dining(generator):
    """A room with a long table and chairs around it, and a sideboard."""
    width, height = generator.uniform(4.0, 5.5, 2)
    x, y, chairs_beside = width / 2, height / 2, int(generator.integers(2, 4))
    length = 0.65 * chairs_beside
    shapes = [legs(x, y, length, 0.85), box(0.0, height - 0.45, generator.uniform(1.0, 2.0), height)]
    for number in range(chairs_beside):
        for side in (-1, 1):
            shapes.append(legs(x + (number - (chairs_beside - 1) / 2) * 0.6, y + side * generator.uniform(0.55, 0.75),
                               0.4, 0.4, generator.uniform(-0.3, 0.3)))
    return Drawing(width, height, union(shapes))


def tiny(generator):
    """Rooms of 1.2 to 2.2 m with doors between them."""
    columns, rows = 4, 3
    x, y = (np.concatenate([[0.0], np.cumsum(generator.uniform(1.2, 2.2, count))]) for count in (columns, rows))
    walls, doors = [], []
    for column in range(1, columns):
        walls.append(box(x[column] - WALL / 2, 0.0, x[column] + WALL / 2, y[-1]))
        for row in range(rows):
            if row == 0 or generator.random() < 0.4:
                at = generator.uniform(y[row] + 0.1, y[row + 1] - 0.1 - 0.65)
                doors.append(box(x[column] - WALL, at, x[column] + WALL, at + 0.65))
    for row in range(1, rows):
        walls.append(box(0.0, y[row] - WALL / 2, x[-1], y[row] + WALL / 2))
        for column in range(columns):
            at = generator.uniform(x[column] + 0.1, x[column + 1] - 0.1 - 0.65)
            doors.append(box(at, y[row] - WALL, at + 0.65, y[row] + WALL))
    wall, door = union(walls), union(doors)
    return Drawing(x[-1], y[-1], lambda x, y: wall(x, y) & ~door(x, y))


def slanted(generator):
    """Three rooms whose walls run along no axis, and not all at right angles."""
    width, height, angle = generator.uniform(6.0, 8.0), generator.uniform(4.0, 5.0), generator.uniform(0.15, 0.7)
    reach = 0.5 * math.hypot(width, height) + 0.2
    about = (reach, reach)
    left, bottom = reach - width / 2, reach - height / 2
    inner = turned(box(left + width * 0.45, bottom - 1.0, left + width * 0.45 + WALL, bottom + height - DOOR), 0.15,
                   (left + width * 0.45, bottom))
    second = box(left + width * 0.5, bottom + height * 0.5, left + width - DOOR, bottom + height * 0.5 + WALL)
    shape = union([outside(box(left, bottom, left + width, bottom + height)), inner, second])
    return Drawing(2 * reach, 2 * reach, turned(shape, angle, about))


def round_room(generator):
    """A round room with round pillars."""
    radius = generator.uniform(2.5, 4.0)
    pillars = []
    for number in range(5):
        angle, away = 2 * math.pi * number / 5 + generator.uniform(0.0, 0.5), generator.uniform(0.3, 0.7) * radius
        pillars.append(disc(radius + away * math.cos(angle), radius + away * math.sin(angle),
                            generator.uniform(0.1, 0.4)))
    return Drawing(2 * radius, 2 * radius, union([outside(disc(radius, radius, radius)), *pillars]))


def jagged(generator):
    """Two rooms whose walls are as uneven as those that a laser maps: up to 6 cm, in pieces of 5 cm."""
    width, height = generator.uniform(5.0, 7.0), generator.uniform(3.0, 5.0)
    noise_x, noise_y = generator.uniform(-0.06, 0.06, (2, 200, 200))
    middle = width * 0.45
    walls = union([outside(box(0.1, 0.1, width - 0.1, height - 0.1)), box(middle, 0.0, middle + 0.12, height - 1.1),
                   box(width - 1.5, 0.0, width - 0.6, 0.9), box(0.8, height - 0.7, 2.0, height)])

    def shape(x, y):
        column = np.clip(np.floor(x / 0.05).astype(int), 0, 199)
        row = np.clip(np.floor(y / 0.05).astype(int), 0, 199)
        return walls(x + noise_x[row, column], y + noise_y[row, column])
    return Drawing(width, height, shape)


def islands(generator):
    """A hall with blocks that stand free, along no axis."""
    width, height = generator.uniform(7.0, 10.0, 2)
    blocks = []
    for x in np.arange(1.5, width - 1.0, 2.0):
        for y in np.arange(1.5, height - 1.0, 2.0):
            half_x, half_y = generator.uniform(0.15, 0.5, 2)
            centre = x + generator.uniform(-0.3, 0.3), y + generator.uniform(-0.3, 0.3)
            blocks.append(turned(box(centre[0] - half_x, centre[1] - half_y, centre[0] + half_x, centre[1] + half_y),
                                 generator.uniform(0.0, math.pi), centre))
    return Drawing(width, height, union(blocks))


def cliffs(generator):
    """A landing with stairs that lead down on several sides, and one hole in its middle."""
    width, height = generator.uniform(5.0, 7.0, 2)
    holes = union([box(0.0, 0.0, generator.uniform(0.8, 1.2), generator.uniform(1.5, 2.5)),
                   box(width - generator.uniform(1.5, 2.5), height - 0.9, width, height),
                   box(width / 2 - 0.4, height / 2 - 0.5, width / 2 + 0.6, height / 2 + 0.3),
                   turned(box(width - 1.5, 0.6, width - 0.7, 1.2), 0.5, (width - 1.0, 0.9))])
    return Drawing(width, height, box(1.5, 0.0, 1.9, 0.9), holes)


def pits(generator):
    """A room with up to five pits: boxes, angles, discs and pentagons; none is before the dock."""
    width, height = generator.uniform(4.0, 6.5), generator.uniform(3.5, 5.0)
    dock = Pose(0.19, 0.5 * height, math.pi)
    angles = np.arange(0.0, 2.0 * math.pi, 0.05)
    away = np.linspace(0.0, DOCKING, 30)[:, np.newaxis]
    before_dock = dock.x + 0.4 + away * np.cos(angles), dock.y + away * np.sin(angles)
    found = [_pit(generator, (generator.uniform(1.0, width - 0.4), generator.uniform(0.4, height - 0.4)))
             for _ in range(generator.integers(2, 6))]
    return Drawing(width, height, union([]), union([pit for pit in found if not pit(*before_dock).any()]), dock)


def _pit(generator, centre):
    """A pit about a point."""
    x, y = centre
    size, depth = generator.uniform(0.12, 0.6), generator.uniform(0.1, 0.5)
    shapes = [box(x - size, y - depth, x + size, y + depth),
              union([box(x - size, y - 0.12, x + size, y + 0.12), box(x + size - 0.12, y, x + size + 0.12, y + size)]),
              disc(x, y, size), pentagon(x, y, size)]
    return turned(shapes[generator.integers(4)], generator.uniform(0.0, math.pi), centre)


def thin(generator):
    """Rooms between walls that are 2 cm thick."""
    width, height = generator.uniform(5.0, 8.0, 2)
    walls = []
    for number, x in enumerate(np.arange(1.6, width - 1.0, generator.uniform(1.4, 2.2))):
        low = 0.0 if number % 2 else DOOR
        walls.append(box(x - 0.01, low, x + 0.01, low + height - DOOR))
    return Drawing(width, height, union(walls))


def furnished(generator, area=250.0):
    """Wings of rooms on both sides of corridors, of an area in all [m2], with furniture."""
    return _wings(generator, area, 0.35)


def empty(generator, area=250.0):
    """The same without furniture."""
    return _wings(generator, area, 0.0)


def office(generator):
    """An office of 60 x 60 m."""
    return _wings(generator, 3600.0, 0.15)


def _wings(generator, area, pieces):
    """Wings, one above the other, joined by a corridor at their left; `pieces` of furniture for each m2."""
    side, corridor, depth = math.sqrt(area), 1.6, 4.4
    count = max(round(side / (2 * depth + corridor)), 1)
    height = side / count
    walls, doors, shapes = [], [], []
    for wing in range(count):
        bottom, middle = wing * height, (wing + 0.5) * height
        for low, high, wall in ((bottom, middle - corridor / 2, middle - corridor / 2),
                                (middle + corridor / 2, bottom + height, middle + corridor / 2)):
            walls.append(box(corridor, wall - WALL / 2, side, wall + WALL / 2))
            left = corridor
            while left < side - 1.0:
                right = min(left + generator.uniform(3.0, 6.0), side)
                right = side if side - right < 2.5 else right
                walls.append(box(left - WALL / 2, low, left + WALL / 2, high))
                at = generator.uniform(left + 0.2, right - 0.3 - 0.9)
                doors.append(box(at, wall - WALL, at + 0.9, wall + WALL))
                shapes += _furniture(generator, (left, low, right, high), pieces, (at, wall))
                left = right
        walls.append(box(corridor, bottom - WALL / 2, side, bottom + WALL / 2))
    wall, door, piece = union(walls), union(doors), union(shapes or [box(0.0, 0.0, 0.0, 0.0)])
    return Drawing(side, side, lambda x, y: wall(x, y) & ~door(x, y) | piece(x, y))


def _furniture(generator, room, pieces, door):
    """Cupboards along the walls, a table with chairs; nothing near the door."""
    left, bottom, right, top = room
    found = []
    for _ in range(round((right - left) * (top - bottom) * pieces)):
        width, depth = generator.uniform(0.4, 1.6), generator.uniform(0.35, 0.8)
        x, y = generator.uniform(left, right - width), generator.uniform(bottom, top - depth)
        kind = generator.random()
        if kind < 0.3:
            x = left if kind < 0.15 else right - width
        elif kind < 0.6:
            y = bottom if kind < 0.45 else top - depth
        if math.hypot(x + width / 2 - door[0] - 0.45, y + depth / 2 - door[1]) < 1.6:
            continue
        is_table = kind > 0.85
        found.append(legs(x + width / 2, y + depth / 2, width, depth) if is_table else box(x, y, x + width, y + depth))
    return found


KINDS = {
    'spiral of 0.8 m': lambda generator: spiral(generator, 0.8),
    'spiral of 0.5 m': lambda generator: spiral(generator, 0.5),
    'chairs': chairs, 'dining': dining, 'tiny': tiny, 'slanted': slanted, 'round': round_room, 'jagged': jagged,
    'islands': islands, 'cliffs': cliffs, 'pits': pits, 'thin': thin, 'furnished': furnished, 'empty': empty,
    'furnished of 1,300 m2': lambda generator: furnished(generator, 1300.0), 'office': office,
}


def floor(kind, seed, resolution):
    """The floor of a kind, the same at each call; another seed gives other sizes and places."""
    generator = np.random.default_rng([seed, *kind.encode()])
    return drawn(f'{kind} {seed} at {100.0 * resolution:g} cm', KINDS[kind](generator), resolution)
