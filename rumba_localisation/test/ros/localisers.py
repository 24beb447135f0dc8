"""What the tests of the localisation share: a localiser or a mapper as a user starts it."""

import signal

import programs
import rospy
from simulators import TIMEOUT, wait_for_service

programs.LIBRARIES += ['rumba_localisation.mapping.warm_up']


class Localiser:
    """A localiser for one test."""

    program, service = 'localiser', '/rumba/request_nomotion_update'

    def __init__(self, test, *arguments):
        self._test = test
        if rospy.has_param(f'/{self.program}'):
            rospy.delete_param(f'/{self.program}')
        rospy.set_param('/use_sim_time', True)
        self.process = programs.start('rumba_localisation', self.program, *arguments)
        test.addCleanup(self.end)
        wait_for_service(test, self.service, self.process)

    def end(self):
        """End it, cleanly."""
        if self.process.returncode is None:
            self.process.send_signal(signal.SIGTERM)
            try:
                self._test.assertEqual(self.process.wait(TIMEOUT), 0)
            finally:
                self.process.kill()
                self.process.wait()


class Mapper(Localiser):
    """A mapper for one test."""

    program, service = 'mapper', '/mapper/save_map'
