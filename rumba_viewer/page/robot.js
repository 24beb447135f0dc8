// What is known of one robot, from its topics.

import {Forecast, about} from './forecast.js';
import {outline} from './mounting.js';

const TRAIL = 20000;  // points
const RECENT = 30;  // poses that are kept, to find that of a scan
const NEAR = 0.03;  // [m] between two points of the trail
const STATES = ['Idle', 'Leaving the dock', 'Cleaning', 'Returning to the dock', 'Docking', 'Charging', 'Going to a point',
  'Stranded', 'You are driving'];
const SMALL = {  // topic -> what it changes
  battery_status: (robot, msg) => { robot.brushesUp = msg.brushes_up; },
  battery_state: (robot, msg) => { robot.battery = msg; },
  dock_status: (robot, msg) => robot.learnDock(msg),
  cleaning_status: (robot, msg) => robot.learnCleaning(msg),
  mission_status: (robot, msg) => robot.learnMission(msg),
  plan: (robot, msg) => { robot.plan = msg.poses.map(({pose}) => pose.position); },
};
const RATES = {battery_status: 500, battery_state: 1000, dock_status: 500, cleaning_status: 1000, mission_status: 0, plan: 500};
const COVERAGE = {throttle_rate: 500, compression: 'png'}, SCAN = {throttle_rate: 200};
const OWN_ACCOUNT = /^[\d.]+ % swept(; |$)/;  // what the page measures stands beside it: one figure is enough
const IDLE = 0;  // of rumba_msg/MissionStatus
const SUCCEEDED = 1, REFUSED = 4, INTERRUPTED = [2, 3, 12];  // of rumba_msg/Outcome: cancelled, preempted, robot gone

export class Robot {
  // `name` with its namespace, as in /rumba; `onNews` is called when there is something new to show.
  // `mountings` of lasers, by their frames.
  constructor(link, name, onNews, mountings) {
    Object.assign(this, {link, name, onNews, mountings});
    this.forget();
    link.subscribe(`${name}/ground_truth`, {throttle_rate: 100, newest: true}, msg => this.learnPose(msg));
  }

  forget() {
    Object.assign(this, {pose: null, before: null, came: 0, stamp: null, trail: [], plan: [], recent: [], scan: null,
      arrived: null, coverage: null, battery: null, cleaning: null, mission: null, isDocked: false, dock: null, ended: null,
      brushesUp: null, target: null, forecast: new Forecast()});
  }

  close() {
    this.select(false);
    this.link.unsubscribe(`${this.name}/ground_truth`);
  }

  // Hear all of it, or only where it is.
  select(isSelected) {
    for (const [topic, learn] of Object.entries(SMALL)) {
      const name = `${this.name}/${topic}`;
      if (isSelected) this.hear(name, {throttle_rate: RATES[topic]}, learn);
      else this.link.unsubscribe(name);
    }
    const coverage = `${this.name}/coverage`;
    if (isSelected) this.hear(coverage, COVERAGE, (robot, msg) => { robot.coverage = msg; });
    else {
      this.link.unsubscribe(coverage);
      this.showLaser(false);
      Object.assign(this, {coverage: null, plan: []});
    }
  }

  showLaser(isShown) {
    const scan = `${this.name}/scan`;
    if (isShown) this.hear(scan, SCAN, (robot, msg) => { robot.arrived = msg; robot.placeScan(); });
    else {
      this.link.unsubscribe(scan);
      Object.assign(this, {scan: null, arrived: null});
    }
  }

  hear(topic, options, learn) {
    this.link.subscribe(topic, {...options, newest: true}, msg => { learn(this, msg); this.onNews(this); });
  }

