#!/usr/bin/env python3
"""The page beside a simulator: its protocol, its rights, the client libraries of others, and real browsers."""

import importlib.util
import math
import os
import shutil
import subprocess
import sys
import unittest
import urllib.request

import programs
import rospy
import rostest
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import MapMetaData, OccupancyGrid
from pages import DESK, HAS_BROWSER, PHONE, Browser, Client, OwnMaster, Page
from simulators import TIMEOUT, Heard, Simulator, wait

from rumba_msg.msg import CleanActionGoal

TELEOP = '/rumba/teleop/cmd_vel'
MIDDLE = 5.54  # [m] x and y of the middle of the map field
DIRTY, UNMAPPED = (184, 134, 60), (221, 209, 190)  # floor that is to sweep, on the robot's map or not
ALLOWED = ('_read:=/chatter', '_write:=/chatter', '_serve:=/half', '_call:=/half', '_get:=/lesson', '_set:=/lesson')
PYTHON_CLIENT = '''
import sys, threading, time, roslibpy, roslibpy.tf
ros = roslibpy.Ros(host="127.0.0.1", port=int(sys.argv[1]))
ros.run()
heard = []
roslibpy.Topic(ros, "/chatter", "std_msgs/String").subscribe(lambda message: heard.append(message["data"]))
talker = roslibpy.Topic(ros, "/chatter", "std_msgs/String")
while not heard:
    talker.publish(roslibpy.Message({"data": "Hello World!"}))
    time.sleep(0.05)
def half(request, response):
    response["message"] = str(request["data"])
    return True
roslibpy.Service(ros, "/half", "std_srvs/SetBool").advertise(half)
half_of_ros = roslibpy.Service(ros, "/half", "std_srvs/SetBool")
lesson, moved = roslibpy.Param(ros, "/lesson"), threading.Event()
lesson.set([1, "x"])
roslibpy.tf.TFClient(ros, fixed_frame="map").subscribe("laser", lambda transform: moved.set())
print(heard[0], "/rumba/scan" in ros.get_topics(), ros.get_topic_type("/map"), lesson.get(), moved.wait(30),
      half_of_ros.call(roslibpy.ServiceRequest({"data": True}))["message"],
      roslibpy.Service(ros, "/simulator/pause", "std_srvs/Trigger").call(roslibpy.ServiceRequest()))
ros.terminate()
'''
NODE_CLIENT = '''
import * as ROSLIB from "roslib";
const ros = new ROSLIB.Ros({url: `ws://127.0.0.1:${process.argv[1]}`});
const topic = new ROSLIB.Topic({ros, name: "/chatter", messageType: "std_msgs/String"});
const pause = new ROSLIB.Service({ros, name: "/simulator/pause", serviceType: "std_srvs/Trigger"});
const cells = compression => new Promise(done => {
  const map = new ROSLIB.Topic({ros, name: "/map", messageType: "nav_msgs/OccupancyGrid", compression});
  map.subscribe(({info, data}) => {
    map.unsubscribe();
    done(data.length === info.width * info.height);
  });
});
const half = () => new ROSLIB.Service({ros, name: "/half", serviceType: "std_srvs/SetBool"});
const lesson = new ROSLIB.Param({ros, name: "/lesson"});
const tf = new ROSLIB.TFClient({ros, fixedFrame: "map"});
const timer = setInterval(() => topic.publish({data: "Hello World!"}), 50);
topic.subscribe(heard => {
  topic.unsubscribe();
  clearInterval(timer);
  const called = (service, values) => new Promise((done, failed) => service.callService(values, done, failed));
  (async () => {
    await half().advertiseAsync(async ({data}) => ({message: String(data)}));
    await new Promise(done => lesson.set([1, "x"], done));
    const {topics} = await new Promise(done => ros.getTopics(done));
    await new Promise(done => tf.subscribe("laser", done));
    console.log(heard.data, topics.includes("/rumba/scan"), await cells("png"), await cells("cbor"),
      await new Promise(done => lesson.get(done)), (await called(half(), {data: true})).message,
      (await called(pause, {})).message);
    process.exit(0);
  })();
});
'''
NODE_FOLDER = os.path.dirname(os.environ.get('NODE_PATH', '').rstrip('/')) or None  # that contains node_modules


def printed_by(test, *command, folder=None):
    """What a program prints that must end well."""
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True,
                          timeout=3 * TIMEOUT)
    test.assertEqual(done.returncode, 0, done.stderr)
    return done.stdout


