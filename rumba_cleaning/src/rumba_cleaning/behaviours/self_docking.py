"""Has a robot that finds its dock by itself, as a Create does, come home from where it stands before the dock."""

from rumba_cleaning.behaviour import Behaviour, Command, Observation
from rumba_cleaning.belief.context import Context
from rumba_sim.model.common.geometry import Pose, hypot

SEEK = Command(0.0, 0.0, brushes_up=True, seeks_dock=True)
PATIENCE = 90.0  # [s]: from before the dock a robot takes half a minute; our choice
FARTHEST = 2.0  # [m] from the dock: it follows no beam, but looks for one all over the floor; our choice


class SelfDocking(Behaviour):
    """Lets the robot drive; fails if it takes long, or goes astray. Who sees that it is docked ends it."""

    def __init__(self, context: Context, dock: Pose) -> None:
        """Seek a dock."""
        self._context, self._dock = context, dock

    def initialise(self) -> None:
        """Begin."""
        self._time = 0.0  # [s]
        self._has_received = False

    def update(self, observation: Observation) -> Command:
        """Watch."""
        self._time += observation.dt
        self._has_received |= observation.infrared.omni > 0
        away = hypot(observation.pose.x - self._dock.x, observation.pose.y - self._dock.y)
        beams = 'it received beams of a dock' if self._has_received else 'it received no beam of a dock'
        if away > FARTHEST:
            return self.fail(f'the robot went {away:.1f} m from where its dock was; {beams}')
        if self._time > PATIENCE:
            return self.fail(f'the robot did not dock by itself in {PATIENCE:g} s; {beams}')
        self.message = 'docking by itself'
        return SEEK
