"""The public interface of Rumba in Python: simulate robots, clean with strategies, score paths, learn.

What `__all__` names keeps to semantic versioning. Whatever is not named here is private and may change at any time.
docs/python.md has an example of each.
"""

from rumba._calls import evaluate, load_map, make_env, score_path
from rumba_cleaning.behaviour import Behaviour, Command, Observation
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.strategies import strategy
from rumba_evaluation.trials.cases import Conditions, Result
from rumba_evaluation.trials.score import Score
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.common.errors import RumbaError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World
from rumba_sim.model.simulation.worlds import Worlds

__all__ = ['Behaviour', 'Command', 'Conditions', 'FloorPlan', 'Observation', 'Outcome', 'Pose', 'Result', 'RobotConfig',
           'RumbaError', 'Score', 'Trial', 'World', 'Worlds', 'evaluate', 'load_map', 'make_env', 'score_path',
           'strategy']
