"""What all nodes have in common: help, parameters, one clear line and exit code 2 for bad input, a quiet end."""

import contextlib
import inspect
import io
import logging
import os
import re
import signal
import sys
import threading
import time
import traceback
import xmlrpc.client
from typing import Any, Callable, Iterator, List, Mapping, Match, Optional, Sequence, Type, TypeVar
from xml.parsers.expat import ExpatError

import rosgraph
import rospy
import yaml

from rumba_sim.model.common import config, yaml_file
from rumba_sim.model.common.errors import ConfigError, RumbaError, WorldError, one_line, quoted
from rumba_sim.ros.running import shared_reception
from rumba_sim.ros.common.paths import absolute
from rumba_sim.ros.running import (
    clock, launched, master_watch, peers, prompt_accept, prompt_connection, prompt_end, publisher_updates)

Settings = TypeVar('Settings')
OWN_ERROR, BAD_INPUT = 1, 2  # exit codes
PATIENCE = 10.0  # [s] of the wall clock to wait for another node that starts at the same time
LOOK_PERIOD = 0.5  # [s] between two looks for a master


def run(name: str, settings_class: Type[Settings], main: Callable[[Settings], None], own_clock: bool = False,
        own_parameters: Sequence[str] = (), is_single: bool = False, arguments_of_others: Sequence[str] = (),
        on_refusal: Callable[[str], Any] = lambda _: None, before: Callable[[], None] = lambda: None) -> None:
    """Run a node until ROS shuts down; ends the process with exit code 2 if the input is bad.

    Args:
        name: the node's name, unless it is remapped.
        settings_class: frozen dataclass of the private parameters, with fields made by `config.setting`.
        main: the node itself, called after the node is registered; the docstring of its module is the node's help.
        own_clock: whether the node is the source of time, so that it does not listen to /clock.
        own_parameters: private parameters that the node itself sets; those of an earlier run are deleted.
        is_single: whether to refuse to start while a node of the same name is alive; rospy would end that node.
        arguments_of_others: prefixes of arguments that this function ignores, such as those that rostest adds.
        on_refusal: called with the message if the input is bad.
        before: called before the node waits for a master, which has no time limit.
    """
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(line_buffering=True)  # otherwise log lines stay in the buffer of a pipe until it is full
    arguments = [argument for argument in rospy.myargv()[1:] if not argument.startswith(tuple(arguments_of_others))]
    if '-h' in arguments or '--help' in arguments:
        _show(f'{inspect.getdoc(inspect.getmodule(main))}\n\n{config.describe(settings_class)}\n')
        return
    if '--config' in arguments:
        _show(yaml_file.document(settings_class()))
        return
    try:
        _check_command_line(arguments, config.names(settings_class))
        before()
        _wait_for_master(f'{name}: no roscore answers at {rosgraph.get_master_uri()} yet: waiting for it')
        _register(name, own_clock, is_single)
        try:
            main(_parameters(settings_class, own_parameters))
        except RumbaError:
            _take_parameters_back()
            raise
    except RumbaError as error:
        _refuse(name, error, on_refusal)
    except rospy.ROSInterruptException:
        pass
    except rospy.ROSInitException as error:
        if not rospy.is_shutdown():
            _refuse(name, error, on_refusal)
    except Exception:
        if not rospy.core.is_shutdown_requested():  # otherwise a topic was closed while the main thread published
            rospy.logfatal(f'{name} ends because of an error of its own:\n{traceback.format_exc()}')
            sys.exit(OWN_ERROR)


def _show(text: str) -> None:
    """Print a text for somebody who may read only its beginning, as `| head` does."""
    try:
        print(text, end='', flush=True)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # or Python would try again at its end


def _register(name: str, own_clock: bool, is_single: bool) -> None:
    """Register the node; a single one only if no other of its name lives, or is about to register too."""
    full_name = rosgraph.names.ns_join(rospy.get_namespace(), rospy.names.get_mappings().get('__name', name))
    _log_trouble_once(name)
    with contextlib.ExitStack() as until_registered:
        if is_single:
            reservation = peers.Reservation(full_name)
            until_registered.callback(reservation.release)
            if not reservation.take():
                raise WorldError(f'another node {full_name} starts at the same moment: only one of them can')
            peers.refuse_twin(full_name)
        clock.guard()
        prompt_accept.use()
        publisher_updates.use()
        prompt_connection.use()
        shared_reception.use()
        prompt_end.use()
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, _shut_down)
        try:
            rospy.init_node(name, disable_rostime=own_clock, disable_signals=True)
        except OSError as error:  # of the log file that the argument __log names
            raise ConfigError(f'cannot start: {error}') from None
    master_watch.start()


def _log_trouble_once(name: str) -> None:
    """Print one line if a log file cannot be written, instead of a traceback for each message."""
    told: List[Any] = []

    def tell(handler: Any, record: Any) -> None:
        if not told:
            told.append(record)
            reason = one_line(str(sys.exc_info()[1]))
            print(f'{name}: cannot write the log {getattr(handler, "baseFilename", "")}: {reason}; the node goes on '
                  'without it', file=sys.stderr, flush=True)
    setattr(logging.Handler, 'handleError', tell)


