"""Maps as people have them, drawn from seeds: rays, specks, niches, closed rooms, narrow gaps, ragged walls."""

from typing import NamedTuple

import numpy as np
from common import drawings, wings
from scipy import ndimage

from rumba_sim.model.common.config import from_mapping
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, UNKNOWN
from rumba_sim.model.settings.robot_config import RobotConfig

ROBOTS = {
    'rumba': {},
    'turtlebot3': {'drive': {'radius': 0.105, 'wheel_base': 0.16, 'wheel_diameter': 0.066, 'max_speed': 0.22,
                             'max_turn_rate': 2.84}, 'brush': {'width': 0.12}},
    'scrubber': {'drive': {'radius': 0.28, 'wheel_base': 0.45, 'wheel_diameter': 0.15, 'max_speed': 0.7,
                           'acceleration': 0.6}, 'brush': {'width': 0.45},
                 'cliff': {'distance': 0.265, 'outer_angle': 1.2}},
}
CANVASES = (0, 1000, 4000)  # [pixels] of a side
RESOLUTIONS = (0.05, 0.05, 0.025)  # [m]
ANNEX = 3.5  # [m] how far closed rooms and niches lie beyond the right wall
SPECKS = 3.0  # of one cell, for a square metre
RAGGED = 0.25  # share of the cells beside walls that are walls too


class Home(NamedTuple):
    """A map and the robot for it."""

    seed: int
    robot: str
    cells: np.ndarray  # int8 (rows, columns), row 0 at the bottom
    floor: np.ndarray  # bool, the same shape: where nothing stands, if specks count as the map says
    resolution: float  # [m]
    size: int  # of a side of the canvas [pixels]
    rays: int
    keys: str  # further lines of the YAML file
    has_dock: bool  # to be placed as `place_dock` offers
    traits: str  # what is special about it, for people

    @property
    def config(self):
        """What the robot is like."""
        return from_mapping(RobotConfig, ROBOTS[self.robot], self.robot)


def home(seed):
    """The home of a seed, the same at each call."""
    generator = np.random.default_rng([seed, 63])
    robot = list(ROBOTS)[seed % len(ROBOTS)]
    resolution = float(generator.choice(RESOLUTIONS))
    area = float(generator.uniform(60.0, 260.0) if robot == 'scrubber' else generator.uniform(35.0, 220.0))
    draw = wings.furnished if generator.random() < 0.7 else wings.empty
    cells = drawings.drawn('home', draw(generator, area), resolution).occupancy.copy()
    traits = [f'{100.0 * resolution:g} cm']
    if generator.random() < 0.3:
        cells = ragged(generator, cells)
        traits.append('ragged')
    cells, more = _with_annex(generator, cells, resolution, 2.0 * from_mapping(
        RobotConfig, ROBOTS[robot], robot).drive.radius)
    traits += more
    bare, keys = cells.copy(), ''
    if generator.random() < 0.5:
        cells = specked(generator, cells, resolution)
        is_filled = bool(generator.random() < 0.5)
        keys = 'fill_unknown: 0.05\n' if is_filled else ''
        traits.append('filled specks' if is_filled else 'specks')
        bare = bare if is_filled else cells
    rays = 9 if generator.random() < 0.6 else 0
    traits += ['rays'] * bool(rays)
    return Home(seed, robot, cells, bare == FREE, resolution, int(generator.choice(CANVASES)), rays, keys,
                bool(generator.random() < 0.5), ', '.join(traits))


def ragged(generator, cells):
    """Cells with walls as a laser maps them."""
    walls = cells != FREE
    beside = ndimage.binary_dilation(walls) & ~walls
    return np.where(beside & (generator.random(cells.shape) < RAGGED), OCCUPIED, cells).astype(np.int8)


def specked(generator, cells, resolution):
    """Cells of which some on the floor, away from walls, were never seen."""
    found = cells.copy()
    inner = np.argwhere(ndimage.binary_erosion(cells == FREE, np.ones((3, 3)), 2))
    count = round(SPECKS * len(inner) * resolution ** 2)
    for row, column in inner[generator.choice(len(inner), count, replace=False)]:
        found[row, column] = UNKNOWN
    return found


def _with_annex(generator, cells, resolution, diameter):
    """Cells with rooms and niches behind the right wall: closed, or behind gaps around the width of a robot [m]."""
    deep = round(ANNEX / resolution)
    left = cells.shape[1] - 1
    found = np.pad(cells, ((0, 0), (0, deep)), constant_values=OCCUPIED)
    traits, bottom = [], round(0.3 / resolution)
    while bottom + round(3.0 / resolution) < cells.shape[0]:
        kind = str(generator.choice(['nothing', 'closed', 'gap', 'niche']))
        high = round(float(generator.uniform(1.5, 2.8)) / resolution) if kind != 'niche' else round(0.5 / resolution)
        if kind != 'nothing':
            wide = round(float(generator.uniform(1.0, 3.0) if kind != 'niche' else 0.45) / resolution)
            neck = round(float(generator.uniform(0.1, 0.2)) / resolution)
            found[bottom:bottom + high, left + neck:left + neck + wide] = FREE
            text = kind
            if kind != 'closed':
                gap = int(np.ceil(diameter / resolution)) + int(generator.integers(-2, 4))
                low = bottom + (high - gap) // 2
                found[low:low + gap, left - 2:left + neck] = FREE
                text = f'{kind} of {gap * resolution:.3g} m'
            traits.append(text)
        bottom += high + round(0.4 / resolution)
    return found, traits
