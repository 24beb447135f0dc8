"""Speed of the model without ROS: ROOM20 with 1 to 1000 robots, with and without laser, in CPU time of one core.

Every robot has its battery, noisy odometry, bumper, dirt and coverage. Each tick is one call of World.step, unless the
heading says that nobody looks in between.

    ./rumba shell python3 bench/world_speed.py --against CHECKOUT

prints a table of simulated seconds against those of another checkout.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import time

from common import checkouts, figures, room20

# Robot-steps in a CPU second, by the rate of steps [Hz] and by robots; the lower bounds.
STEPS = {50: {1: 450_000, 10: 1_450_000, 100: 1_800_000}, 10: {1: 280_000, 10: 700_000, 100: 850_000}}
AT_ONCE = {1: 1_000_000, 10: 2_000_000, 100: 2_300_000}  # the same by robots, ten ticks in a call
SCANS = {1: 30_000, 10: 30_000, 100: 25_000}  # scans of 360 beams in a CPU second, by robots; the lower bounds
LASER_PERIOD = 0.1  # [s]
ROBOTS = (1, 10, 100)
WORK = 100_000  # robot-steps in a run
LONGEST = 3000.0  # [s] a run, at most: a battery lasts twice as long
TABLE_RUNS = 3  # of each row; the ratios are medians of several tables, too
NO_SLOWER = 0.97  # times another checkout, at least: so far two medians of the same code may be apart


def main():
    """Do as the command line asks."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    checkouts.add_arguments(parser)
    parser.add_argument('--table', action='store_true', help='print the figures of the table alone, as JSON')
    options = parser.parse_args()
    if options.table:
        print(json.dumps(dict(table())))
    elif options.against is not None:
        figures.heading('ROOM20, steps of 0.1 s: simulated seconds in a CPU second; beams to 8 m every 0.1 s')
        checkouts.rows(checkouts.compare(told_by, options.against, options.pairs), NO_SLOWER)
    else:
        report()


def told_by(checkout):
    """The table of a checkout, None for this one, by a process of its own."""
    arguments = [sys.executable, str(pathlib.Path(__file__).resolve()), '--table']
    told = subprocess.run(checkouts.command(checkout, arguments), check=True, stdout=subprocess.PIPE)
    return json.loads(told.stdout)


def table():
    """Rows of a table: each has a name, and the simulated seconds in a CPU second."""
    for resolution in (0.05, 0.02):
        plan = room20.room20(resolution)
        for beams in (0, 360):
            for robots in ROBOTS:
                yield (f'cells of {resolution * 100:.0f} cm, {beams:>3} beams, {robots:>3} robots',
                       measured_scanning(plan, robots, 10, TABLE_RUNS) if beams
                       else measured_steps(plan, robots, 10, runs=TABLE_RUNS) / robots / 10)


def report():
    """Measure and print."""
    begin = time.process_time()
    small = room20.populated(room20.room20(0.1), 2, 50)
    room20.drive(small, 50, LASER_PERIOD)
    figures.heading('World speed: robots on circles, 0.2 m/s and 1 rad/s; figures for one second of CPU time')
    figures.row('warm-up: code compiled, or loaded from the cache [CPU s]', time.process_time() - begin)
    plans = {resolution: room20.room20(resolution) for resolution in (0.02, 0.05)}
    for step_rate, resolution in ((50, 0.02), (50, 0.05), (10, 0.02), (10, 0.05)):
        figures.heading(f'ROOM20, cells of {resolution * 100:.0f} cm, steps of {1.0 / step_rate:g} s, no laser')
        for robots in ROBOTS:
            steps(plans[resolution], robots, step_rate)
    figures.heading('ROOM20, cells of 2 cm, steps of 0.02 s, no laser, the ten ticks between two commands in one call')
    for robots in ROBOTS:
        steps_at_once(plans[0.02], robots)
    for step_rate, resolution in ((50, 0.02), (10, 0.05)):
        figures.heading(f'ROOM20, cells of {resolution * 100:.0f} cm, steps of {1.0 / step_rate:g} s, '
                        f'360 beams to 8 m every {LASER_PERIOD:g} s')
        for robots in ROBOTS:
            lasers(plans[resolution], robots, step_rate)
    more_robots()
    larger_map(plans[0.05])


def measured_steps(plan, robots, step_rate, rooms=(1, 1), runs=5):
    """Robot-steps in a CPU second."""
    world = room20.populated(plan, robots, step_rate, rooms)
    ticks = min(WORK // robots, round(LONGEST * step_rate))
    figure = figures.per_cpu_second(lambda: room20.drive(world, ticks), ticks * robots, 0.0, runs,
                                    lambda: room20.begin(world))
    room20.check(world)
    return figure


def measured_scans(plan, robots, step_rate, rooms=(1, 1)):
    """Scans in a CPU second of robots that stand still."""
    world = room20.populated(plan, robots, step_rate, rooms)
    room20.begin(world)
    return figures.per_cpu_second(lambda: room20.scan(world), robots, 0.4)


def steps(plan, robots, step_rate):
    """Print figures without laser."""
    figure = measured_steps(plan, robots, step_rate)
    figures.row(f'{robots:>4} robots: robot-steps', figure, at_least=STEPS[step_rate][robots])
    figures.row('             simulated seconds', figure / robots / step_rate)


def steps_at_once(plan, robots):
    """Print figures of robots that nobody looks at between their commands."""
    world = room20.populated(plan, robots, 50)
    commands = WORK // robots // 10
    figure = figures.per_cpu_second(lambda: room20.drive_at_once(world, commands), commands * 10 * robots, 0.0,
                                    prepare=lambda: room20.begin(world))
    room20.check(world)
    figures.row(f'{robots:>4} robots: robot-steps', figure, at_least=AT_ONCE[robots])


def lasers(plan, robots, step_rate):
    """Print figures with laser."""
    figures.row(f'{robots:>4} robots: scans', measured_scans(plan, robots, step_rate), at_least=SCANS[robots])
    figures.row('             simulated seconds, steps and scans', measured_scanning(plan, robots, step_rate))


def measured_scanning(plan, robots, step_rate, runs=5):
    """Simulated seconds in a CPU second, with steps and scans."""
    world = room20.populated(plan, robots, step_rate)
    room20.begin(world)
    ticks = round(step_rate * max(LASER_PERIOD, 10.0 / robots))
    figure = figures.per_cpu_second(lambda: room20.drive(world, ticks, LASER_PERIOD), ticks / step_rate, 0.3, runs,
                                    prepare=lambda: room20.begin(world))
    room20.check(world)
    return figure


def more_robots():
    """Print the cost of a robot if there are ten times as many at the same density."""
    figures.heading('1000 robots at the same density: ten such rooms, 100 x 40 m; cells of 5 cm, steps of 0.02 s')
    for robots, rooms in ((100, (1, 1)), (1000, (5, 2))):
        plan = room20.room20(0.05, rooms)
        figures.row(f'{robots:>4} robots: robot-steps', measured_steps(plan, robots, 50, rooms))
        figures.row('             scans', measured_scans(plan, robots, 50, rooms))


def larger_map(plan):
    """Print the cost of the same robots in the same room on a map that is sixteen times as large."""
    figures.heading('The same 100 robots and pillars in a corner of a map of 80 x 80 m; cells of 5 cm, steps of 0.02 s')
    for title, where in (('20 x 20 m', plan), ('80 x 80 m', room20.room20(0.05, side=80.0))):
        figures.row(f'{title}: robot-steps', measured_steps(where, 100, 50))
        figures.row('           scans', measured_scans(where, 100, 50))


if __name__ == '__main__':
    main()
