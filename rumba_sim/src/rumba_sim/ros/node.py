"""What every node does alike: help, parameters, one clear line and exit code 2 for bad input, a quiet end."""

import inspect
import re
import sys
from typing import Callable, List, Type, TypeVar

import rospy

from rumba_sim.model import config
from rumba_sim.model.errors import ConfigError, RumbaError

Settings = TypeVar('Settings')
BAD_INPUT = 2


def run(name: str, settings_class: Type[Settings], main: Callable[[Settings], None]) -> None:
    """Run a node until ROS shuts down; leaves the process with exit code 2 where its input is bad.

    Args:
        name: the node's name, unless remapped.
        settings_class: frozen dataclass of the private parameters, its fields made by `config.setting`.
        main: the node itself, called once the node is registered; its module's docstring is the node's help.
    """
    arguments = rospy.myargv()[1:]
    if '-h' in arguments or '--help' in arguments:
        print(inspect.getdoc(inspect.getmodule(main)), config.describe(settings_class), sep='\n\n')
        return
    try:
        _check_command_line(arguments, config.names(settings_class))
        rospy.init_node(name)
        main(_parameters(settings_class))
    except RumbaError as error:
        _refuse(name, error)
    except rospy.ROSInterruptException:
        pass
    except rospy.ROSInitException as error:
        if not rospy.is_shutdown():
            _refuse(name, error)


def _refuse(name: str, error: Exception) -> None:
    print(f'{name}:', *str(error).split(), file=sys.stderr)
    sys.exit(BAD_INPUT)


def _check_command_line(arguments: List[str], parameters: List[str]) -> None:
    if arguments:
        raise ConfigError(f'unknown argument {arguments[0]!r}: parameters are given as _name:=value; --help lists them')
    for name in rospy.names.load_mappings(sys.argv):
        if name in parameters:
            raise ConfigError(f'{name}:= remaps a topic: for the parameter write _{name}:=')


def _parameters(settings_class: Type[Settings]) -> Settings:
    """The private parameters of this node.

    The parameter server outlives a node: what a refused command line put there is taken back, lest it spoil the next.
    """
    try:
        return config.from_mapping(settings_class, rospy.get_param('~', {}), f'parameter of {rospy.get_name()}')
    except ConfigError:
        for assignment in filter(None, (re.match(r'_([^_]\w*):=', argument) for argument in sys.argv)):
            rospy.delete_param(f'~{assignment.group(1)}')
        raise
