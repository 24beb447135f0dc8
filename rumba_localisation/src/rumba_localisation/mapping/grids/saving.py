"""Writes a map that a robot has made as one of map_server, with its dock and its cliffs: `map:=` takes it."""

import os
import pathlib

from rumba_sim.model.common.errors import MapError, quoted
from rumba_sim.model.maps import drawing
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, FloorPlan

TITLE = 'A map that a robot has made'


def save(path: str, plan: FloorPlan) -> None:
    """Write a map: the YAML file, an image of the floor, and one of the cliffs if there are any.

    Args:
        path: of the YAML file; the images are written beside it.
        plan: the map, with its dock and its cliffs, if any.

    Raises:
        MapError: the path does not end in .yaml, or cannot be written.
    """
    folder, file = os.path.split(os.path.abspath(path))
    name, ending = os.path.splitext(file)
    if ending != '.yaml' or not name:
        raise MapError(f'{quoted(path)}: the file of a map must end in .yaml')
    drawn = drawing.Drawing(*plan.bounds, plan.resolution)
    drawn.paint(plan.occupancy == FREE, drawing.FREE)
    drawn.paint(plan.occupancy == OCCUPIED)
    if plan.cliff is not None:
        drawn.layers['cliff'] = plan.cliff
    try:
        drawn.save(pathlib.Path(folder), name, TITLE, {} if plan.dock is None else {'dock': plan.dock})
    except OSError as error:
        raise MapError(f'{path}: cannot be written: {error.strerror}') from error
