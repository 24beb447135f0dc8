"""Floors of large buildings, drawn from a random generator: wings of rooms on both sides of corridors."""

import math

from common.drawings import WALL, Drawing, box, legs, union


def furnished(generator, area=250.0):
    """Wings of rooms on both sides of corridors, of an area in all [m2], with furniture."""
    return _wings(generator, area, 0.35)


def empty(generator, area=250.0):
    """The same without furniture."""
    return _wings(generator, area, 0.0)


def office(generator):
    """An office of 60 x 60 m."""
    return _wings(generator, 3600.0, 0.15)


def shops(generator, area=2400.0):
    """Shops and offices of an area in all [m2]."""
    return _wings(generator, area, 0.15)


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
