"""The types of the records of robots, obstacles and tallies, and the columns of stops and docks."""

import numpy as np

NEVER = -1  # `command_tick` of a robot that has had no command
ROBOT = np.dtype((np.record, np.dtype([(name, 'f8') for name in (
    'x', 'y', 'theta', 'left_speed', 'right_speed', 'command_v', 'command_w', 'left_scale', 'right_scale',
    'left_path', 'right_path', 'odom_x', 'odom_y', 'odom_theta', 'odom_v', 'odom_w', 'charge', 'current', 'distance',
    'brush_time', 'contact_angle', 'swept_x', 'swept_y', 'swept_theta', 'swept_distance')] + [
        (name, 'i8') for name in ('command_tick', 'left_ticks', 'right_ticks', 'bumps', 'alone_until')] + [
            (name, 'u1') for name in ('bumper', 'brushes_up', 'docked', 'fallen', 'sweeps')] + [
                ('cliff_ticks', 'i8', 4)], align=True)))  # for so many ticks more each sensor tells of a cliff
# A disc has a radius, and halves that are 0; a box has halves, and a radius that is 0. `reach` is the distance from its
# centre to its farthest point. A mover has `stops` stops from row `first` of the array of stops on; it has left number
# `stop` of them, `moved` [ticks] ago, or stands there for `rest` ticks more; it has reached stops `visits` times. For
# `waited` ticks a robot has been in its way; `is_back` while it goes back, for lack of patience. It has turned back
# `retreats` times on the way to the same stop, and is `behind` stops before the one from which that way leads.
OBSTACLE = np.dtype((np.record, np.dtype([(name, 'f8') for name in (
    'x', 'y', 'theta', 'cos', 'sin', 'half_length', 'half_width', 'radius', 'reach', 'moved')] + [
        (name, 'i8') for name in (
            'first', 'stops', 'stop', 'rest', 'visits', 'waited', 'retreats', 'behind', 'key')] + [
                (name, 'u1') for name in ('is_back', 'is_seen')], align=True)))
X, Y, THETA = 0, 1, 2  # columns of a stop and of a dock: its pose [m, rad]
TRAVEL = 3  # [ticks] that the way from the stop before takes
LEAST, MOST = 4, 5  # [ticks] shortest and longest pause
TALLY = np.dtype((np.record, np.dtype([('swept', 'i8'), ('dirt', 'f8')], align=True)))
