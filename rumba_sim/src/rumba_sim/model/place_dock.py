"""place_dock: prints a place for a dock on a map, against a wall and with room before it, as a line for its file.

A map without a dock can be cleaned with a single charge only.
"""

import sys
from typing import Sequence

from rumba_sim.model.common.command_line import BAD_INPUT, ERROR, Parser
from rumba_sim.model.common.errors import RumbaError
from rumba_sim.model.floors.dock_place import ALONG, BEHIND, place_dock
from rumba_sim.model.maps import map_file, named_maps
from rumba_sim.model.settings import robot_file
from rumba_sim.model.simulation.world import World

NAME = 'place_dock'


def command() -> None:
    """Run the command line of this process; leaves the process with the exit code."""
    sys.exit(main(sys.argv[1:]))


def main(arguments: Sequence[str]) -> int:
    """Run the command with the arguments of a command line; returns the exit code."""
    about, details = (__doc__ or '').split('\n\n')
    parser = Parser(NAME, description=about, epilog=details, allow_abbrev=False)
    parser.add_argument('map', metavar='MAP', help='name of a map of rumba_sim, or path of a map_server YAML file')
    parser.add_argument('--robot', default='', metavar='FILE',
                        help='YAML file with settings of a robot, as in config/rumba.yaml, that are to be others')
    options = parser.parse_args(arguments)
    try:
        robot = robot_file.load(options.robot)
        plan = map_file.load(named_maps.path(options.map), robot.drive.radius)
        found = place_dock(plan, robot.drive.radius, World(plan, robot).start)
    except RumbaError as error:
        print(f'{NAME}: {error}', file=sys.stderr)
        return BAD_INPUT
    if found is None:
        print(f'{NAME}: {plan.name}: no straight wall of {ALONG[-1] - ALONG[0]:g} m with {BEHIND[-1]:g} m of free '
              'floor before it', file=sys.stderr)
        return ERROR
    print(f'dock: [{found.x}, {found.y}, {found.theta}]')
    return 0
