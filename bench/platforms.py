"""Digests of missions with the libraries of each supported system: those that `./rumba test --platform` has installed.

`platforms.py [--seeds N]`: N seeds on each of 4 maps, 5 by default. Without the processor's fused multiplication and
addition, the C library rounds otherwise: the digests of such processes are compared too.
"""

import argparse
import os
import pathlib
import subprocess
import sys

from common import figures

ROOT = pathlib.Path(__file__).resolve().parent.parent
PLATFORMS = ROOT / 'test' / 'platforms'
WORKSPACES = ROOT / '.ws' / 'platforms'
MAPS = ('studio', 'apartment', 'apartment_docks', 'field')
SOURCES = ('rumba_sim', 'rumba_localisation', 'rumba_cleaning', 'rumba_evaluation')
NO_FUSED = 'glibc.cpu.hwcaps=-FMA,-AVX2,-FMA4,-FMA_Usable,-AVX2_Usable,-FMA4_Usable'  # names before and since 2.33
MISSIONS = """
import sys
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.maps import map_file, named_maps
for name in sys.argv[2:]:
    for seed in range(1, int(sys.argv[1]) + 1):
        trial = Trial(map_file.load(named_maps.path(name)), 'boustrophedon', seed=seed)
        while not trial.is_over:
            trial.step()
        print(name, seed, trial.world.tick, trial.world.digest(), flush=True)
"""


def main():
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--seeds', type=int, default=5)
    seeds = parser.parse_args().seeds
    figures.heading(f'Missions of boustrophedon, {len(MAPS)} maps, {seeds} seeds, whose digest is that of this Python')
    wanted = digests(sys.executable, seeds)
    for path in sorted(PLATFORMS.glob('*.txt')):
        workspace = WORKSPACES / path.stem
        python = workspace / 'venv' / 'bin' / 'python'
        if python.exists():
            row(path.stem, digests(str(python), seeds, NUMBA_CACHE_DIR=str(workspace / 'cache')), wanted)
        else:
            print(f'  {path.stem}: left out; ./rumba test --platform {path.stem} installs it')
    row('this Python, without fused multiplication and addition in the C library',
        digests(sys.executable, seeds, GLIBC_TUNABLES=NO_FUSED), wanted, is_bound=False)


def digests(python, seeds, **changes):
    """Lines of a mission each, with its digest, by a Python."""
    environment = {**os.environ, 'PYTHONPATH': os.pathsep.join(str(ROOT / name / 'src') for name in SOURCES),
                   'OPENBLAS_NUM_THREADS': '1', **changes}
    return subprocess.run([python, '-c', MISSIONS, str(seeds), *MAPS], env=environment, stdout=subprocess.PIPE,
                          check=True, universal_newlines=True).stdout.splitlines()


def row(name, found, wanted, is_bound=True):
    """Print how many missions are the same."""
    figures.row(name, sum(one == other for one, other in zip(found, wanted)),
                at_least=len(wanted) if is_bound else None)


if __name__ == '__main__':
    main()
