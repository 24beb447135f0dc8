"""A stranger's Python and C++ packages use BatteryStatus, in a workspace beside ours and over an installed one."""

import pytest
from workspaces import ROOT


@pytest.mark.parametrize('space', ['devel', 'install'])
@pytest.mark.parametrize('name', ['beside', 'overlay'])
def test_a_python_node_reads_what_a_cpp_node_publishes(request, name, space):
    stranger = request.getfixturevalue(name).space(space)
    namespace = f'__ns:=/{name}_{space}'
    with stranger.running(f'rosrun battery_cpp publisher {namespace}'):
        assert stranger.run(f'rosrun battery_python reader {namespace}') == '42, 1.5, -2.5, 0.75, True, from C++\n'


def test_what_was_compiled_is_installed_and_not_compiled_again(workspace):
    kernel = 'rumba_sim/model/kernel/__pycache__'
    built = max((ROOT / 'rumba_sim' / 'src' / kernel).glob('geometry.wrap-*.1.nbc'),
                key=lambda path: path.stat().st_mtime)
    [installed] = workspace.path.glob(f'install/lib/python3*/dist-packages/{kernel}/{built.name}')
    assert int(installed.stat().st_mtime) == int(built.stat().st_mtime)
