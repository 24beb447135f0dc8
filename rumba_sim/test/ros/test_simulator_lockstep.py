#!/usr/bin/env python3
"""A world in lockstep waits for those who take part, and for nobody longer than its patience."""

import threading
import unittest
import xmlrpc.server

import rosgraph
import rospy
import rostest
from simulators import TICK, Commands, Heard, Simulator, wait

from rumba_msg.msg import Bumper, Lockstep
from rumba_sim.model.maps import map_file
from rumba_sim.model.simulation.robot import FIRST
from rumba_sim.model.simulation.world import World
from rumba_sim.ros.participants.lockstep import Participant
from rumba_sim.ros.participants.maps import map_path

CONTROL_TICKS = 5
COUNT = 40  # control ticks of a test
PATIENCE = 1  # [s] of the wall clock
LONG_PATIENCE = 4  # [s] of the wall clock, for signs of life from a busy machine
SLOW = 0.3  # [s] of the wall clock
NOWHERE = 'http://localhost:1/'


def command(number):
    """The velocity [m/s], [rad/s] for a control tick."""
    return 0.02 * (number % 10), 0.5 - 0.1 * (number % 7)


def digest_of(commands, ticks):
    """The digest of a world in which one robot gets these commands, from the first tick on, after so many ticks."""
    world = World(map_file.load(map_path('field')), seed=1)
    robot = world.spawn(FIRST)
    world.step()
    for number in range(commands):
        robot.command(*command(number), world.tick)
        world.step(CONTROL_TICKS)
    world.step(ticks - world.tick)
    return world.digest()


