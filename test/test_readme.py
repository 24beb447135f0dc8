"""The README and the tables of the pages agree with the running nodes."""

import contextlib
import re
import time

import catkin_pkg.packages
import pytest
import rosgraph
import rosservice
from workspaces import OURS, ROOT, TIMEOUT, clean_environment, master

README = (ROOT / 'README.md').read_text()
PROGRAMS = (ROOT / 'docs' / 'programs.md').read_text()
INTERFACES = (ROOT / 'docs' / 'interfaces.md').read_text()
TOPICS = [re.findall(r'`([^`]+)`', row) for row in INTERFACES.splitlines()
          if re.match(r'\| `\w+` \| (publishes|subscribes) ', row)]
ACTIONS = [re.findall(r'`([^`]+)`', row) for row in INTERFACES.splitlines()
           if re.match(r'\| `\w+` \| (serves|uses) action ', row)]
SERVICES = [re.findall(r'`([^`]+)`', row) for row in INTERFACES.splitlines() if re.match(r'\| `\w+` \| serves `', row)]
NODES = sorted({row[0] for row in TOPICS})
PACKAGES = {path.name: package.name for package in OURS for path in package.glob('scripts/*')}
EVERY_NODE_HAS = {'/rosout [rosgraph_msgs/Log]', '/clock [rosgraph_msgs/Clock]'}  # the latter in simulated time
OF_ACTION = {'goal': '{}Goal', 'cancel': 'actionlib_msgs/GoalID', 'status': 'actionlib_msgs/GoalStatusArray',
             'feedback': '{}Feedback', 'result': '{}Result'}
OF_RECONFIGURE = re.compile(r'/tuning/|_logger')  # what dynamic_reconfigure and every node bring of their own
COMMANDS = {
    # At a speed other than 1, so that /clock is there too.
    'simulator': '$LIB/rumba_sim/simulator _speed:=2 _map:=studio',
    # Asked for all of its conditions, the first of which nobody meets.
    'mission_test': '$LIB/rumba_evaluation/mission_test _coverage:=1 _reach:="9 9" _docked:=true _collisions:=0 '
                    '_battery:=1 _time_limit:=100000 _patience:=100000',
    'cleaner': '$LIB/rumba_cleaning/cleaner _team:="rumba rumba2" _laser:=true',
    # teleop_key wants a terminal.
    'teleop_key': 'script -qec "$LIB/rumba_sim/teleop_key __ns:=/readme" /dev/null',
    'turtlesim': '$LIB/turtlesim/turtlesim_node _gui:=false',
    'viewer': 'env QT_QPA_PLATFORM=offscreen $LIB/rumba_viewer/viewer _laser:=true',
}
# Two simulators need two masters; beside each run the nodes that publish what it subscribes to. mission_test ends if
# another node publishes what the simulator does.
INTRUDERS = ['turtlesim_body', 'battery_status_publisher']
BESIDE = [[node for node in NODES if node not in INTRUDERS], INTRUDERS + ['turtlesim', 'teleop_key', 'cleaner']]


def resolved(name):
    """A name of the tables as it is in the namespace /readme."""
    return name if name.startswith('/') else f'/readme/{name}'


def promised_topics(node):
    """The topics of a node in the tables, with those of its actions, and their types."""
    promised = {f'{resolved(topic)} [{kind}]' for name, topic, kind, *_ in TOPICS if name == node}
    for name, action, kind, *_ in ACTIONS:
        if name == node:
            promised |= {f'{resolved(action)}/{part} [{form.format(kind)}]' for part, form in OF_ACTION.items()}
    return promised


def promised_services(node):
    """The services of a node in the tables, with their types."""
    return {f'{resolved(service)} [{kind}]' for name, service, kind, *_ in SERVICES if name == node}


def names(api, node):
    """The topics and the services of a node in /readme that the master knows."""
    publishers, subscribers, services = ({name for name, nodes in kind if f'/readme/{node}' in nodes
                                          and not OF_RECONFIGURE.search(name)} for kind in api.getSystemState())
    return publishers | subscribers, services


def topics_and_services(api, node):
    """The topics and the services of a node, with their types, once it has all that the tables promise, if it will."""
    wanted = [{each.split()[0] for each in promised} for promised in (promised_topics(node), promised_services(node))]
    deadline = time.monotonic() + TIMEOUT
    while not all(map(set.issubset, wanted, names(api, node))) and time.monotonic() < deadline:
        time.sleep(0.1)
    topics, services = names(api, node)
    kinds = dict(api.getTopicTypes())
    kinds.update({service: rosservice.get_service_headers(service, api.lookupService(service))['type']
                  for service in services})
    return [{f'{name} [{kinds[name]}]' for name in each} for each in (topics, services)]


@pytest.fixture(scope='module', params=['workspace', pytest.param('lesson', marks=pytest.mark.thorough)])
def told(request):
    """For each node of the README: what topics and services it has in the namespace /readme.

    In our workspace, and by rosrun in that of a learner, with a rumba_msg of its own, over ours.
    """
    found = {}
    for nodes in BESIDE:
        environment = clean_environment()
        here = request.getfixturevalue(request.param).space('devel', environment)
        with contextlib.ExitStack() as stack:
            stack.enter_context(master(environment))
            for node in nodes:
                command = COMMANDS.get(node) or f'$LIB/{PACKAGES[node]}/{node}'
                if request.param == 'lesson':
                    command = re.sub(r'\$LIB/(\w+)/', r'rosrun \1 ', command)
                stack.enter_context(here.running(command if '__ns' in command else f'{command} __ns:=/readme'))
            api = rosgraph.Master('/test', environment['ROS_MASTER_URI'])
            found.update({node: topics_and_services(api, node) for node in nodes if node not in found})
    return found


@pytest.mark.parametrize('node', NODES)
def test_the_table_of_topics_is_what_the_node_does(told, node):
    topics, _ = told[node]
    promised = promised_topics(node)
    assert topics - (EVERY_NODE_HAS - promised) == promised


@pytest.mark.parametrize('node', NODES)
def test_the_table_of_services_is_what_the_node_serves(told, node):
    _, services = told[node]
    assert services == promised_services(node)


def test_every_installed_program_is_named_with_its_package():
    assert sorted(re.findall(r'^\| `(\w+)` \|', PROGRAMS, re.MULTILINE)) == NODES
    others = re.findall(r'`rosrun (rumba_\w+) (\w+)`', PROGRAMS)
    assert {name: package for package, name in others if name not in NODES} == {
        name: package for name, package in PACKAGES.items() if name not in NODES}
    assert set(NODES) <= set(PACKAGES)


def test_a_clone_in_another_workspace_brings_the_packages_and_no_lesson_and_no_test():
    assert sorted(catkin_pkg.packages.find_package_paths(str(ROOT))) == sorted(
        str(path.relative_to(ROOT)) for path in OURS)
    assert [path.name for path in OURS] == [
        'rumba_cleaning', 'rumba_evaluation', 'rumba_launch', 'rumba_localisation', 'rumba_msg', 'rumba_sim',
        'rumba_viewer']
