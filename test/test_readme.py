"""What the README promises is what runs."""

import re

import catkin_pkg.packages
import pytest
from workspaces import ROOT

README = (ROOT / 'README.md').read_text()
TABLE = [re.findall(r'`([^`]+)`', row) for row in README.splitlines()
         if re.match(r'\| `\w+` \| (publishes|subscribes) ', row)]
NODES = sorted({row[0] for row in TABLE})
EVERY_NODE_HAS = {'/rosout [rosgraph_msgs/Log]'}


@pytest.mark.parametrize('node', NODES)
def test_the_table_of_topics_is_what_the_node_does(workspace, node):
    here = workspace.space('devel')
    promised = {f'/readme/{topic} [{message}]' for name, topic, message, *_ in TABLE if name == node}
    with here.running('rosrun rumba_sim battery_status_publisher __ns:=/readme'), \
            here.running('rosrun rumba_sim battery_status_listener __ns:=/readme') as listener:
        assert any(line.startswith('battery 100 %') for line in listener.stdout)
        info = here.run(f'rosnode info /readme/{node}')
    topics = set(re.findall(r'^ \* (/\S+ \[\S+\])$', info, re.MULTILINE))
    assert topics - EVERY_NODE_HAS == promised


def test_every_installed_node_is_in_the_table():
    assert NODES == sorted(path.name for path in (ROOT / 'rumba_sim' / 'scripts').iterdir())


def test_what_echo_prints_in_the_readme_is_what_it_prints(workspace):
    here = workspace.space('devel')
    shown = re.search(r'-n1 /rumba/battery_status\n(percentage_battery.*?---\n)', README, re.DOTALL).group(1)
    with here.running('rosrun rumba_sim battery_status_publisher _percentage:=97 _drain:=0'):
        assert here.run('rostopic echo -n1 /rumba/battery_status') == shown


def test_the_live_line_in_the_readme_is_what_the_listener_prints(workspace):
    here = workspace.space('devel')
    shown = re.search(r'^battery .*$', README, re.MULTILINE).group(0)
    with here.running('rosrun rumba_sim battery_status_publisher __ns:=/live _percentage:=97 _drain:=0'), \
            here.running('rosrun rumba_sim battery_status_listener __ns:=/live') as listener:
        listener.stdout.readline()
        assert listener.stdout.readline() == shown + '\n'


def test_a_clone_in_another_workspace_brings_the_packages_and_nothing_of_its_own_workspace_and_tests():
    assert sorted(catkin_pkg.packages.find_package_paths(str(ROOT))) == ['rumba_msg', 'rumba_sim']
