"""docs/own_node.md: its tables are those of the interfaces, and its five lines give a verdict on a node."""

import re
import shutil

import pytest
from workspaces import ROOT, clean_environment

from rumba_sim.model.settings.interfaces import AT_SCAN, INTERFACES

PAGE = (ROOT / 'docs' / 'own_node.md').read_text()
NODES = ROOT / 'rumba_sim' / 'test' / 'ros' / 'their_nodes'
LIMIT, SLOW_LIMIT = '300', '3000'  # [s] of the page, and on a busy machine, where commands come late
RATES = {'turtlebot3': 5, 'plain': 10}  # [Hz] of scans


@pytest.mark.parametrize('name', INTERFACES)
def test_the_table_of_an_interface_lists_its_topics(name):
    section = PAGE.split(f'\n### {name}\n')[1].split('\n### ')[0]
    rows = re.findall(r'^\| (`/.*|subscribes `/.*) \|$', section, re.MULTILINE)
    interface = INTERFACES[name]
    assert rows == [
        *(f'`/{topic.name}` | `{topic.type}` | '
          f'{f"of the laser: {RATES[name]}" if topic.rate == AT_SCAN else topic.rate} | '
          f'{f"`{topic.frame}`" if topic.frame else ""}'.rstrip() for topic in interface.topics),
        *(f'subscribes `/{topic}` | `{kind}` | |' for topic, kind in interface.inputs.items())]


def test_the_five_lines_give_a_verdict(workspace, tmp_path):
    lines = re.search('```sh\n(roslaunch .*?)```', PAGE, re.DOTALL).group(1)
    assert len(lines.splitlines()) == 5
    shutil.copy(NODES / 'turtlebot3_bounce', tmp_path / 'my_node.py')
    lines = lines.replace(LIMIT, SLOW_LIMIT)
    (tmp_path / 'test.sh').write_text(f'cd "{tmp_path}"\n{lines}wait\n')
    shown = workspace.space('devel', clean_environment()).run(f'bash {tmp_path}/test.sh', 900.0)
    wanted = PAGE.split('prints after ten seconds:\n\n```\n')[1].splitlines()[:3]
    pattern = '\n'.join(map(re.escape, wanted)).replace(LIMIT, SLOW_LIMIT)
    assert re.fullmatch(re.sub(r'(10\\\.1|48\\\.1)', r'[\\d.]+', pattern) + '\n', shown), shown
