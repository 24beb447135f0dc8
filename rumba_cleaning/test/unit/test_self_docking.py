"""Coming home to a dock that the robot finds by itself."""

import pytest
from rooms import room

from rumba_cleaning.behaviour import Observation, Status
from rumba_cleaning.behaviours.dock import TRIES, Dock
from rumba_cleaning.behaviours.self_docking import FARTHEST, PATIENCE, SEEK, SelfDocking
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.robot import Infrared

HOME = Pose(2.0, 1.0, 0.0)
BEFORE = Pose(1.2, 1.0, 0.0)  # where homing begins
BEAMS = Infrared(12, 0, 0)


@pytest.fixture
def context():
    """What a robot knows that docks by itself in an empty room."""
    found = Context(room(2.5, 2.0, dock=HOME), RobotConfig(), CleaningConfig())
    found.docks_itself = True
    return found


def seen(pose=BEFORE, **changes):
    """An observation."""
    return Observation(0.1, pose, **changes)


def test_it_goes_before_the_dock_and_has_the_robot_do_the_rest(context):
    dock = Dock(context)
    far = dock.step(seen(Pose(0.5, 0.5, 0.0), infrared=BEAMS))
    assert not far.seeks_dock and not dock.is_homing
    commands = [dock.step(seen()) for _ in range(50)]
    assert commands[-1] == SEEK and dock.is_homing
    dock.step(seen(HOME, is_docked=True))
    assert dock.status is Status.SUCCEEDED


def test_it_tries_again_from_before_the_dock_and_then_gives_up(context):
    dock, sought = Dock(context), 0
    for _ in range(int(10.0 * (TRIES + 1) * PATIENCE)):
        was_homing = dock.is_homing
        dock.step(seen())
        sought += dock.is_homing and not was_homing
        if dock.status is not Status.RUNNING:
            break
    assert (dock.status, sought) == (Status.FAILED, TRIES)
    assert dock.message == (f'{TRIES} attempts to dock failed: the robot did not dock by itself in {PATIENCE:g} s; it '
                            'received no beam of a dock')


def test_it_fails_if_the_robot_goes_astray(context):
    docking = SelfDocking(context, HOME)
    assert docking.step(seen(infrared=BEAMS)).seeks_dock
    docking.step(seen(HOME._replace(x=HOME.x - 0.9 * FARTHEST)))
    assert docking.status is Status.RUNNING
    docking.step(seen(HOME._replace(x=HOME.x - FARTHEST - 0.1)))
    assert (docking.status, docking.message) == (
        Status.FAILED, 'the robot went 2.1 m from where its dock was; it received beams of a dock')
