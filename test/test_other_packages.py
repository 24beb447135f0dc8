"""Python and C++ packages of others use BatteryStatus, in a workspace beside ours and over an installed one."""

import re

import pytest
from workspaces import ROOT


@pytest.mark.thorough(except_for=['beside-devel', 'beside-install'])
@pytest.mark.parametrize('space', ['devel', 'install'])
@pytest.mark.parametrize('name, publisher, reader, percentage', [
    ('workspace', '$LIB/battery_report/publish_battery', ROOT / 'test/packages/battery_python/scripts/reader', r'\d+'),
    ('overlay', '$LIB/battery_cpp/publisher', '$LIB/battery_python/reader', '42')], ids=['beside', 'overlay'])
def test_a_python_node_reads_what_a_cpp_node_publishes(request, name, publisher, reader, percentage, space):
    here = request.getfixturevalue(name).space(space)
    namespace = f'__ns:=/{name}_{space}'
    with here.running(f'{publisher} {namespace}'):
        assert re.fullmatch(fr'{percentage}, 1\.5, -2\.5, 0\.75, True, from C\+\+\n', here.run(f'{reader} {namespace}'))


def test_what_was_compiled_is_installed_and_not_compiled_again(workspace):
    kernel = 'rumba_sim/model/kernel/__pycache__'
    built = max((ROOT / 'rumba_sim' / 'src' / kernel).glob('geometry.wrap-*.1.nbc'),
                key=lambda path: path.stat().st_mtime)
    [installed] = workspace.path.glob(f'install/lib/python3*/dist-packages/{kernel}/{built.name}')
    assert int(installed.stat().st_mtime) == int(built.stat().st_mtime)


def test_a_cpp_node_for_turtlesim_compiles_although_its_package_does_not_name_turtlesim(workspace, overlay):
    here = overlay.space('devel')
    with workspace.space('devel').running('$LIB/turtlesim/turtlesim_node _gui:=false __ns:=/watched'):
        assert here.run('$LIB/turtle_watcher/watcher __ns:=/watched').endswith('5.54444\n')
