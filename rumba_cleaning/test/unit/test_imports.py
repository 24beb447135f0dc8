"""What the cleaner imports in a fresh interpreter: no more than it needs until it plans."""

import subprocess
import sys

LATER = ('PyQt5', 'matplotlib', 'skimage', 'tqdm')


def test_the_cleaner_imports_neither_a_window_nor_the_planner():
    code = 'import sys; import rumba_cleaning.ros.cleaner.cleaner; print(*sys.modules)'
    modules = subprocess.run([sys.executable, '-c', code], stdout=subprocess.PIPE, universal_newlines=True,
                             check=True).stdout.split()
    assert 'rumba_cleaning.strategies' in modules
    assert not [name for name in modules if name.split('.')[0] in LATER]
    found = {name for name in modules if name.startswith('rumba_localisation.')}
    assert found == {'rumba_localisation.edges', 'rumba_localisation.scan'}