class PageTest(unittest.TestCase):
    """Each test has a simulator and a page of its own."""

    def test_a_client_sees_drives_sends_goals_and_calls(self):
        Simulator(self, '_map:=field', '_speed:=2')
        client = Client(self, Page(self))
        goals = []
        self.addCleanup(rospy.Subscriber('/rumba/clean/goal', CleanActionGoal, goals.append).unregister)
        client.send(op='subscribe', topic='/rumba/ground_truth', throttle_rate=50)
        start = client.message('/rumba/ground_truth')['pose']['pose']['position']
        truth = Heard(self, '/rumba/ground_truth').fresh().pose.pose.position
        self.assertEqual((start['x'], start['y']), (truth.x, truth.y))
        client.send(op='advertise', topic='/rumba/clean/goal', type='rumba_msg/CleanActionGoal')
        client.send(op='publish', topic='/rumba/clean/goal', msg={'goal': {'target_coverage': 0.5}})
        goal = wait(self, lambda: goals, 'the goal')[0]
        self.assertEqual(goal.goal.target_coverage, 0.5)
        self.assertGreater(goal.header.stamp.to_nsec(), 0)
        self.assertLess(goal.header.stamp.to_sec(), 1e6)  # time is simulated
        client.send(op='advertise', topic=TELEOP, type='geometry_msgs/Twist')
        for _ in range(1000):
            client.send(op='publish', topic=TELEOP, msg={'linear': {'x': 0.3}})
            there = client.message('/rumba/ground_truth')['pose']['pose']['position']
            if math.hypot(there['x'] - start['x'], there['y'] - start['y']) > 0.3:
                break
        else:
            self.fail('the robot does not move')
        self.assertEqual(client.call('/simulator/pause'), (True, {'success': True, 'message': 'paused'}))
        client.send(op='subscribe', topic='simulator/state')
        self.assertTrue(client.message('simulator/state', lambda state: state['is_paused']))
        works, line = client.call('/rumba/set_brushes_up', data='up')
        self.assertFalse(works)
        self.assertIn("data is 'up': must be true or false", line)
        topics = client.call('/rosapi/topics_for_type', type='nav_msgs/Odometry')[1]['topics']
        self.assertIn('/rumba/ground_truth', topics)

    def test_each_pupil_drives_one_robot_and_spectators_none(self):
        Simulator(self, '_map:=field', '_robots:=2')
        page = Page(self, '_token:=teacher', '_robot_tokens:=rumba:blue,rumba2:green')
        commands = {robot: Heard(self, f'/{robot}/ground_truth') for robot in ('rumba', 'rumba2')}
        pupil, guest = Client(self, page, token='blue'), Client(self, page)
        for client, robot in ((guest, 'rumba'), (pupil, 'rumba2')):
            client.send(op='publish', topic=f'/{robot}/cmd_vel', msg={'linear': {'x': 0.3}})
            self.assertIn('token', client.find(lambda one: one['op'] == 'status')['msg'])
        self.assertEqual(pupil.call('/simulator/pause')[0], False)
        wait(self, lambda: pupil.send(op='publish', topic='/rumba/cmd_vel', msg={'linear': {'x': 0.3}}) or any(
            message.twist.twist.linear.x > 0.1 for message in commands['rumba'].messages), 'the pupil’s robot to drive')
        self.assertFalse(any(message.twist.twist.linear.x for message in commands['rumba2'].messages))
        self.assertTrue(Client(self, page, token='teacher').call('/simulator/pause')[0])

    def test_a_restart_of_the_simulator_and_of_the_master_is_survived(self):
        master = OwnMaster(self).start()
        simulator, page = master.simulator(), Page(self, '_rate:=10000', master=master.uri)
        client = Client(self, page)
        client.send(op='subscribe', topic='/simulator/state')
        first = client.message('/simulator/state')['run']
        simulator.end()
        master.simulator()
        client.message('/simulator/state', lambda state: state['run'] != first)
        master.restart()
        client = Client(self, page)
        wait(self, lambda: '/rumba/odom' in str(client.call('/rosapi/topics')), 'the new master')
        client.send(op='subscribe', topic='/rumba/odom')
        client.message('/rumba/odom')

    def test_without_a_master_the_page_is_served_and_says_what_it_waits_for(self):
        master = OwnMaster(self)
        page = Page(self, master=master.uri)
        with urllib.request.urlopen(page.url, timeout=TIMEOUT) as answer:
            self.assertIn('<canvas id="floor"', answer.read().decode())
        client = Client(self, page)
        client.send(op='subscribe', topic='/rumba/odom')
        works, line = client.call('/rosapi/topics')
        self.assertFalse(works)
        self.assertIn(f'no roscore answers at {master.uri}', line)
        master.start()
        with self.assertRaises(EOFError):  # and connects again, as browsers do
            client.find(lambda _: False)
        client = Client(self, page)
        self.assertTrue(client.call('/rosapi/topics')[0])
        page.end()

    def test_refusals_are_in_the_log(self):
        page = Page(self, '_token:=teacher')
        client = Client(self, page)
        client.send(op='subscribe', topic='/rosout')
        client.find(lambda one: one['op'] == 'status')
        wait(self, lambda: "client at 127.0.0.1: '/rosout' cannot be subscribed to here" in page.printed, 'the line')

    def test_bad_parameters_are_refused_in_one_line(self):
        for arguments, words in ((['_address:=0.0.0.0'], 'which others can reach: give a token:= too'),
                                 (['_robot_tokens:=rumba'], 'robot_tokens must be robots with their tokens'),
                                 (['_read:=x/*y'], "'x/*y' cannot be allowed"),
                                 (['_port:=70000'], 'port'), (['_tokn:=x'], 'tokn')):
            if rospy.has_param('/page'):
                rospy.delete_param('/page')
            done = programs.run('rumba_viewer', 'page', *arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                universal_newlines=True, timeout=TIMEOUT)
            self.assertEqual(done.returncode, 2)
            self.assertIn(words, done.stderr)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)


