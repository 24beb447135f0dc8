"""A goal of the cleaner with a behaviour that follows a script, and the robot that it drives, without ROS."""

import types

import rospy

from rumba_cleaning.behaviour import Behaviour, Command, Observation
from rumba_cleaning.mission.stages import State
from rumba_cleaning.ros.cleaner.goals import run as module
from rumba_cleaning.ros.cleaner.goals.activities import Activity
from rumba_cleaning.ros.cleaner.goals.run import Run
from rumba_sim.model.common.geometry import Pose

AHEAD = Command(0.2, 0.5, brushes_up=False)
DT = 100_000_000  # [ns]


class Scripted(Behaviour):
    """Answers what a list of functions says, one after the other; the last one for ever."""

    def __init__(self, *script):
        self.script = list(script)
        self.watched = []
        self.ends = 0

    def update(self, observation):
        decide = self.script.pop(0) if len(self.script) > 1 else self.script[0]
        return decide(self)

    def take_note(self, observation):
        self.watched.append(observation.pose.x)

    def terminate(self):
        self.ends += 1


def ahead(_):
    """Drive on."""
    return AHEAD


def arrive(behaviour):
    """End as planned."""
    return behaviour.succeed('there')


def divide(_):
    """Go wrong."""
    return 1 / 0


class Going(Activity):
    """What the robot does for the goals of these tests."""

    state = State.CLEANING
    strategy = 'zigzag'

    def feedback(self, senses, mission):
        return mission

    @staticmethod
    def result(senses, outcome):
        return outcome


class Senses:
    """What a robot senses, without ROS."""

    def __init__(self):
        self.passed, self.stamp, self.heard, self.unread = 0, rospy.Time(1), 0.0, 0
        self.cleaning, self.absence = None, 'the robot is gone'
        self.is_alone = self.has_fallen = False
        self.is_complete = True
        self.x = 0.0

    def begin(self):
        """Nothing to do."""

    def observe(self):
        """What it knows."""
        return Observation(DT / 1e9, Pose(self.x, 0.0, 0.0)) if self.is_complete else None

    def missing(self):
        """What is missing."""
        return 'no reading'


class Robot:
    """A robot without ROS, and the client of its goal, on a clock of their own.

    Attributes:
        told: what was commanded, published and answered, in this order.
    """

    def __init__(self, monkeypatch, *script, time_limit=100.0):
        self.told = []
        self.now = 1000.0
        self.senses = Senses()
        self.senses.heard = self.now
        self.teleop = types.SimpleNamespace(is_driving=False)
        self.wheels = types.SimpleNamespace(drive=lambda command: self.told.append(command[:2]))
        self.brushes = types.SimpleNamespace(
            want=lambda are_up: self.told.append('up' if are_up else 'down'), forget=lambda: self.told.append('forget'))
        self.shown = []  # of the plan
        self.plan = types.SimpleNamespace(show=lambda path, stamp: self.shown.append(path))
        self.announcer = types.SimpleNamespace(tell=self._tell, say=self.told.append, status='status')
        monkeypatch.setattr(module.time, 'monotonic', lambda: self.now)
        monkeypatch.setattr(module.rospy, 'logerr', lambda _: None)
        self.behaviour = Scripted(*script)
        answers = {f'set_{how}': lambda outcome, message, how=how: self.told.append((how, outcome.code, message))
                   for how in ('succeeded', 'canceled', 'aborted')}
        handle = types.SimpleNamespace(publish_feedback=lambda _: self.told.append('feedback'), **answers)
        self.run = Run(Going(self.behaviour, time_limit, 0.0), handle, self)

    def _tell(self, state, strategy, message, stamp, is_due):
        self.status = (state, strategy, message)

    def rest(self):
        """Stop."""
        self.told.append('rest')

    def reads(self, seconds=0.1, moved=0.01):
        """A reading comes after a time; returns what was told since the one before."""
        self.told.clear()
        self.senses.passed += round(seconds * 1e9)
        self.senses.stamp = rospy.Time(1) + rospy.Duration(nsecs=self.senses.passed)
        self.senses.x += moved
        self.now += seconds
        self.senses.heard = self.now
        self.run.read()
        return self.told[:]

    def waits(self, seconds):
        """No reading comes for a time of the wall clock; returns what was told."""
        self.told.clear()
        self.now += seconds
        self.run.look_after()
        return self.told[:]

    @property
    def answer(self):
        """How the client's goal ended, with what code, and the text."""
        assert self.run.is_closed
        return self.told[-1]
