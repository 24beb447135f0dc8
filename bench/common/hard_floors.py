"""Floors that are hard to clean, each drawn from a seed."""

import math

import numpy as np
from common.drawings import WALL, Drawing, box, disc, drawn, legs, outside, pentagon, turned, union
from common.wings import empty, furnished, office

from rumba_sim.model.common.geometry import Pose

THIN_WALL = 0.06  # [m] thickness
DOOR = 0.8  # [m]
DOCKING = 0.7  # [m] around a place before a dock, where there are no pits


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


def maze(generator):
    """A maze of corridors with one way to each cell, drawn by a walk that goes back where it cannot go on."""
    count, pitch = int(generator.integers(6, 9)), generator.uniform(0.55, 0.8) + THIN_WALL
    closed = {(i, j, side) for i in range(count) for j in range(count) for side in ('right', 'above')}
    seen, walk = {(0, 0)}, [(0, 0)]
    while walk:
        i, j = walk[-1]
        ways = [(to, wall) for to, wall in (((i + 1, j), (i, j, 'right')), ((i - 1, j), (i - 1, j, 'right')),
                                            ((i, j + 1), (i, j, 'above')), ((i, j - 1), (i, j - 1, 'above')))
                if 0 <= min(to) and max(to) < count and to not in seen]
        if not ways:
            walk.pop()
            continue
        to, wall = ways[generator.integers(len(ways))]
        closed.discard(wall)
        seen.add(to)
        walk.append(to)
    walls = []
    for i, j, side in sorted(closed):
        left, bottom, right, top = i * pitch, j * pitch, (i + 1) * pitch, (j + 1) * pitch
        walls.append(box(right - THIN_WALL, bottom - THIN_WALL, right, top) if side == 'right' else
                     box(left - THIN_WALL, top - THIN_WALL, right, top))
    return Drawing(count * pitch, count * pitch, union(walls))


def ring_corridor(generator):
    """A corridor around a round core."""
    radius, corridor = generator.uniform(1.5, 3.0), generator.uniform(0.5, 1.0)
    centre = radius + WALL
    return Drawing(2 * centre, 2 * centre, union([outside(disc(centre, centre, radius)),
                                                  disc(centre, centre, radius - corridor)]))


def winding(generator):
    """A corridor that winds to and fro like a sine."""
    half, length = generator.uniform(0.6, 0.9), generator.uniform(4.0, 6.0)
    return Drawing(8.0, 4.0, lambda x, y: np.abs(y - 2.0 - 1.3 * np.sin(2.0 * math.pi * x / length)) > half)


def star(generator):
    """A room with five round bays."""
    radius = generator.uniform(2.0, 3.5)

    def shape(x, y):
        return np.hypot(x - radius, y - radius) > radius * (
            0.65 + 0.3 * np.cos(5.0 * np.arctan2(y - radius, x - radius)))
    return Drawing(2 * radius, 2 * radius, shape)


def crossing(generator):
    """Two corridors that cross, along no axis."""
    half, angle = generator.uniform(0.4, 0.9), generator.uniform(0.0, 1.5)
    return Drawing(6.0, 6.0, turned(lambda x, y: (np.abs(x - 3.0) > half) & (np.abs(y - 3.0) > half), angle,
                                    (3.0, 3.0)))


def neck(generator):
    """Two rooms and a passage between them that is hardly wider than a robot."""
    half = generator.uniform(0.19, 0.25)
    return Drawing(7.0, 3.0, lambda x, y: (x > 2.2) & (x < 4.8) & (np.abs(y - 1.5) > half))


def posts(generator):
    """A room with thin posts all over it."""
    width, height = generator.uniform(3.0, 6.0, 2)
    count = int(width * height * generator.uniform(1.0, 4.0))
    return Drawing(width, height, union([disc(generator.uniform(0.5, width - 0.5), generator.uniform(0.5, height - 0.5),
                                              0.015) for _ in range(count)]))


def balcony(generator):
    """A floor along no axis with cliffs on all sides."""
    (width, height), angle = generator.uniform(2.5, 4.5, 2), generator.uniform(0.0, 1.5)
    reach = 0.5 * math.hypot(width, height) + 0.6
    inside = turned(box(reach - width / 2, reach - height / 2, reach + width / 2, reach + height / 2), angle,
                    (reach, reach))
    return Drawing(2 * reach, 2 * reach, union([]), outside(inside))


def shafts(generator):
    """A room with small square shafts on a grid."""
    width, height = generator.uniform(3.0, 5.0, 2)
    apart, half = generator.uniform(0.9, 1.3), generator.uniform(0.05, 0.15)
    return Drawing(width, height, union([]), lambda x, y: (np.abs(x % apart - apart / 2) < half) & (
        np.abs(y % apart - apart / 2) < half))


KINDS = {
    'spiral of 0.8 m': lambda generator: spiral(generator, 0.8),
    'spiral of 0.5 m': lambda generator: spiral(generator, 0.5),
    'chairs': chairs, 'dining': dining, 'tiny': tiny, 'slanted': slanted, 'round': round_room, 'jagged': jagged,
    'islands': islands, 'cliffs': cliffs, 'pits': pits, 'thin': thin, 'furnished': furnished, 'empty': empty,
    'furnished of 1,300 m2': lambda generator: furnished(generator, 1300.0), 'office': office, 'maze': maze,
    'ring corridor': ring_corridor, 'winding': winding, 'star': star, 'crossing': crossing, 'neck': neck,
    'posts': posts, 'balcony': balcony, 'shafts': shafts,
}


def floor(kind, seed, resolution):
    """The floor of a kind, the same at each call; another seed gives other sizes and places."""
    generator = np.random.default_rng([seed, *kind.encode()])
    return drawn(f'{kind} {seed} at {100.0 * resolution:g} cm', KINDS[kind](generator), resolution)
