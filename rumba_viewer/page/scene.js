// What there is to show: the map, the simulator and the robots that the master knows.

import {ROBOT_COLOURS} from './floor.js';
import {NO_LAYERS, layersOf} from './layers.js';
import {mountingsIn} from './mounting.js';
import {SAME, frameIn} from './own_map.js';
import {Robot, isFailure} from './robot.js';

const LOOK = 2000;  // [ms] between two looks for robots
const SILENCE = 4000;  // [ms] after which a silent simulator counts as gone
export const ACTIONS = ['clean', 'dock', 'undock', 'go_to'];
const TRUTH = '/ground_truth', TRUE_MAP = 'simulator/map';

export class Scene {
  // `onNews` is called when there is something new to show, `onResult` with the line at the end of a task and whether it is
  // as somebody wanted.
  constructor(link, onNews, onResult) {
    Object.assign(this, {link, onNews, onResult, ownMap: null, trueMap: null, ownFrame: null, isTrueMapTold: false,
      mountings: {}, state: null, heard: 0, robots: [], selected: null, markers: new Map(), trouble: '',
      wanted: sessionStorage.robot, rights: null, showsLaser: false, layers: NO_LAYERS, layersFor: ''});
    link.subscribe('/map', {compression: 'png', queue_length: 1}, msg => { this.ownMap = msg; onNews(); });
    link.subscribe(TRUE_MAP, {compression: 'png', queue_length: 1}, msg => { this.trueMap = msg; onNews(); });
    link.subscribe('/tf_static', {}, msg => {
      this.ownFrame = frameIn(msg) ?? this.ownFrame;
      Object.assign(this.mountings, mountingsIn(msg));
      onNews();
    });
    link.subscribe('simulator/state', {}, msg => this.learnState(msg));
    link.subscribe('simulator/obstacles', {throttle_rate: 200, newest: true}, msg => this.learnObstacles(msg));
    setInterval(() => this.look(), LOOK);
    setInterval(onNews, 1000);  // silence is news too
  }

  // The map of the floor: the true one, as long as a simulator tells it.
  get map() {
    return this.hasTrueMap ? this.trueMap : this.ownMap;
  }

  get hasTrueMap() {
    return this.isTrueMapTold && this.trueMap !== null;
  }

  // Where the map by which robots work is on the floor; null if that is unknown.
  get frame() {
    return this.hasTrueMap ? this.ownFrame : SAME;
  }

  get obstacles() {
    return [...this.markers.values()];
  }

  get target() {
    return this.selected?.target ?? null;
  }

  get hasSimulator() {
    return this.state !== null && performance.now() - this.heard < SILENCE;
  }

  learnState(msg) {
    if (this.state && msg.run !== this.state.run) for (const robot of this.robots) robot.forget();
    if (this.state && msg.run === this.state.run && msg.resets !== this.state.resets)
      for (const robot of this.robots) Object.assign(robot, {trail: [], target: null});
    const isNew = !this.hasSimulator;
    Object.assign(this, {state: msg, heard: performance.now()});
    if (isNew) this.look();
    if (msg.run !== this.layersFor) this.learnLayers(msg.run);
    this.onNews();
  }

  // What the files of the simulator's map contain; nothing if they cannot be read where the page's server runs.
  async learnLayers(run) {
    Object.assign(this, {layersFor: run, layers: NO_LAYERS});
    try {
      this.layers = layersOf(await this.link.call('/rosapi/floor'));
    } catch {
      return;
    }
    this.onNews();
  }

  // Docks of the map, or else where robots have stood on one.
  get docks() {
    return this.layers.docks.length ? this.layers.docks : this.robots.filter(robot => robot.dock).map(robot => robot.dock);
  }

  learnObstacles(msg) {
    for (const marker of msg.markers) {
      if (marker.action === 3) this.markers.clear();
      else if (marker.action === 2) this.markers.delete(`${marker.ns}/${marker.id}`);
      else if ([1, 2, 3].includes(marker.type)) this.markers.set(`${marker.ns}/${marker.id}`, marker);
    }
    this.onNews();
  }

