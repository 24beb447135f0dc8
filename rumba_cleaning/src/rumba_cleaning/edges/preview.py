"""What a command leads to, by what the drive of a robot can do."""

from rumba_cleaning.behaviour import Command
from rumba_cleaning.edges.compiled_preview import HOLD_STEPS, ROUNDING, Wheels, path
from rumba_cleaning.edges.slip import Slip
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array
from rumba_sim.model.settings.robot_config import DriveConfig

MOSTLY = 0.25  # speed of the middle of a robot, as a share of the difference of its wheels, beyond which it does not
#                just turn; our choice


class Preview:
    """Looks ahead for one robot.

    Attributes:
        drive: of the robot.
        half: distance of its wheels from its middle [m].
    """

    def __init__(self, drive: DriveConfig) -> None:
        """Look ahead for a robot with this drive."""
        self.drive = drive
        self.half = 0.5 * drive.wheel_base

    def wanted(self, command: Command) -> Wheels:
        """The speeds of the wheels that a command asks for, within the limits of the drive [m/s]."""
        drive = self.drive
        v = min(max(command.v, -drive.max_speed), drive.max_speed)
        w = min(max(command.w, -drive.max_turn_rate), drive.max_turn_rate)
        left, right = v - w * self.half, v + w * self.half
        share = min(1.0, drive.max_speed / max(abs(left), abs(right), 1e-9))
        return share * left, share * right

    def after(self, speeds: Wheels, wanted: Wheels, seconds: float) -> Wheels:
        """The speeds of the wheels so long after these speeds were commanded [m/s]."""
        change = self.drive.acceleration * seconds
        (left, right), (left_goal, right_goal) = speeds, wanted
        return (min(max(left_goal, left - change), left + change),
                min(max(right_goal, right - change), right + change))

    def limited(self, command: Command, speed: float) -> Command:
        """The same bend, with the outer wheel no faster than a speed [m/s]."""
        asked = abs(command.v) + abs(command.w) * self.half  # more than the drive can do, perhaps
        return command if asked <= speed else part_of(command, speed / asked)

    def moves(self, command: Command) -> bool:
        """Whether a wheel turns at all."""
        return faster(self.wanted(command)) >= self.drive.dead_band

    def path(self, pose: Pose, speeds: Wheels, wanted: Wheels, slip: Slip, hold: int = HOLD_STEPS) -> Array:
        """Where the robot, its left and its right wheel are after a command, until it has stopped: see `path`."""
        return path(pose, speeds, wanted, slip, self.half, self.drive.acceleration, hold)

    def curvature(self, speeds: Wheels) -> float:
        """Curvature of the path of wheels that are so fast [m/s]: [1/m]."""
        left, right = speeds
        return abs(right - left) / (self.half * max(abs(left + right), ROUNDING))


def part_of(command: Command, share: float) -> Command:
    """The same bend at a share of the speed."""
    return command._replace(v=share * command.v, w=share * command.w)


def faster(speeds: Wheels) -> float:
    """Speed of the faster wheel, forward or back [m/s]."""
    left, right = speeds
    return max(abs(left), abs(right))


def goes_back(speeds: Wheels) -> bool:
    """Whether the middle of a robot goes back; not if it turns, nearly on the spot."""
    left, right = speeds
    return 0.5 * (left + right) < -MOSTLY * abs(right - left)