  learnPose(msg) {
    const {position, orientation: q} = msg.pose.pose, stamp = seconds(msg.header.stamp);
    const pose = {x: position.x, y: position.y, theta: Math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y ** 2 + q.z ** 2))};
    if (![pose.x, pose.y, pose.theta].every(Number.isFinite)) return;
    if (this.stamp !== null && stamp < this.stamp) this.forget();  // another simulation has started
    this.recent = [...this.recent.slice(1 - RECENT), {stamp, pose}];
    this.placeScan();
    const now = performance.now(), last = this.trail[this.trail.length - 1];
    const jumped = this.pose && Math.hypot(pose.x - this.pose.x, pose.y - this.pose.y) > 1;
    Object.assign(this, {before: jumped ? null : this.shown(now), pose, came: now, stamp, velocity: msg.twist.twist});
    if (!last || jumped || Math.hypot(pose.x - last.x, pose.y - last.y) > NEAR) {
      this.trail.push({...pose, jumped: Boolean(jumped)});
      if (this.trail.length > TRAIL) this.trail.splice(0, TRAIL / 10);
    }
    this.onNews(this);
  }

  // Put a scan where the robot was when it measured, as soon as a pose of that time or later is known.
  placeScan() {
    const {arrived, recent} = this;
    if (!arrived) return;
    const stamp = seconds(arrived.header.stamp), next = recent.findIndex(one => one.stamp >= stamp);
    if (next < 0) return;
    const [from, to] = [recent[Math.max(next - 1, 0)], recent[next]];
    const share = to.stamp > from.stamp ? Math.min(Math.max((stamp - from.stamp) / (to.stamp - from.stamp), 0), 1) : 1;
    this.scan = outline(between(from.pose, to.pose, share), arrived, this.mountings[arrived.header.frame_id]);
    this.arrived = null;
  }

  learnCleaning(msg) {
    if (this.cleaning && msg.distance < this.cleaning.distance) this.trail = [];  // a reset
    this.cleaning = msg;
    if (this.mission)
      this.forecast.add({...msg, time: seconds(msg.header.stamp)}, this.battery?.percentage ?? NaN, this.mission);
  }

  learnDock(msg) {
    this.isDocked = msg.is_docked;
    if (this.isDocked && this.pose) this.dock = this.pose;
  }

  learnMission(msg) {
    this.mission = msg;
    if (this.isCleaning) this.ended = null;
  }

  // How a task ended, and a line that says so; a cleaning that was refused never began, and leaves the last one as it is.
  learnResult(action, {code, message}) {
    if (action === 'go_to') this.target = null;
    if (action === 'clean' && code !== REFUSED) this.ended = {code, message};
    return action === 'clean' && INTERRUPTED.includes(code) ? 'cleaning is paused' : message;
  }

  // Where to draw it: it glides from one pose to the next.
  shown(now) {
    if (!this.before || !this.pose) return this.pose;
    return between(this.before, this.pose, Math.min((now - this.came) / 110, 1));
  }

  isGliding(now) {
    return Boolean(this.before) && now - this.came < 120;
  }

  // Whether a cleaning is under way, with its charging.
  get isCleaning() {
    return this.mission !== null && this.mission.state !== IDLE && this.mission.strategy !== '';
  }

  get canResume() {
    return !this.isCleaning && INTERRUPTED.includes(this.ended?.code);
  }

  // A word or two, for a person.
  get state() {
    if (!this.mission) return this.isCharging ? 'Charging' : this.isDocked ? 'On the dock' : 'No cleaner is running';
    if (this.mission.state !== IDLE) return STATES[this.mission.state] ?? 'Unknown';
    if (this.canResume) return 'Paused';
    if (this.ended) return this.ended.code === SUCCEEDED ? 'Done' : 'Not finished';
    return this.isCharging ? 'Charging' : STATES[IDLE];
  }

  // A line about it.
  get detail() {
    if (this.canResume) return 'Resume continues the cleaning';
    if (this.mission?.state === IDLE && this.ended) return this.ended.message;
    return (this.mission?.message ?? '').replace(OWN_ACCOUNT, '');
  }

  // How long its cleaning still takes, in words; empty if that is not known.
  get timeLeft() {
    const left = this.isCleaning ? this.forecast.left : null;
    return left === null ? '' : about(left);
  }

  get isCharging() {
    return this.battery?.power_supply_status === 1;
  }
}

// Whether a task ended otherwise than somebody wanted.
export function isFailure(code) {
  return code !== SUCCEEDED && !INTERRUPTED.includes(code);
}

function seconds({secs, nsecs}) {
  return secs + nsecs * 1e-9;
}

// A pose between two others.
function between(from, to, share) {
  const turn = to.theta - from.theta;
  return {x: from.x + share * (to.x - from.x), y: from.y + share * (to.y - from.y),
    theta: from.theta + share * Math.atan2(Math.sin(turn), Math.cos(turn))};
}
