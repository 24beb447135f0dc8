"""What hidden .test files start, and where the packages are, as roslaunch and rospkg find them; needs no master."""

import os
import sys
from typing import Any, List, Set

import roslaunch.config
import roslaunch.core
import rospkg

from rumba_evaluation.marks.hidden_tests import MISSION_TEST, HiddenTest
from rumba_evaluation.marks.submission import Launch
from rumba_evaluation.submissions.diagnosis.mistakes import Wanted
from rumba_sim.model.common.errors import ConfigError

SYSTEM = ('/usr/', '/opt/')
OURS = 'rumba_'
PLAIN = (bool, int, float, str, list, dict)  # what parameters can be, apart from data and times


def load(test: HiddenTest, tests: str) -> Launch:
    """What a test starts.

    Args:
        test: the test.
        tests: its folder, whose packages are found before all others.

    Raises:
        ConfigError: roslaunch cannot read it.
    """
    path = os.environ.get('ROS_PACKAGE_PATH', '')
    os.environ['ROS_PACKAGE_PATH'] = os.pathsep.join([os.path.abspath(tests), path])
    arguments = [f'{name}:={value}' for name, value in test.arguments.items()]
    try:
        config = roslaunch.config.load_config_default([(test.path, arguments)], None, assign_machines=False)
    except (roslaunch.core.RLException, rospkg.ResourceNotFound) as error:
        raise ConfigError(f'{test.path}: {" ".join(str(error).split())}') from error
    finally:
        trusted = _trusted(tests)
        os.environ['ROS_PACKAGE_PATH'] = path
    return Launch([Wanted(node.package, node.type) for node in config.nodes if node.package not in trusted],
                  [_name(node) for node in (*config.nodes, *config.tests) if node.package in trusted],
                  [_name(node) for node in config.tests if node.type == MISSION_TEST],
                  {name: parameter.value for name, parameter in config.params.items()
                   if isinstance(parameter.value, PLAIN)})


def _name(node: Any) -> str:
    return f'{node.namespace}{node.name}'


def visible() -> List[str]:
    """Folders that a program needs which uses Rumba and the packages of this environment."""
    packs = rospkg.RosPack()
    prefixes = [path for name in ('CMAKE_PREFIX_PATH', 'PYTHONPATH') for path in os.environ.get(name, '').split(':')]
    return [sys.prefix, sys.base_prefix, *filter(None, prefixes), *map(packs.get_path, packs.list())]


def _trusted(tests: str) -> Set[str]:
    """Packages that no submission replaces: those beside the tests, of Rumba, and of the system."""
    packs, own = rospkg.RosPack(), os.path.join(os.path.abspath(tests), '')
    return {name for name in packs.list()
            if name.startswith(OURS) or f'{packs.get_path(name)}/'.startswith((own, *SYSTEM))}
