"""What the console imports in a fresh interpreter: it starts with each demo, and computes nothing that takes long."""

import subprocess
import sys

NEEDLESS = ('PyQt5', 'matplotlib', 'numba', 'scipy', 'skimage', 'tornado')


def test_the_console_imports_neither_a_window_nor_what_compiles():
    code = 'import sys; import rumba_viewer.ros.console.console; print(*sys.modules)'
    modules = subprocess.run([sys.executable, '-c', code], stdout=subprocess.PIPE, universal_newlines=True,
                             check=True).stdout.split()
    assert 'rumba_viewer.scene.forecast' in modules
    assert not [name for name in modules if name.split('.')[0] in NEEDLESS]
