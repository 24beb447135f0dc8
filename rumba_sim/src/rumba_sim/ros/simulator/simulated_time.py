"""/use_sim_time: set for the time of a simulator, and then as it was before, also by the next one if it was killed.

`python3 -m rumba_sim.ros.simulator.simulated_time` prints true or false: what /use_sim_time was before simulators
changed it. `simulator.launch` needs that, since roslaunch sets parameters before it starts nodes.
"""

from typing import Any

import rosgraph

USE_SIM_TIME = '/use_sim_time'
FOUND = '/use_sim_time_before_simulator'  # while a simulator has set it, and after one was killed


class SimulatedTime:
    """What a simulator does with /use_sim_time."""

    def __init__(self, node: str) -> None:
        """Do nothing yet; `node` is the full name of the simulator."""
        self._master = rosgraph.Master(node)

    def found(self) -> bool:
        """What /use_sim_time was before a simulator, or the launch file of one, set it."""
        return bool(_value(self._master, FOUND, _value(self._master, USE_SIM_TIME, False)))

    def mend(self) -> str:
        """Restore what a simulator found that was killed; returns a line about it, which is empty if there was none."""
        if _value(self._master, FOUND, None) is None:
            return ''
        self.restore()
        return ('an earlier simulator was killed and left /use_sim_time set: it is '
                f'{"true" if self.found() else "false"} again, as before')

    def claim(self) -> bool:
        """Make time that of /clock, for nodes that start from now on; returns whether it was before."""
        was_simulated = bool(_value(self._master, USE_SIM_TIME, False))
        self._master.setParam(FOUND, self.found())
        self._master.setParam(USE_SIM_TIME, True)
        return was_simulated

    def restore(self) -> None:
        """Make /use_sim_time what it was; if it was not true, it is deleted: without /clock, time would stand still."""
        found = self.found()
        for name in ([] if found else [USE_SIM_TIME]) + [FOUND]:
            if self._master.hasParam(name):
                self._master.deleteParam(name)


def _value(master: rosgraph.Master, name: str, default: Any) -> Any:
    return master.getParam(name) if master.hasParam(name) else default


def main() -> None:
    """Print what was found; without a master, that is false."""
    try:
        print('true' if SimulatedTime('/roslaunch').found() else 'false')
    except OSError:
        print('false')


if __name__ == '__main__':
    main()
