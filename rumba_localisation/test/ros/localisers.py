"""What the tests of the localiser share: a localiser as a user starts it."""

import signal
import subprocess

import rospy
from simulators import TIMEOUT, executable, lookup, wait


class Localiser:
    """A localiser for one test."""

    def __init__(self, test, *arguments, name='/localiser', robot='/rumba'):
        self._test = test
        if rospy.has_param(name):
            rospy.delete_param(name)
        rospy.set_param('/use_sim_time', True)
        self.process = subprocess.Popen([executable('rumba_localisation', 'localiser'), *arguments])
        test.addCleanup(self.end)
        wait(test, lambda: self.process.poll() is not None or lookup(f'{robot}/request_nomotion_update'),
             'the localiser')
        test.assertIsNone(self.process.poll(), 'the localiser ended')

    def end(self):
        """End it, cleanly."""
        if self.process.returncode is None:
            self.process.send_signal(signal.SIGTERM)
            try:
                self._test.assertEqual(self.process.wait(TIMEOUT), 0)
            finally:
                self.process.kill()
                self.process.wait()