def _wait_for_master(line: str) -> None:
    """Wait for a master, and say so if there is none yet.

    rospy waits too, but it fails if the command line sets a parameter.
    """
    with prompt_sigint():
        if not rosgraph.is_master_online():
            print(line, file=sys.stderr, flush=True)
            look_for_master()


@contextlib.contextmanager
def prompt_sigint() -> Iterator[None]:
    """Have SIGINT end the process at once: rosgraph, which asks for the master, takes a KeyboardInterrupt for a no."""
    before = signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def look_for_master() -> None:
    """Return as soon as a master answers."""
    while not rosgraph.is_master_online():
        time.sleep(LOOK_PERIOD)


def _shut_down(number: int, _: Any) -> None:
    """End ROS in a separate thread.

    rospy's own handler interrupts the main thread, and waits forever for a lock that the main thread holds, for example
    because it is publishing.
    """
    threading.Thread(target=rospy.signal_shutdown, args=[f'signal {number}']).start()


def _refuse(name: str, error: Exception, on_refusal: Callable[[str], Any]) -> None:
    message = one_line(' '.join(str(error).split()))
    print(f'{name}: {message}', file=sys.stderr)
    on_refusal(message)
    sys.exit(BAD_INPUT)


def _check_command_line(arguments: List[str], parameters: List[str]) -> None:
    if arguments:
        raise ConfigError(f'unknown argument {arguments[0]!r}: parameters are given as _name:=value; --help lists them')
    for name in rospy.names.load_mappings(sys.argv):
        if name in parameters:
            raise ConfigError(f'{name}:= remaps a topic: for the parameter write _{name}:=')
    for argument in sys.argv[1:]:
        if re.match(r'_(?!_).+:=', argument):
            _check_value(*argument.split(':=', 1))


def _check_value(name: str, text: str) -> None:
    """Check that the parameter server can take a value, which rospy reads as YAML."""
    try:
        xmlrpc.client.loads(xmlrpc.client.dumps((yaml.safe_load(text),)))
    except (yaml.YAMLError, ValueError, TypeError, OverflowError, RecursionError, ExpatError) as error:
        raise ConfigError(f'{name}:={quoted(text)}: cannot be a parameter: {error}') from None


def _parameters(settings_class: Type[Settings], own: Sequence[str]) -> Settings:
    """The private parameters of this node, which override those of the file that its parameter `config` names."""
    for name in own:
        if rospy.has_param(f'~{name}'):
            rospy.delete_param(f'~{name}')
    where = f'parameter of {rospy.get_name()}'
    parameters = launched.below(rospy.get_name()) if launched.is_fixed() else rospy.get_param('~', {})
    _tell_of_parameters_from_before(parameters)
    if not isinstance(parameters, Mapping):
        raise ConfigError(f'parameter {rospy.get_name()} is {quoted(parameters)}: must be a mapping of '
                          + ', '.join(config.names(settings_class)))
    settings = settings_class()
    if 'config' in config.names(settings_class) and 'config' in parameters:
        path = getattr(config.updated(settings, {'config': parameters['config']}, where), 'config')
        if path:
            path = absolute(path)
            settings = config.updated(settings, yaml_file.read_mapping(path, ConfigError), path)
    return config.updated(settings, parameters, where)


def _tell_of_parameters_from_before(parameters: Any) -> None:
    """Name the parameters that rule this node although neither its command line nor a launch file gives them.

    The master keeps what an earlier command line gave, which its user may have forgotten.
    """
    if not isinstance(parameters, Mapping) or launched.is_fixed() or _is_launched():
        return
    given = {assignment.group(1).partition('/')[0] for assignment in map(_assignment, sys.argv) if assignment}
    # What was deleted leaves an empty mapping behind.
    before = {name: value for name, value in sorted(parameters.items()) if name not in given and value != {}}
    if before:
        shown = ', '.join(f'{name}: {quoted(value)}' for name, value in before.items())
        rospy.loginfo(one_line('the master keeps parameters of an earlier start, which hold for this one too: '
                               f'{shown}; `rosparam delete {rospy.get_name()}` forgets them'))


def _is_launched() -> bool:
    """Whether roslaunch has started this node: it sets the parameters before."""
    return any(argument.startswith('__log:=') for argument in sys.argv)


def _assignment(argument: str) -> Optional[Match[str]]:
    """What sets a parameter on the command line, with its name; None for other arguments."""
    return re.match(r'_([^_]\w*(?:/\w+)*):=', argument)


def _take_parameters_back() -> None:
    """Delete the parameters that a refused command line has set: otherwise the next start would be refused too."""
    for assignment in filter(None, map(_assignment, sys.argv)):
        if rospy.has_param(f'~{assignment.group(1)}'):
            rospy.delete_param(f'~{assignment.group(1)}')