  // Ask what this client may change; whoever may drive one robot has it selected at first.
  async learnRights() {
    this.rights = null;
    try {
      this.rights = await this.link.call('/rosapi/rights');
    } catch {
      return;  // not connected any more
    }
    this.wanted ??= this.rights.robots[0];
    const mine = this.robots.find(robot => robot.name === this.wanted);
    if (mine) this.select(mine);
    this.onNews();
  }

  // Whether this client may drive a robot and send it goals.
  mayDrive(robot) {
    return Boolean(this.rights) && (this.rights.everything || this.rights.robots.includes(robot?.name));
  }

  get mayChangeAll() {
    return Boolean(this.rights?.everything);
  }

  showLaser(isShown) {
    this.showsLaser = isShown;
    this.selected?.showLaser(isShown);
    this.onNews();
  }

  // Ask which robots there are, and whether a simulator tells the true map.
  async look() {
    if (!this.link.isOpen) return;
    try {
      const [grids, odometries] = await Promise.all(['nav_msgs/OccupancyGrid', 'nav_msgs/Odometry'].map(
        type => this.link.call('/rosapi/topics_for_type', {type})));
      this.trouble = '';
      this.isTrueMapTold = grids.topics.some(name => name.endsWith(`/${TRUE_MAP}`));
      this.learnRobots(odometries.topics.filter(name => name.endsWith(TRUTH)).map(name => name.slice(0, -TRUTH.length)));
    } catch (error) {
      this.trouble = error.message.replace(/^\/rosapi\/\w+: /, '');
    }
    this.onNews();
  }

  learnRobots(names) {
    names.sort((one, other) => one.length - other.length || (one < other ? -1 : 1));
    const before = new Map(this.robots.map(robot => [robot.name, robot]));
    this.robots = names.map(name => before.get(name) ?? new Robot(this.link, name, this.onNews, this.mountings));
    this.robots.forEach((robot, number) => {
      robot.label = robot.name.split('/').pop();
      robot.number = number % ROBOT_COLOURS.length;
      robot.colour = ROBOT_COLOURS[robot.number];
    });
    for (const [name, robot] of before) if (!names.includes(name)) robot.close();
    if (!this.robots.includes(this.selected))
      this.select(this.robots.find(robot => robot.name === this.wanted) ?? this.robots[0] ?? null);
  }

  select(robot) {
    if (robot === this.selected) return;
    if (this.selected) {
      for (const action of ACTIONS) this.link.unsubscribe(`${this.selected.name}/${action}/result`);
      this.selected.select(false);
    }
    this.selected = robot;
    if (robot) {
      robot.select(true);
      robot.showLaser(this.showsLaser);
      for (const action of ACTIONS)
        this.link.subscribe(`${robot.name}/${action}/result`, {queue_length: 5}, msg => {
          const {outcome} = msg.result;
          this.onResult(`${robot.label}: ${robot.learnResult(action, outcome)}`, !isFailure(outcome.code));
        });
    }
    this.onNews();
  }

  // What it waits for, in one line; empty if all is there.
  get missing() {
    if (!this.link.isOpen) return `Connecting to ${location.host}. On that machine runs: rosrun rumba_viewer page`;
    if (this.trouble) return `Waiting for ROS: ${this.trouble}`;
    if (!this.hasSimulator) return 'Waiting for a simulator. To start one: roslaunch rumba_sim simulator.launch';
    if (!this.map) return 'Waiting for a map: no message of /map has come';
    if (!this.robots.length) return 'There is no robot. To add one: rosservice call /simulator/spawn "{}"';
    if (!this.selected.pose)
      return `Waiting for a pose of ${this.selected.label}${this.state.is_paused ? ': time is paused' : ''}`;
    return '';
  }
}
