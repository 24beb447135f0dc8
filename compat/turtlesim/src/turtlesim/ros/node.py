"""What all nodes of this package share: help, parameters, one line and exit code 2 for bad input, a clean end.

This module, `pace`, `prompt_end` and `requests` resemble modules of rumba_sim. They are repeated because this package
takes the place of one that a distribution ships: it must build and run in a workspace without any other package of
Rumba.
"""

import inspect
import io
import logging
import re
import reprlib
import signal
import sys
import threading
import time
import xmlrpc.client
from typing import Any, Callable, Dict, List, NamedTuple, Tuple
from xml.parsers.expat import ExpatError

import rosgraph
import rospy
import yaml

from turtlesim.model.errors import TurtlesimError
from turtlesim.ros import prompt_end

BAD_INPUT = 2
LOOK_PERIOD = 0.5  # [s] between two looks for a master


class Parameter(NamedTuple):
    """A private parameter: its default, a test for good values, these values in words, and its meaning."""

    default: Any
    is_good: Callable[[Any], bool]
    range: str
    meaning: str


Parameters = Dict[str, Parameter]


def number(default: float, low: float, high: float, meaning: str) -> Parameter:
    """Return a parameter that is a number from `low` to `high`, both included."""
    return Parameter(default, lambda value: type(value) in (int, float) and low <= value <= high,
                     f'{low:g} to {high:g}', meaning)


def read(parameters: Parameters, *names: str, prefix: str = '~') -> List[Any]:
    """Return the present values of parameters, private ones unless the prefix is empty.

    Raises:
        TurtlesimError: a value is of the wrong type or out of range.
    """
    values = []
    for name in names:
        value = rospy.get_param(f'{prefix}{name}', parameters[name].default)
        if not parameters[name].is_good(value):
            raise TurtlesimError(f'parameter {rospy.resolve_name(f"{prefix}{name}")} is {reprlib.repr(value)}: '
                                 f'must be {parameters[name].range}')
        values.append(value)
    return values


def run(name: str, parameters: Parameters, main: Callable[[], None], own_clock: bool = False) -> None:
    """Run a node until ROS shuts down; end the process with exit code 2 if its input is bad.

    Args:
        name: name of the node, if it is not remapped.
        parameters: the private parameters by name.
        main: called once the node is registered; the docstring of its module is the help of the node.
        own_clock: whether the node ignores /clock.
    """
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(line_buffering=True)  # else log lines stay in the buffer of a pipe
    arguments = rospy.myargv()[1:]
    if '-h' in arguments or '--help' in arguments:
        print(inspect.getdoc(inspect.getmodule(main)), *map(_describe, parameters.items()), sep='\n')
        return
    try:
        _check_command_line(arguments, parameters)
        _wait_for_master(name)
        _register(name, own_clock)
        for ending in (signal.SIGINT, signal.SIGTERM):
            signal.signal(ending, _shut_down)
        try:
            read(parameters, *parameters)
            main()
        except TurtlesimError:
            _take_parameters_back()
            raise
    except TurtlesimError as error:
        print(f'{name}: {error}', file=sys.stderr)
        sys.exit(BAD_INPUT)
    except rospy.ROSInterruptException:
        pass
    except Exception:
        if not rospy.core.is_shutdown_requested():  # during a shutdown, publishing fails
            raise


def _wait_for_master(name: str) -> None:
    """Wait for a master; rospy itself waits too, but fails if the command line sets a parameter."""
    before = signal.signal(signal.SIGINT, signal.SIG_DFL)  # rosgraph takes a KeyboardInterrupt for a no
    if not rosgraph.is_master_online():
        print(f'{name}: no roscore answers at {rosgraph.get_master_uri()} yet: waiting for it', file=sys.stderr,
              flush=True)
        while not rosgraph.is_master_online():
            time.sleep(LOOK_PERIOD)
    signal.signal(signal.SIGINT, before)


def _register(name: str, own_clock: bool) -> None:
    _log_trouble_once(name)
    prompt_end.use()
    try:
        rospy.init_node(name, disable_rostime=own_clock)
    except OSError as error:  # of the log file that the argument __log names
        raise TurtlesimError(f'cannot start: {error}') from None


def _log_trouble_once(name: str) -> None:
    """Print one line if a log file cannot be written, instead of a traceback for each message."""
    told: List[Any] = []

    def tell(handler: Any, record: Any) -> None:
        if not told:
            told.append(record)
            error = TurtlesimError(f'cannot write the log: {sys.exc_info()[1]}')
            print(f'{name}: {error}; the node goes on without it', file=sys.stderr, flush=True)
    setattr(logging.Handler, 'handleError', tell)


def _describe(item: Any) -> str:
    name, parameter = item
    return f'  {name:<13} {parameter.meaning}: {parameter.range}; default {parameter.default}'


def _shut_down(ending: int, _: Any) -> None:
    """End ROS in a thread.

    The handler of rospy runs in the main thread, and waits forever if it interrupts code that holds a lock of rospy,
    such as the code that publishes.
    """
    threading.Thread(target=rospy.signal_shutdown, args=[f'signal {ending}']).start()


def _check_command_line(arguments: List[str], parameters: Parameters) -> None:
    known = f'known are {", ".join(f"_{name}:=" for name in parameters) or "none"}'
    if arguments:
        raise TurtlesimError(f'unknown argument {arguments[0]!r}: {known}; --help describes them')
    for name in rospy.names.load_mappings(sys.argv):
        if name in parameters:
            raise TurtlesimError(f'{name}:= remaps a topic: for the parameter write _{name}:=')
    for name, text in _assigned():
        if name not in parameters:
            raise TurtlesimError(f'unknown parameter _{name}: {known}')
        _check_value(name, text)


def _check_value(name: str, text: str) -> None:
    """Check that the parameter server can take a value, which rospy reads as YAML."""
    try:
        xmlrpc.client.loads(xmlrpc.client.dumps((yaml.safe_load(text),)))
    except (yaml.YAMLError, ValueError, TypeError, OverflowError, RecursionError, ExpatError) as error:
        reason = ' '.join(str(error).split())
        raise TurtlesimError(f'_{name}:={reprlib.repr(text)} cannot be a parameter: {reason}') from None


def _assigned() -> List[Tuple[str, str]]:
    """Return the names and the values of the private parameters on the command line."""
    found = (re.match(r'_([^_].*?):=(.*)', argument, re.DOTALL) for argument in sys.argv)
    return [(assignment.group(1), assignment.group(2)) for assignment in found if assignment]


def _take_parameters_back() -> None:
    """Delete the parameters of a refused command line: on the parameter server they would outlive this node."""
    for name, _ in _assigned():
        if rospy.has_param(f'~{name}'):
            rospy.delete_param(f'~{name}')
