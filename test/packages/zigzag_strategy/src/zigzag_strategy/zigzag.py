"""zigzag: straight on; where something is in the way, back a little and turn, now to the left, now to the right."""

from rumba_sim.cleaning.behaviour import Behaviour, Command
from rumba_sim.cleaning.strategies import strategy

BACK, TURN = 1.0, 1.6  # [s]


@strategy('zigzag')
class Zigzag(Behaviour):
    """Goes to and fro."""

    def __init__(self, context):
        self._speed = context.config.speed
        self.initialise()

    def initialise(self):
        """Begin by going ahead."""
        super().initialise()
        self._side = 1.0
        self._since = None  # [s] since the last contact; None before the first

    def update(self, observation):
        """Ahead, back, turn."""
        if self._since is not None:
            self._since += observation.dt
        is_ahead = self._since is None or self._since > BACK + TURN
        if is_ahead and any(observation.contact):
            self._side, self._since = -self._side, 0.0
        if self._since is None or self._since > BACK + TURN:
            return Command(self._speed, 0.0)
        if self._since < BACK:
            return Command(-0.1, 0.0)
        return Command(0.0, self._side * 1.7)
