"""zigzag: straight ahead; if something is in the way, back a little and turn, now to the left, now to the right."""

from rumba_cleaning.behaviour import Behaviour, Command
from rumba_cleaning.strategies import strategy

BACK = 1.5  # [s]
TURN = (0.8, 1.6)  # [s] least and longest: turns of the same length would end in a circle that misses most of the floor


@strategy('zigzag')
class Zigzag(Behaviour):
    """Drives to and fro."""

    def __init__(self, context):
        self._speed = context.config.speed
        self._generator = context.generator

    def initialise(self):
        """Begin by driving ahead."""
        self._side = 1.0
        self._since = None  # [s] since the last contact; None while the robot drives ahead
        self._turn = TURN[0]

    def update(self, observation):
        """Ahead, back, turn."""
        if self._since is None:
            if not any(observation.contact):
                return Command(self._speed, 0.0)
            self._side, self._since, self._turn = -self._side, 0.0, self._generator.uniform(*TURN)
        self._since += observation.dt
        if self._since < BACK:
            return Command(-0.1, 0.0)
        if self._since > BACK + self._turn:
            self._since = None
        return Command(0.0, self._side * 1.7)