class SimulatorLockstepTest(unittest.TestCase):
    """Each test has a simulator of its own, as fast as possible."""

    def start(self, *arguments, patience=PATIENCE):
        """A simulator with little patience."""
        return Simulator(self, '_map:=field', '_speed:=0', f'_lockstep_patience:={patience}', *arguments)

    def participant(self, on_tick, *arguments):
        """This node's part in the lockstep, which ends with the test: no later simulator may wait for it."""
        is_over = threading.Event()
        participant = Participant(lambda tick: None if is_over.is_set() else on_tick(tick), *arguments)
        self.addCleanup(participant.leave)
        self.addCleanup(is_over.set)
        return participant

    def test_a_node_that_knows_nothing_of_lockstep_repeats_if_its_commands_are_waited_for(self):
        simulator = self.start('_wait_for:=rumba/cmd_vel')
        commands, done, numbers = Commands(self), threading.Event(), iter(range(COUNT))

        def on_bumper(_):
            number = next(numbers, None)
            if number is None:
                done.set()
            else:
                commands.send(*command(number))
        subscriber = rospy.Subscriber('/rumba/bumper', Bumper, on_bumper)
        self.addCleanup(subscriber.unregister)
        self.assertTrue(done.wait(30.0))
        digest, tick = simulator.digest()
        self.assertEqual(digest, digest_of(COUNT, tick))

    def test_the_world_stands_still_until_a_participant_has_answered(self):
        ticks, answers = [], threading.Semaphore(0)

        def take(tick):
            ticks.append(tick.header.stamp)
            answers.acquire()
            participant.answer(tick.header.stamp)
        participant = self.participant(take, lambda: True)
        self.addCleanup(lambda: [answers.release() for _ in range(1000)])
        simulator = self.start(f'_wait_for:={rospy.get_name()}')
        for number in range(5):
            wait(self, lambda number=number: len(ticks) > number, 'a control tick')
            rospy.rostime.wallsleep(SLOW)
            self.assertEqual([stamp.to_nsec() for stamp in ticks],
                             [(1 + CONTROL_TICKS * count) * TICK for count in range(number + 1)])
            self.assertEqual(simulator.digest()[1], 1 + CONTROL_TICKS * number)
            answers.release()

    def test_a_participant_that_takes_long_for_a_tick_is_waited_for_without_a_word(self):
        log, ticks, may_go_on = Heard(self, '/rosout'), [], threading.Event()

        def take(tick):
            ticks.append(tick)
            if len(ticks) == 2:
                may_go_on.wait()
            participant.answer(tick.header.stamp)
        participant = self.participant(take)
        self.addCleanup(may_go_on.set)
        simulator = self.start(f'_wait_for:={rospy.get_name()}', patience=LONG_PATIENCE)
        wait(self, lambda: len(ticks) == 2, 'the second control tick')
        rospy.rostime.wallsleep(1.5 * LONG_PATIENCE)
        self.assertEqual(simulator.digest()[1], 1 + CONTROL_TICKS)
        may_go_on.set()
        wait(self, lambda: len(ticks) > COUNT, 'the world to go on')
        self.assertEqual([message.msg for message in log.messages if 'without it' in message.msg], [])

    def test_a_topic_without_commands_is_named_in_one_line_and_waited_for_again_after_its_next_one(self):
        log = Heard(self, '/rosout')
        simulator = self.start('_wait_for:=rumba/cmd_vel')
        commands, ticks = Commands(self), Heard(self, '/simulator/lockstep', Lockstep)
        line = (f'lockstep: no answer of /rumba/cmd_vel for {PATIENCE} s: the world goes on without it until '
                'it answers again')
        self.assertEqual(log.find(lambda message: message.msg.startswith('lockstep')).msg, line)
        commands.send(0.1, 0.0)
        wait(self, lambda: sum(message.msg == line for message in log.messages) == 2, 'the second line')
        count = len(ticks.messages)
        wait(self, lambda: len(ticks.messages) > count + 10, 'the world to go on')
        simulator.end()

    def test_a_world_begins_once_those_who_command_are_there_so_that_no_command_is_lost(self):
        simulator = Simulator(self, '_map:=field', '_speed:=0', '_wait_for:=rumba/cmd_vel', '_lockstep_patience:=60')
        ticks = Heard(self, '/simulator/lockstep', Lockstep)
        self.assertEqual(simulator.digest()[1], 0)
        Commands(self)
        self.assertEqual(ticks.find().header.stamp.to_nsec(), TICK)

    def subscribed(self, *topics, is_alive=True):
        """A node of another name, as the master knows it, that has subscribed to topics and does not connect."""
        node, uri = rosgraph.Master('/late'), NOWHERE
        if is_alive:
            server = xmlrpc.server.SimpleXMLRPCServer(('localhost', 0), logRequests=False)
            server.register_function(lambda _: (1, '', '/late'), 'getName')
            server.register_function(lambda _: (1, '', rosgraph.get_master_uri()), 'getMasterUri')
            server.register_function(lambda *_: (1, '', 0), 'publisherUpdate')
            threading.Thread(target=server.serve_forever, args=[0.01], daemon=True).start()
            self.addCleanup(server.server_close)
            self.addCleanup(server.shutdown)
            uri = f'http://localhost:{server.server_address[1]}/'

        def unsubscribe():
            for topic in topics:
                node.unregisterSubscriber(topic, uri)
        for topic in topics:
            node.registerSubscriber(topic, 'nav_msgs/Odometry', uri)
        self.addCleanup(unsubscribe)
        return unsubscribe

    def test_a_world_begins_once_those_who_have_subscribed_are_connected(self):
        unsubscribe = self.subscribed('/rumba/odom')
        simulator = Simulator(self, '_map:=field', '_speed:=0', '_lockstep_patience:=60')
        wait(self, lambda: simulator.digest()[1] == 1, 'the first tick')
        rospy.rostime.wallsleep(SLOW)
        self.assertEqual(simulator.digest()[1], 1)
        unsubscribe()
        wait(self, lambda: simulator.digest()[1] > 1, 'the world to go on')

    def test_who_has_subscribed_and_does_not_connect_is_named_in_one_line_and_not_waited_for_again(self):
        self.subscribed('/rumba/odom', '/rumba/ground_truth')
        log = Heard(self, '/rosout')
        simulator = self.start()
        wait(self, lambda: simulator.digest()[1] > COUNT, 'the world to go on')
        self.assertEqual([message.msg for message in log.messages if message.msg.startswith('lockstep')],
                         ['lockstep: /late has subscribed to /rumba/ground_truth, /rumba/odom, but does not connect: '
                          'the world goes on without it'])

    def test_a_world_does_not_wait_for_subscribers_that_were_killed(self):
        self.subscribed('/rumba/odom', '/rumba/ground_truth', is_alive=False)
        log = Heard(self, '/rosout')
        simulator = Simulator(self, '_map:=field', '_speed:=0', '_lockstep_patience:=600')
        wait(self, lambda: simulator.digest()[1] > COUNT, 'the world to go on')
        self.assertEqual([message.msg for message in log.messages if message.msg.startswith('lockstep')], [])

    def test_without_lockstep_nobody_is_waited_for(self):
        self.start('_wait_for:=rumba/cmd_vel', '_lockstep:=false')
        clock = Heard(self, '/clock')
        wait(self, lambda: len(clock.messages) > 100, 'the world to go on')
        self.assertNotIn('/simulator/lockstep', dict(rospy.get_published_topics()))

    def test_in_real_time_lockstep_has_simulated_time(self):
        self.start('_speed:=1', '_lockstep:=true')
        self.assertTrue(Heard(self, '/simulator/state').find().is_lockstep)
        self.assertLess(Heard(self, '/clock').find().clock.to_sec(), 1000.0)


if __name__ == '__main__':
    rospy.init_node('test_simulator_lockstep', disable_rostime=True)
    rostest.rosrun('rumba_sim', 'simulator_lockstep', SimulatorLockstepTest)
