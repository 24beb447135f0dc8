"""What the tests of the localiser share: a localiser as a user starts it."""

import signal

import programs
import rospy
from simulators import TIMEOUT, wait_for_service

programs.LIBRARIES += ['rumba_localisation.mapping.warm_up']


class Localiser:
    """A localiser for one test."""

    def __init__(self, test, *arguments, name='/localiser', robot='/rumba'):
        self._test = test
        if rospy.has_param(name):
            rospy.delete_param(name)
        rospy.set_param('/use_sim_time', True)
        self.process = programs.start('rumba_localisation', 'localiser', *arguments)
        test.addCleanup(self.end)
        wait_for_service(test, f'{robot}/request_nomotion_update', self.process)

    def end(self):
        """End it, cleanly."""
        if self.process.returncode is None:
            self.process.send_signal(signal.SIGTERM)
            try:
                self._test.assertEqual(self.process.wait(TIMEOUT), 0)
            finally:
                self.process.kill()
                self.process.wait()
