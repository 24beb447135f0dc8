"""Robots that share a floor, in process: each hears after a step what the others did in it, as through ROS."""

from rumba_cleaning.behaviour import Status
from rumba_cleaning.belief.context import Context, own_seed
from rumba_cleaning.belief.mates import Mates
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.control import CONTROL_DT, CONTROL_TICKS, STEP_RATE, act
from rumba_cleaning.executors import BeforeNextStep
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.mission.team import tell_mates
from rumba_sim.model.simulation.robot import nth_name
from rumba_sim.model.simulation.world import World

QUICKLY = CleaningConfig(planning_rounds=0)  # of the cleaners of the tests with nodes too


class Crew:
    """Missions of a team on one floor.

    Attributes:
        world: with the robots.
        contexts, missions: of each robot, by its name.
        silent: robots that neither act nor tell anything any more.
    """

    def __init__(self, plan, config, count=2, target=0.98, poses=(), seed=0):
        """Put robots at poses, or where they begin."""
        self.world = World(plan, config, STEP_RATE, seed)
        for number in range(count):
            self.world.spawn(nth_name(number + 1), poses[number] if poses else None, brushes_up=True)
        names = list(self.world.robots)
        self.planners = BeforeNextStep()
        self.contexts = {
            name: Context(plan, config, QUICKLY, own_seed(seed, name), self.planners, mates=Mates(name, names))
            for name in names}
        self.missions = {name: Mission(context, 'boustrophedon', target) for name, context in self.contexts.items()}
        self.silent = set()
        self._dt = 0.0
        self.world.step()

    def step(self):
        """Have all robots act once."""
        self.planners.work()
        for name, mission in self.missions.items():
            if mission.status is Status.RUNNING and name not in self.silent:
                act(mission, self.world, name, self._dt)
        tell_mates({name: mission for name, mission in self.missions.items() if name not in self.silent})
        self._dt = CONTROL_DT
        self.world.step(CONTROL_TICKS)

    def plan(self, *names):
        """Step until all of these robots have a plan; returns how long each takes [s]."""
        while any(self.missions[name].plan_ahead() is None for name in names):
            self.step()
        return [float(self.missions[name].plan_ahead().route.times()[-1]) for name in names]

    def run(self, seconds=4000.0):
        """Step until all missions have ended; returns the time that it took [s]."""
        begin = self.world.time
        while any(mission.status is Status.RUNNING and name not in self.silent
                  for name, mission in self.missions.items()):
            assert self.world.time < begin + seconds, [mission.message for mission in self.missions.values()]
            self.step()
        return self.world.time - begin
