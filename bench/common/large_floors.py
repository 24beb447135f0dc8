"""Large floors with other shapes than rooms along corridors, as drawings."""

import math

import numpy as np
from common.drawings import Drawing, box, legs, outside, turned, union
from common.wings import furnished, office


def hall(side):
    """An empty hall."""
    return Drawing(side, side, box(0.0, 0.0, 0.0, 0.0))


def pillars(side, apart, radius):
    """A hall with round pillars on a grid."""
    return Drawing(side, side, lambda x, y: np.hypot(x % apart - apart / 2, y % apart - apart / 2) < radius)


def chairs(side, count):
    """A hall with chairs all over it."""
    generator = np.random.default_rng(1)
    places = [(*generator.uniform(0.5, side - 1.0, 2), generator.uniform(0.0, 1.5)) for _ in range(count)]
    return Drawing(side, side, union([legs(x, y, 0.4, 0.4, angle) for x, y, angle in places]))


def racks(side):
    """A store: racks 1 m deep with ways of 2 m between them, and one across the middle."""
    return Drawing(side, side,
                   lambda x, y: (x % 3.0 > 2.0) & (y > 1.5) & (y < side - 1.5) & (np.abs(y - side / 2) > 1.0))


def askew(drawing, angle):
    """A floor whose walls are turned against the axes of its map [rad], in the middle of a larger one."""
    reach = 0.5 * math.hypot(drawing.width, drawing.height) + 0.2
    left, bottom = reach - drawing.width / 2, reach - drawing.height / 2
    around = outside(box(left, bottom, left + drawing.width, bottom + drawing.height))
    inner = union([around, lambda x, y: drawing.is_wall(x - left, y - bottom)])
    return Drawing(2 * reach, 2 * reach, turned(inner, angle, (reach, reach)))


def drawings():
    """Large floors, by what they are."""
    generator = np.random.default_rng
    return {
        'hall of 30 m with 350 chairs': chairs(30.0, 350),
        'hall of 30 m with 225 pillars': pillars(30.0, 2.0, 0.2),
        'furnished, 1200 m2 in all, askew': askew(furnished(generator(1), 1200.0), 0.3),
        'store of 60 m': racks(60.0),
        'hall of 60 m': hall(60.0),
        'hall of 60 m with 225 pillars': pillars(60.0, 4.0, 0.3),
        'office of 60 m, askew': askew(office(generator(1)), 0.3),
    }
