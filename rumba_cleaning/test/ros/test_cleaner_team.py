#!/usr/bin/env python3
"""Two cleaners of one team share a floor: in lockstep as in process, bit for bit; and one goes on without the other."""

import signal
import unittest

import rospy
import rostest
from cleaners import FLOOR, Cleaner
from simulators import Heard, Simulator, folder_of, wait
from teams import Crew
from tiers import thorough

from rumba_msg.msg import MissionStatus, TeamPlan, TeamReport
from rumba_sim.model.maps import map_file
from rumba_sim.model.settings.robot_config import RobotConfig

MAP = FLOOR + 'docks: [[2.2, 0.65, 0.0], [0.2, 0.65, 3.14159]]\n'
PICTURE = b'P5 48 26 255\n' + 48 * 26 * b'\xff'  # 2.4 m x 1.3 m
SEED, TARGET = 5, 0.9
TEAM = '_team:=rumba rumba2'


class CleanerTeamTest(unittest.TestCase):
    """Each test has its own nodes."""

    def started(self, *arguments, is_paused=False):
        """A simulator with two robots, and their cleaners, which begin to clean once it is not paused any more."""
        folder = folder_of(self, {'floor.yaml': MAP.encode(), 'floor.pgm': PICTURE})
        self.path = f'{folder}/floor.yaml'
        simulator = Simulator(self, f'_map:={self.path}', '_robots:=2', f'_seed:={SEED}', '_speed:=50',
                              '_brushes_up:=true', *arguments)
        if is_paused:
            simulator.pause()
        common = TEAM, f'_seed:={SEED}', f'_target_coverage:={TARGET}', '_autostart:=true'
        first = Cleaner(self, *common)
        second = Cleaner(self, *common, '__name:=cleaner2', '_robot:=rumba2', name='/cleaner2', robot='/rumba2')
        return simulator, first.connect(), second.connect()

    def has_ended(self, cleaner):
        """Wait until a mission has ended; returns what was said of it."""
        cleaner.status.find(lambda status: status.state == MissionStatus.CLEANING)
        return cleaner.status.find(lambda status: status.state in (MissionStatus.IDLE, MissionStatus.STRANDED)
                                   and 'swept' in status.message)

    @thorough
    def test_a_team_cleans_in_lockstep_as_in_process(self):
        simulator, *cleaners = self.started('_wait_for:=cleaner cleaner2')
        for cleaner in cleaners:
            self.assertRegex(self.has_ended(cleaner).message, r'^9\d\.\d % swept$')
        digest, tick = simulator.digest()
        crew = Crew(map_file.load(self.path), RobotConfig(), target=TARGET, seed=SEED)
        crew.run()
        crew.world.step(tick - crew.world.tick)
        self.assertEqual(digest, crew.world.digest())

    def test_a_robot_goes_on_without_a_mate_whose_cleaner_was_killed(self):
        log = Heard(self, '/rosout')
        simulator, first, second = self.started('_lockstep_patience:=5', is_paused=True)
        reports = Heard(self, '/rumba2/team_report', TeamReport)
        simulator.does('resume')
        reports.find(lambda report: report.task == TeamReport.SWEEPING)
        second.process.send_signal(signal.SIGKILL)
        second.process.wait()
        log.find(lambda message: message.msg.startswith('rumba: rumba2 has fallen silent: it counts '))
        # What stands on the floor without moving may keep a robot from its dock, or from the last of the floor.
        self.assertRegex(self.has_ended(first).message, r'^[89]\d\.\d % swept')

    @thorough
    def test_nonsense_of_a_mate_is_ignored_with_a_line(self):
        log = Heard(self, '/rosout')
        simulator, first, second = self.started()
        for topic, kind, bad in (('team_report', TeamReport, TeamReport(task=200)),
                                 ('team_report', TeamReport, TeamReport(remaining=float('nan'))),
                                 ('team_plan', TeamPlan, TeamPlan(route=99, x=[1.0], y=[], speed=[0.3]))):
            publisher = rospy.Publisher(f'/rumba2/{topic}', kind, queue_size=1)
            self.addCleanup(publisher.unregister)
            wait(self, publisher.get_num_connections, 'the mate to listen')
            publisher.publish(bad)
            log.find(lambda message, topic=topic: message.msg.startswith(f'rumba2/{topic} is no '))
        for cleaner in (first, second):
            self.assertRegex(self.has_ended(cleaner).message, r'^9\d\.\d % swept')


if __name__ == '__main__':
    rospy.init_node('test_cleaner_team')
    rostest.rosrun('rumba_cleaning', 'cleaner_team', CleanerTeamTest)