class LibraryTest(unittest.TestCase):
    """Client libraries of others, unchanged."""

    def start(self):
        """A simulator, and a page at which more can be used."""
        Simulator(self, '_map:=field')
        self.addCleanup(rospy.delete_param, '/lesson')
        return str(Page(self, *ALLOWED).port)

    @unittest.skipUnless(importlib.util.find_spec('roslibpy'), 'roslibpy is not installed: pip install roslibpy')
    def test_roslibpy_talks_listens_and_calls(self):
        output = printed_by(self, sys.executable, '-c', PYTHON_CLIENT, self.start())
        self.assertEqual(
            output.strip(), "Hello World! True nav_msgs/OccupancyGrid [1, 'x'] True True "
                            "{'success': True, 'message': 'paused'}")

    @unittest.skipUnless(shutil.which('node') and NODE_FOLDER and os.path.isdir(f'{NODE_FOLDER}/node_modules/roslib'),
                         'roslib is not installed: npm install roslib, and its node_modules in NODE_PATH')
    def test_roslib_talks_listens_and_calls(self):
        output = printed_by(self, 'node', '--input-type=module', '-e', NODE_CLIENT, self.start(), folder=NODE_FOLDER)
        self.assertEqual(output.strip(), "Hello World! true true true [ 1, 'x' ] true paused")


