"""inspect_map: tells in ten lines and a picture what a map holds for a robot, and what to add to its file.

It says which floor the robot reaches and from where, which parts are closed to it and why, with the narrowest gap, and
how long a mission will take with how many charges. The picture needs matplotlib.
"""

import pathlib
import sys
from typing import Callable, Sequence

from rumba_evaluation.inspection.findings import inspected
from rumba_evaluation.inspection.lines import lines
from rumba_sim.model.common.command_line import BAD_INPUT, ERROR, Parser
from rumba_sim.model.common.errors import ConfigError, RumbaError
from rumba_sim.model.maps import named_maps
from rumba_sim.model.settings import robot_file

NAME = 'inspect_map'


def command() -> None:
    """Run the command line of this process, without ROS; leaves the process with the exit code."""
    sys.exit(main(sys.argv[1:]))


def main(arguments: Sequence[str], map_path: Callable[[str], str] = named_maps.path) -> int:
    """Run the command with the arguments of a command line; returns the exit code.

    Args:
        arguments: without the name of the program.
        map_path: finds the path of a map by its name, or raises MapError.
    """
    about, details = (__doc__ or '').split('\n\n')
    parser = Parser(NAME, description=about, epilog=details, allow_abbrev=False)
    add = parser.add_argument
    add('map', metavar='MAP', help='name of a map of rumba_sim, or path of a map_server YAML file')
    add('--robot', default='', metavar='FILE',
        help='YAML file with settings of a robot, as in config/rumba.yaml of rumba_sim, that are to be others')
    add('--output', default='', metavar='FILE', help='for the picture, PNG; default ./inspect_MAP.png')
    add('--no-picture', action='store_true', help='draw none; without this option matplotlib is needed')
    options = parser.parse_args(arguments)
    try:
        path = map_path(options.map)
        picture = '' if options.no_picture else options.output or f'inspect_{pathlib.Path(path).stem}.png'
        if picture:
            _check_matplotlib()
        found = inspected(path, robot_file.load(options.robot))
        print('\n'.join(lines(found)))
        if picture:
            from rumba_evaluation.inspection.picture import draw  # here, because matplotlib is optional
            draw(found, picture)
            print(f'{"picture":9} {picture}')
    except RumbaError as error:
        print(f'{NAME}:', *str(error).split(), file=sys.stderr)
        return BAD_INPUT
    except (OSError, ValueError) as error:  # the picture cannot be written there, or in that format
        print(f'{NAME}: {error}', file=sys.stderr)
        return ERROR
    return 0


def _check_matplotlib() -> None:
    """Fail before the work, not after it."""
    try:
        import matplotlib  # noqa: F401
    except ImportError as error:
        raise ConfigError(f'the picture needs matplotlib ({error}): install the package python3-matplotlib (with pip: '
                          'matplotlib), or give --no-picture') from error
