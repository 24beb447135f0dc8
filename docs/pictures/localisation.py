"""Draws how far robots are from where they believe to be: ./rumba shell python3 docs/pictures/localisation.py"""

import math
import pathlib

from matplotlib.figure import Figure

from rumba_evaluation.trials.cases import LOCALISED, ODOMETRY, Conditions
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.maps import map_file, named_maps

KINDS = {ODOMETRY: ('by its wheels alone', 12.0, (0.9, 0.47, 0.08)),
         LOCALISED: ('by its laser too', 0.03, (0.2, 0.45, 0.75))}  # words, and how high they stand
TICKS = {0.0001: '0.1 mm', 0.001: '1 mm', 0.01: '1 cm', 0.1: '10 cm', 1.0: '1 m', 10.0: '10 m'}
BOUND = 0.15  # [m]
LONGEST = 21.0  # [min]
EVERY = 10  # steps from one point of a curve to the next


def main():
    """Run the same mission by either kind of pose, and draw the errors."""
    figure = Figure(figsize=(7.5, 3.2), layout='constrained')
    axes = figure.subplots()
    for pose, (words, height, colour) in KINDS.items():
        axes.semilogy(*mission(pose), color=colour, linewidth=1.0)
        axes.annotate(words, (0.98 * LONGEST, height), color=colour, horizontalalignment='right')
    axes.axhline(BOUND, color='0.5', linewidth=0.8, linestyle=':')
    axes.annotate('no error may be larger', (0.98 * LONGEST, 1.15 * BOUND), color='0.4', horizontalalignment='right')
    axes.set(xlabel='time of the mission [min]', ylabel='error of position', xlim=(0.0, LONGEST), ylim=(2e-5, 30.0))
    axes.set_yticks(list(TICKS), list(TICKS.values()))
    axes.minorticks_off()
    axes.spines[['top', 'right']].set_visible(False)
    figure.savefig(str(pathlib.Path(__file__).with_name('localisation.png')), dpi=100)


def mission(pose):
    """The times [min] and errors of position [m] in a mission of the apartment, at every tenth step."""
    trial = Trial(map_file.load(named_maps.path('apartment')), 'boustrophedon', Conditions(pose=pose), seed=1)
    told = trial.sources['rumba']
    found = []

    def watched(world, name):
        belief, true = told(world, name), world.robots[name].pose
        found.append((world.time / 60.0, math.hypot(belief.pose.x - true.x, belief.pose.y - true.y)))
        return belief
    trial.sources['rumba'] = watched
    while not trial.is_over:
        trial.step()
    return zip(*found[::EVERY])


if __name__ == '__main__':
    main()
