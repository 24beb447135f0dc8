"""The input of a robot for the commands of a person, which override those of programs."""

from rumba_sim.model.settings.robot_config import DriveConfig

TOPIC = 'teleop/cmd_vel'  # below the robot's name
TIMEOUT = 0.5  # [s] of the wall clock after a command, until which it overrides those of programs
LINEAR_RANGE = (0.02, DriveConfig.max_speed)  # [m/s] speeds that a person can choose
ANGULAR_RANGE = (0.1, DriveConfig.max_turn_rate)  # [rad/s]