@unittest.skipUnless(HAS_BROWSER, 'needs chromium, chromium-driver and python3-selenium')
class BrowserTest(unittest.TestCase):
    """Chromium."""

    def check_pixels(self, simulator, browser):
        """Check that the robot is drawn where it is; the map is a square, and lies in the middle of the floor.

        Returns:
            The scale of the map [pixels/m].
        """
        seen = []
        for x, y in ((MIDDLE, MIDDLE), (MIDDLE + 3.0, MIDDLE + 1.0)):
            simulator.teleport(x, y, 0.0)
            browser.wait_for('position', f'^{x:.2f}, {y:.2f} m$')
            seen.append(wait(self, browser.robot_at_rest, 'the robot on the floor'))
        (x, y), (to_x, to_y) = seen
        scale = (to_x - x) / 3.0
        self.assertGreater(scale * 2 * MIDDLE, 0.8 * min(browser.floor_size()))
        self.assertAlmostEqual(x, browser.floor_size()[0] / 2, delta=2.0)
        self.assertAlmostEqual(to_y - y, -scale, delta=2.0)  # up on the screen
        return scale

    def check_restarts(self, simulator, page, browser):
        """Restart the page and the simulator under an open browser; the new simulator leaves the map to the robot."""
        page.end()
        browser.wait_for('waiting', '^Connecting to ')
        Page(self, port=page.port)
        browser.wait_for('waiting', '^$')
        simulator.end()
        browser.wait_for('waiting', '^Waiting for a simulator|^There is no robot')
        Simulator(self, '_map:=field', '_localisation:=slam')
        browser.wait_for('waiting', '^$')

    def check_own_map(self, browser, scale):
        """Check that the floor is faint but for the 2 m by 2 m around the robot that its own map shows."""
        poses = rospy.Publisher('/rumba/amcl_pose', PoseWithCovarianceStamped, queue_size=1)
        maps = rospy.Publisher('/map', OccupancyGrid, queue_size=1, latch=True)
        wait(self, poses.get_num_connections, 'the simulator to listen')
        here = PoseWithCovarianceStamped(header=Heard(self, '/rumba/ground_truth').fresh().header)
        here.pose.pose.orientation.w = 1.0  # the robot is in the origin of its map
        poses.publish(here)
        own = OccupancyGrid(info=MapMetaData(resolution=0.5, width=4, height=4), data=16 * [0])
        own.info.origin.position.x = own.info.origin.position.y = -1.0
        maps.publish(own)
        x, y = wait(self, browser.robot_at_rest, 'the robot on the floor')

        def off(side, colour):
            seen = browser.colour_at(x + side * scale, y - side * scale)
            return max(abs(a - b) for a, b in zip(seen, colour))
        wait(self, lambda: max(off(0.8, DIRTY), off(1.2, UNMAPPED)) <= 3, 'floor on the map, and floor that is not')
        self.assertTrue(browser.element('unmapped').is_displayed())

    def test_a_desk_shows_the_robot_where_it_is_drives_it_by_keys_and_survives_restarts(self):
        from selenium.webdriver.common.action_chains import ActionChains
        from selenium.webdriver.common.keys import Keys
        simulator, page = Simulator(self, '_map:=field'), Page(self)
        browser = Browser(self, page, DESK)
        browser.wait_for('waiting', '^$')
        self.assertFalse(browser.element('unmapped').is_displayed())
        scale = self.check_pixels(simulator, browser)
        self.check_restarts(simulator, page, browser)
        self.check_own_map(browser, scale)
        truth = Heard(self, '/rumba/ground_truth')
        ActionChains(browser.driver).key_down(Keys.ARROW_UP).perform()
        truth.find(lambda message: message.twist.twist.linear.x > 0.25)
        ActionChains(browser.driver).key_up(Keys.ARROW_UP).perform()
        truth.fresh(lambda message: message.twist.twist.linear.x == 0.0)
        self.assertEqual(browser.errors(), [])

    def test_a_phone_drives_by_touch_pauses_and_fits_its_screen(self):
        Simulator(self, '_map:=field')
        browser = Browser(self, Page(self), PHONE)
        browser.wait_for('waiting', '^$')
        self.assertLessEqual(browser.driver.execute_script('return document.documentElement.scrollWidth'), PHONE[0])
        truth = Heard(self, '/rumba/ground_truth')
        browser.touch('touchStart', 'left')
        truth.find(lambda message: message.twist.twist.angular.z > 1.0)
        browser.touch('touchEnd', 'left')
        truth.fresh(lambda message: message.twist.twist.angular.z == 0.0)
        browser.driver.find_element('css selector', 'summary').click()
        browser.element('pause').click()
        browser.wait_for('pause', '^Resume time$')
        self.assertEqual(browser.unlabelled(), [])
        self.assertEqual(browser.errors(), [])

    def test_a_pupil_finds_the_own_robot_and_reads_what_cannot_be_done(self):
        Simulator(self, '_map:=field', '_robots:=2')
        page = Page(self, '_token:=teacher', '_robot_tokens:=rumba:blue,rumba2:green')
        browser = Browser(self, page, DESK, '#token=green')
        browser.wait_for('rights', '^You may drive rumba2.$')
        browser.wait_for('waiting', '^$')
        self.assertEqual(browser.element('robots').get_attribute('value'), '/rumba2')
        self.assertTrue(browser.element('forward').is_enabled())
        for name, why in (('clean', 'no cleaner is running'), ('pause', 'needs the token of the whole page')):
            self.assertEqual((browser.element(name).is_enabled(), browser.element(name).get_attribute('title')),
                             (False, why))
        browser.driver.execute_script(
            'const list = document.getElementById("robots"); list.value = "/rumba"; list.onchange()')
        forward = browser.element('forward')
        wait(self, lambda: forward.get_attribute('title') == 'needs the token of rumba', 'the reason')
        self.assertFalse(forward.is_enabled())
        self.assertEqual(browser.errors(), [])

    def test_carpet_cliffs_and_dock_of_the_map_are_drawn_and_in_the_key(self):
        Simulator(self, '_map:=apartment')
        browser = Browser(self, Page(self), DESK)
        browser.wait_for('waiting', '^$')
        for name in ('carpet-key', 'cliff-key', 'dock-key'):
            wait(self, browser.element(name).is_displayed, name)
        self.assertEqual(browser.errors(), [])

    def test_a_refusal_is_seen_and_read_out_wherever_the_page_is_scrolled_to(self):
        Simulator(self, '_map:=field')
        browser = Browser(self, Page(self), PHONE)
        browser.wait_for('waiting', '^$')
        for place in (0, 10_000):
            browser.driver.execute_script(
                f'scrollTo(0, {place});'
                'document.getElementById("go").dispatchEvent(new Event("submit", {cancelable: true}))')
            browser.wait_for('notice', '^Give x and y in metres')
            self.assertEqual(browser.element('notice').get_attribute('role'), 'alert')
            self.assertTrue(browser.driver.execute_script(
                'const {top, bottom} = document.getElementById("notice").getBoundingClientRect();'
                'return top >= 0 && bottom <= innerHeight && bottom > top'))


if __name__ == '__main__':
    rospy.init_node('test_page', disable_rostime=True)
    rostest.rosrun('rumba_viewer', 'page', '__main__')
