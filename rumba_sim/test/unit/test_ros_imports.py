"""What a node imports in a fresh interpreter: no more than it needs, since importing is most of what a start takes."""

import subprocess
import sys

import pytest

TOO_LARGE = ('PyQt5', 'matplotlib', 'skimage', 'tqdm', 'dask', 'distributed', 'pandas')
SLOW = ('numba', 'scipy', 'PIL')  # only where there is a world
NODES = ('simulator.simulator', 'turtlesim_body.turtlesim_body', 'teleop_key.teleop_key', 'battery_status_publisher',
         'battery_status_listener')


@pytest.mark.parametrize('node', NODES)
def test_a_node_imports_neither_a_window_nor_what_evaluation_needs(node):
    code = f'import sys; import rumba_sim.ros.{node}; print(*sys.modules)'
    modules = subprocess.run([sys.executable, '-c', code], stdout=subprocess.PIPE, universal_newlines=True,
                             check=True).stdout.split()
    assert f'rumba_sim.ros.{node}' in modules
    unwanted = TOO_LARGE if node.startswith(('simulator', 'turtlesim')) else TOO_LARGE + SLOW
    assert not [name for name in modules if name.split('.')[0] in unwanted]
