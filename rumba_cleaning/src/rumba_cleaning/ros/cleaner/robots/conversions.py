"""Converts between messages and what behaviours know and command: pure functions."""

import math

from geometry_msgs.msg import Pose2D, Twist, Vector3
from std_msgs.msg import Header

from rumba_cleaning.behaviour import CERTAIN, Command, Covariance, Observation
from rumba_cleaning.mission.stages import State
from rumba_cleaning.outcome import Outcome
from rumba_msg.msg import Bumper, CleaningStatus, Cliff, DockStatus, MissionStatus
from rumba_msg.msg import Outcome as OutcomeMessage
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.robot import Infrared
from rumba_sim.ros.common.frames import MAP


def observation(pose: Pose, bumper: Bumper, cliff: Cliff, dock: DockStatus, state_of_charge: float,
                covariance: Covariance = CERTAIN) -> Observation:
    """What a robot knows, for its behaviours; dt is 0."""
    return Observation(
        dt=0.0, pose=pose, bumper=(bumper.is_left_pressed, bumper.is_right_pressed),
        cliffs=(cliff.is_cliff_left, cliff.is_cliff_front_left, cliff.is_cliff_front_right, cliff.is_cliff_right),
        state_of_charge=state_of_charge, is_docked=dock.is_docked,
        infrared=Infrared(dock.infrared_omni, dock.infrared_left, dock.infrared_right),
        covariance=covariance)


def velocity(command: Command) -> Twist:
    """The velocity of a command."""
    return Twist(Vector3(command.v, 0.0, 0.0), Vector3(0.0, 0.0, command.w))


def pose_message(pose: Pose) -> Pose2D:
    """A pose in the plane."""
    return Pose2D(*pose)


def mission_status(state: State, strategy: str, message: str, stamp: object) -> MissionStatus:
    """What a robot does."""
    return MissionStatus(Header(stamp=stamp, frame_id=MAP), int(state), strategy, message)


def outcome(code: Outcome, message: str) -> OutcomeMessage:
    """How a goal ended."""
    return OutcomeMessage(int(code), message)


def no_cleaning_status() -> CleaningStatus:
    """The state of a floor that nobody measures: NaN."""
    return CleaningStatus(Header(), *[math.nan] * 6)
