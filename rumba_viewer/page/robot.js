// What is known of one robot, from its topics.

import {outline} from './mounting.js';

const TRAIL = 20000;  // points
const RECENT = 30;  // poses that are kept, to find that of a scan
const NEAR = 0.03;  // [m] between two points of the trail
const STATES = ['Idle', 'Leaving the dock', 'Cleaning', 'Returning to the dock', 'Docking', 'Charging', 'Going to a point',
  'Stranded', 'You are driving'];
const SMALL = {  // topic -> what it changes
  battery_status: (robot, msg) => { robot.brushesUp = msg.brushes_up; },
  battery_state: (robot, msg) => { robot.battery = msg; },
  dock_status: (robot, msg) => { robot.isDocked = msg.is_docked; },
  cleaning_status: (robot, msg) => robot.learnCleaning(msg),
  mission_status: (robot, msg) => { robot.mission = msg; },
  plan: (robot, msg) => { robot.plan = msg.poses.map(({pose}) => pose.position); },
};
const RATES = {battery_status: 500, battery_state: 1000, dock_status: 500, cleaning_status: 1000, mission_status: 0, plan: 500};
const LARGE = {scan: {throttle_rate: 200}, coverage: {throttle_rate: 500, compression: 'png'}};
const LEARN = {
  coverage: (robot, msg) => { robot.coverage = msg; },
  scan: (robot, msg) => { robot.arrived = msg; robot.placeScan(); },
};

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
      arrived: null, coverage: null, battery: null, cleaning: null, mission: null, isDocked: false, brushesUp: null, target: null});
  }

  close() {
    this.select(false);
    this.link.unsubscribe(`${this.name}/ground_truth`);
  }

  // Hear all of it, or only where it is.
  select(isSelected) {
    for (const [topic, learn] of Object.entries(SMALL)) {
      const name = `${this.name}/${topic}`;
      if (isSelected) this.hear(name, {throttle_rate: RATES[topic], newest: true}, learn);
      else this.link.unsubscribe(name);
    }
    for (const [topic, options] of Object.entries(LARGE)) {
      const name = `${this.name}/${topic}`;
      if (isSelected) this.hear(name, {...options, newest: true}, LEARN[topic]);
      else this.link.unsubscribe(name);
    }
    if (!isSelected) Object.assign(this, {scan: null, arrived: null, coverage: null, plan: []});
  }

  hear(topic, options, learn) {
    this.link.subscribe(topic, options, msg => { learn(this, msg); this.onNews(this); });
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
  }

  // Where to draw it: it glides from one pose to the next.
  shown(now) {
    if (!this.before || !this.pose) return this.pose;
    return between(this.before, this.pose, Math.min((now - this.came) / 110, 1));
  }

  isGliding(now) {
    return Boolean(this.before) && now - this.came < 120;
  }

  get state() {
    if (this.mission) return STATES[this.mission.state] ?? 'Unknown';
    return this.isDocked ? 'On the dock' : 'No cleaner is running';
  }

  get isCharging() {
    return this.battery?.power_supply_status === 1;
  }
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
