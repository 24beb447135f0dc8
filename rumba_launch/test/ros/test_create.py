"""create.launch has a Create clean from its dock to its dock; robot, driver and dock share no code with Rumba."""

import sys
import tempfile
from typing import Any, NamedTuple

from create_msgs.msg import ChargingState, Mode
from foreign_robots import FAKES, ForeignRobotTest
from std_msgs.msg import Empty, Float32
from tiers import thorough

SMALL_BATTERY = {'lasts': 110, 'fills': 60}  # [s]
CHARGING, FULL, PASSIVE = ChargingState.CHARGE_FULL, Mode.MODE_FULL, Mode.MODE_PASSIVE


class Event(NamedTuple):
    """What the driver published or was told, if it is another value than before."""

    topic: str
    value: Any
    swept: float  # share, until then
    charge: float  # share, then


class CreateTest(ForeignRobotTest):
    """A robot that begins on its dock."""

    def setUp(self):
        super().setUp()
        self.events, self.charge = [], 1.0
        self.hear('/battery/charge_ratio', Float32, self._take_charge)
        self.hear('/battery/charging_state', ChargingState, lambda message: self._note('charging', message.state))
        self.hear('/mode', Mode, lambda message: self._note('mode', message.mode))
        for topic in ('dock', 'undock'):
            self.hear(f'/{topic}', Empty, lambda _, topic=topic: self._note(topic, None))

    def _take_charge(self, message):
        self.charge = message.data

    def _note(self, topic, value):
        last = next((event.value for event in reversed(self.events) if event.topic == topic), 'nothing')
        if value is None or value != last:
            swept = self.shares[-1].data if self.shares else 0.0
            self.events.append(Event(topic, value, swept, self.charge))

    def _all(self, topic, value=None):
        return [event for event in self.events if (event.topic, event.value) == (topic, value)]

    def _cleans(self, room, *arguments, **parameters):
        self.start('fake_create', 'create.launch', *arguments, room=room, answer='/rumba/seek_dock',
                   witness='/rumba/dock_status', **parameters)
        return self.wait_for_end()

    def _check_stays(self, least):
        """Whether it came home by itself to charge, went on, and ended on its dock."""
        first, last = self._all('charging', CHARGING)[0], self._all('charging', CHARGING)[-1]
        self.assertEqual(next(event for event in self.events if event.topic == 'mode').value, FULL)
        self.assertGreater(first.swept, 0.2)  # it left its dock, and cleaned: less on a busy machine
        self.assertLess(first.charge, 0.5)
        self.assertIn('dock', [event.topic for event in self.events[:self.events.index(first)]])
        left = next(event for event in self.events[self.events.index(first):] if event.topic == 'undock')
        self.assertGreater(left.charge, 0.9)
        self.assertGreater(last.swept, left.swept + 0.02)  # it went on
        ends = {event.topic: event.value for event in self.events}
        self.assertEqual(ends['mode'], PASSIVE)
        self.assertIn(ends['charging'], (CHARGING, ChargingState.CHARGE_TRICKLE))
        self.assertGreaterEqual(self.shares[-1].data, least)

    def test_it_leaves_its_dock_and_maps_and_cleans_and_charges_and_goes_on_and_ends_on_its_dock(self):
        _, message = self._cleans('room', **SMALL_BATTERY)
        self.assertRegex(message, '9[5-9].* % swept')
        self._check_stays(0.95)

    @thorough
    def test_by_a_map_it_does_the_same_in_a_furnished_room(self):
        sys.path.append(str(FAKES))
        import fake_create
        import fake_robot
        room, _ = fake_create.ROOMS['furnished']
        with tempfile.TemporaryDirectory() as folder:
            fake_robot.draw(room, f'{folder}/room')
            _, message = self._cleans('furnished', f'map:={folder}/room.yaml', f'home:={"%.3f %.3f %.4f" % room.start}',
                                      lasts=400, fills=100)
        self.assertRegex(message, '9[7-9].* % swept')
        self._check_stays(0.97)

    @thorough
    def test_if_no_beam_comes_it_tries_again_and_then_says_so(self):
        _, message = self._cleans('room', fault='no beams')
        self.assertRegex(message, r'% swept: 3 attempts to dock failed: the robot .*; it received no beam of a dock$')
        self.assertEqual(self._all('charging', CHARGING), [])

    @thorough
    def test_a_robot_that_is_lifted_stops(self):
        _, message = self._cleans('room', fault='lifted')
        self.assertRegex(message, '^a wheel hangs over a cliff')
