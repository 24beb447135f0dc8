"""Draws the map that a robot makes of the apartment, and its path: ./rumba shell python3 docs/pictures/mapping.py"""

import pathlib

import numpy as np
from PIL import Image, ImageDraw

from rumba_cleaning.mission.stages import State
from rumba_evaluation.trials.cases import SLAM, Conditions
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.maps import map_file, named_maps
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED

SCALE = 2  # pixels along the side of a cell
TRUE, WALL, FLOOR, BLANK = (150, 190, 240), (20, 20, 20), (255, 255, 255), (205, 205, 205)
EXPLORED, CLEANED = (230, 120, 20), (90, 160, 90)


def main():
    """Run a mission on a floor that the robot was not shown, and draw it."""
    truth = map_file.load(named_maps.path('apartment'))
    trial = Trial(truth, 'explore_and_clean', Conditions(pose=SLAM, target=0.98), seed=1)
    path = []
    while not trial.is_over:
        trial.step()
        mission, pose = trial.missions[0], trial.world.robots['rumba'].pose
        is_exploring = mission.state is State.CLEANING and mission.message.endswith('exploring')
        path.append((pose.x, pose.y, EXPLORED if is_exploring else CLEANED))
    plan = trial.sources['rumba'].plan()
    picture = Image.fromarray(coloured(plan, truth)).resize(
        (plan.columns * SCALE, plan.rows * SCALE), Image.NEAREST)
    draw = ImageDraw.Draw(picture)
    for (x, y, _), (to_x, to_y, colour) in zip(path, path[1:]):
        draw.line([pixel(plan, x, y), pixel(plan, to_x, to_y)], fill=colour)
    picture.quantize(64).save(str(pathlib.Path(__file__).with_name('mapping.png')), optimize=True)


def coloured(plan, truth):
    """The map that the robot made, over the true walls: uint8 (rows, columns, 3), row 0 at the top."""
    picture = np.full((plan.rows, plan.columns, 3), BLANK, np.uint8)
    for row, column in np.argwhere(truth.occupancy == OCCUPIED):
        at, across = plan.cell(*truth.centre(row, column))
        if 0 <= at < plan.rows and 0 <= across < plan.columns:
            picture[at, across] = TRUE
    picture[plan.occupancy == FREE] = FLOOR
    picture[plan.occupancy == OCCUPIED] = WALL
    return picture[::-1].copy()


def pixel(plan, x, y):
    """Where a point [m] of the map frame is in the picture."""
    left, bottom = plan.origin
    return (x - left) / plan.resolution * SCALE, (plan.rows - (y - bottom) / plan.resolution) * SCALE


if __name__ == '__main__':
    main()
