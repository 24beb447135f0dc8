"""The wheels: how fast they turn, and what encoders and odometry measure of it."""

import math

from rumba_sim.model.kernel import Array, Record
from rumba_sim.model.kernel.geometry import arc
from rumba_sim.model.kernel.records import NEVER


def drive(robot: Record, k: Record, now: int) -> None:
    """Change the speeds of the wheels toward the last command, as far as the limits allow."""
    v, w = 0.0, 0.0
    if robot.command_tick != NEVER and now - robot.command_tick < k.timeout_ticks and robot.charge > 0.0 and (
            not robot.fallen):
        v = min(max(robot.command_v, -k.max_speed), k.max_speed)
        w = min(max(robot.command_w, -k.max_turn_rate), k.max_turn_rate)
    left, right = v - 0.5 * w * k.wheel_base, v + 0.5 * w * k.wheel_base
    fastest = max(abs(left), abs(right))
    if fastest > k.max_speed:  # both by the same factor, so that the arc stays the same
        left, right = left * k.max_speed / fastest, right * k.max_speed / fastest
    robot.left_speed = approach(robot.left_speed, left, k)
    robot.right_speed = approach(robot.right_speed, right, k)


def approach(speed: float, wanted: float, k: Record) -> float:
    """The speed of a wheel after one tick of acceleration toward the wanted speed."""
    if abs(wanted) < k.dead_band:
        wanted = 0.0
    change = k.acceleration * k.dt
    return min(max(wanted, speed - change), speed + change)


def count(robot: Record, k: Record, traction: float, noise: Array) -> None:
    """Count the encoder ticks of both wheels, with slip, scale and noise, and update the odometry from them alone."""
    left, right = robot.left_speed * k.dt, robot.right_speed * k.dt
    left = left / traction * robot.left_scale + k.noise * math.sqrt(abs(left)) * noise[0]
    right = right / traction * robot.right_scale + k.noise * math.sqrt(abs(right)) * noise[1]
    robot.odom_v, robot.odom_w = 0.5 * (left + right) / k.dt, (right - left) / k.wheel_base / k.dt
    robot.left_path += left
    robot.right_path += right
    left_ticks = math.floor(robot.left_path * k.ticks_per_metre)
    right_ticks = math.floor(robot.right_path * k.ticks_per_metre)
    left = (left_ticks - robot.left_ticks) / k.ticks_per_metre
    right = (right_ticks - robot.right_ticks) / k.ticks_per_metre
    robot.left_ticks, robot.right_ticks = left_ticks, right_ticks
    if left != 0.0 or right != 0.0:
        robot.odom_x, robot.odom_y, robot.odom_theta = arc(
            robot.odom_x, robot.odom_y, robot.odom_theta, 0.5 * (left + right), (right - left) / k.wheel_base)
