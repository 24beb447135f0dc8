"""The file from which a simulator goes on, as it was, after it was ended or killed."""

import os
from typing import Optional, Sequence, Tuple

import rospy

from rumba_sim.model.common.errors import WorldError
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.simulation import world_state
from rumba_sim.model.simulation.obstacle import Obstacle
from rumba_sim.model.simulation.world import World
from rumba_sim.ros.common.paths import absolute
from rumba_sim.ros.simulator.settings import Settings

PERIOD = 60  # [s] of simulated time from one save to the next


class StateFile:
    """Saves a world, if the settings name a file for that."""

    def __init__(self, settings: Settings) -> None:
        """Read nothing and write nothing yet."""
        self._path = absolute(settings.state) if settings.state else ''
        self._period = PERIOD * settings.step_rate
        self._trouble = ''  # why the last save failed; empty: it did not

    def world(self, plan: FloorPlan, settings: Settings,
              obstacles: Sequence[Obstacle]) -> Tuple[Optional[World], int]:
        """The world that was saved, None if there is none; and the number of ticks of the simulation.

        Args:
            plan: its floor plan.
            settings: of the simulator.
            obstacles: that were there from the start.

        Raises:
            WorldError: the file is damaged, or does not fit to map and settings; it stays as it is.
        """
        if not self._path or not os.path.lexists(self._path):
            return None, 0
        state, ticks = world_state.read(self._path)
        try:
            world = World.restored(state, plan, settings.robot, settings.step_rate, settings.seed,
                                   obstacles)
        except WorldError as error:
            raise WorldError(f'{self._path}: {error}: start with what it was saved with, or give state another '
                             'file') from None
        names = ', '.join(world.robots) or 'none'
        rospy.loginfo(f'goes on from {self._path}, saved after {ticks} ticks; robots: {names}')
        return world, ticks

    def begin(self, world: World, ticks: int) -> None:
        """Save for the first time.

        Raises:
            WorldError: the file cannot be written.
        """
        if self._path:
            world_state.write(self._path, world.state(), ticks)

    def save(self, world: World, ticks: int) -> None:
        """Save; if that fails, say so once, and keep what was saved before."""
        before, self._trouble = self._trouble, ''
        try:
            self.begin(world, ticks)
        except WorldError as error:
            self._trouble = str(error)
            if self._trouble != before:
                rospy.logerr(f'{error}; what was saved before is still there')
        else:
            if before:
                rospy.loginfo(f'{self._path}: the world is saved again')

    def save_if_due(self, world: World, ticks: int) -> None:
        """Save every minute of simulated time."""
        if self._path and ticks % self._period == 0:
            self.save(world, ticks)
