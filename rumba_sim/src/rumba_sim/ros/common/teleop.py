"""The input of a robot for the commands of a person, which override those of programs."""

TOPIC = 'teleop/cmd_vel'  # below the robot's name
TIMEOUT = 0.5  # [s] of the wall clock after a command, until which it overrides those of programs
