"""What the README promises is what runs."""

import contextlib
import functools
import re
import shlex
import time

import catkin_pkg.packages
import pytest
from workspaces import OURS, ROOT, TIMEOUT, Space, clean_environment, roscore

README = (ROOT / 'README.md').read_text()
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
UNKNOWN = 'unknown type'
OF_RECONFIGURE = re.compile(r'/tuning/|_logger')  # what dynamic_reconfigure and every node bring of their own
COMMANDS = {
    # At a speed other than 1, so that /clock is there too.
    'simulator': 'rosrun rumba_sim simulator _speed:=2 _map:=studio',
    # Asked for all of its conditions, the first of which nobody meets.
    'mission_test': 'rosrun rumba_evaluation mission_test _coverage:=1 _reach:="9 9" _docked:=true _collisions:=0 '
                    '_battery:=1 _time_limit:=100000 _patience:=100000',
    'cleaner': 'rosrun rumba_cleaning cleaner _team:="rumba rumba2" _laser:=true',
    # teleop_key wants a terminal.
    'teleop_key': 'script -qec "rosrun rumba_sim teleop_key __ns:=/readme" /dev/null',
    'turtlesim': 'rosrun turtlesim turtlesim_node _gui:=false',
    'viewer': 'env QT_QPA_PLATFORM=offscreen rosrun rumba_viewer viewer _laser:=true',
}
# Two simulators need two masters; beside each run the nodes that publish what it subscribes to. mission_test ends if
# another node publishes what the simulator does.
INTRUDERS = ['turtlesim_body', 'battery_status_publisher']
BESIDE = [[node for node in NODES if node not in INTRUDERS], INTRUDERS + ['turtlesim', 'teleop_key', 'cleaner']]


@pytest.fixture(scope='module')
def running(workspace):
    """For each node of the README the devel space of a workspace in which it runs, in the namespace /readme."""
    found = {}
    with contextlib.ExitStack() as stack:
        for nodes in BESIDE:
            environment = clean_environment()
            stack.enter_context(roscore(environment))
            here = Space(f'. {workspace.setup("devel")};', environment)
            for node in nodes:
                command = COMMANDS.get(node) or f'rosrun {PACKAGES[node]} {node}'
                stack.enter_context(here.running(command if '__ns' in command else f'{command} __ns:=/readme'))
            deadline = time.monotonic() + TIMEOUT
            while not {f'/readme/{node}' for node in nodes} <= set(here.run('rosnode list').split()):
                assert time.monotonic() < deadline, here.run('rosnode list')
            here.run('rostopic echo -n1 /readme/rumba/cleaning_status')  # the simulator is through with its start
            # The viewer looks for robots once a second; the actions are the last that it reaches for.
            while 'viewer' in nodes and '/readme/viewer' not in here.run('rostopic info /readme/rumba/go_to/goal'):
                assert time.monotonic() < deadline, 'the viewer finds no robot'
            if 'simulator' in nodes:  # what a node does can be seen while time stands still, which costs nothing
                assert 'success: True' in here.run('rosservice call /readme/simulator/pause')
            found.update({node: here for node in nodes if node not in found})
        yield found


@functools.lru_cache(maxsize=None)
def info(space, node):
    """The topics of a node in /readme, and the types of its services by their names."""
    text = space.run(f'rosnode info /readme/{node}')
    kinds = dict(re.findall(r'^ \* (/\S+) \[(.+)\]$', text, re.MULTILINE))
    # The type of a topic without a publisher is unknown there.
    kinds.update(types(space, 'rostopic.get_topic_type({})[0]', [name for name in kinds if kinds[name] == UNKNOWN]))
    services = [name for name in re.findall(r'^ \* (/\S+)$', text, re.MULTILINE) if not OF_RECONFIGURE.search(name)]
    return ({f'{topic} [{kind}]' for topic, kind in kinds.items() if not OF_RECONFIGURE.search(topic)},
            types(space, 'rosservice.get_service_type({})', services))


def types(space, question, names):
    """The answers that the Python interface of a tool of ROS gives for names; a process for each takes longer."""
    code = f'import sys, rosservice, rostopic; print(*({question.format("name")} for name in sys.argv[1:]))'
    return dict(zip(names, space.run(f'python3 -c {shlex.quote(code)} {" ".join(names)}').split())) if names else {}


def resolved(name):
    """A name of the tables as it is in the namespace /readme."""
    return name if name.startswith('/') else f'/readme/{name}'


@pytest.mark.parametrize('node', NODES)
def test_the_table_of_topics_is_what_the_node_does(running, node):
    promised = {f'{resolved(topic)} [{kind}]' for name, topic, kind, *_ in TOPICS if name == node}
    for name, action, kind, *_ in ACTIONS:
        if name == node:
            promised |= {f'{resolved(action)}/{part} [{form.format(kind)}]' for part, form in OF_ACTION.items()}
    assert info(running[node], node)[0] - (EVERY_NODE_HAS - promised) == promised


@pytest.mark.parametrize('node', NODES)
def test_the_table_of_services_is_what_the_node_serves(running, node):
    promised = {resolved(service): kind for name, service, kind, *_ in SERVICES if name == node}
    assert info(running[node], node)[1] == promised


def test_every_installed_program_is_named_with_its_package():
    assert sorted(re.findall(r'^\| `(\w+)` \|', README, re.MULTILINE)) == NODES
    others = re.findall(r'`rosrun (rumba_\w+) (\w+)`', README)
    assert {name: package for package, name in others if name not in NODES} == {
        name: package for name, package in PACKAGES.items() if name not in NODES}
    assert set(NODES) <= set(PACKAGES)


def test_what_echo_prints_in_the_readme_is_what_it_prints(workspace):
    here = workspace.space('devel')
    shown = re.search(r'-n1 /rumba/battery_status\n(percentage_battery.*?---\n)', README, re.DOTALL).group(1)
    with here.running('rosrun rumba_sim battery_status_publisher _percentage:=97 _drain:=0'):
        assert here.run('rostopic echo -n1 /rumba/battery_status') == shown


def test_a_clone_in_another_workspace_brings_the_packages_and_no_lesson_and_no_test():
    assert sorted(catkin_pkg.packages.find_package_paths(str(ROOT))) == sorted(
        str(path.relative_to(ROOT)) for path in OURS)
    assert [path.name for path in OURS] == [
        'rumba_bringup', 'rumba_cleaning', 'rumba_evaluation', 'rumba_localisation', 'rumba_msg', 'rumba_sim',
        'rumba_viewer']
