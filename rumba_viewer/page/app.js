// The page: joins the connection, the scene, the picture and the controls.

import {Driving} from './driving.js';
import {Floor} from './floor.js';
import {Link} from './link.js';
import {onMap} from './own_map.js';
import {ACTIONS, Scene} from './scene.js';

const NOTICE = 8000;  // [ms] for which a line is shown
const SURE = 4000;  // [ms] within which Reset must be pressed again
const DESCRIBED = 3000;  // [ms] between two descriptions of the picture for screen readers

const at = id => document.getElementById(id);
let token = new URLSearchParams(location.hash.slice(1)).get('token') ?? sessionStorage.token ?? '';
if (token) sessionStorage.token = token;
history.replaceState(null, '', location.pathname);  // nobody should read the token over a shoulder

const floor = new Floor(at('floor'));
let isDirty = true, noticeTimer = null, sureTimer = null, described = 0;

const link = new Link(() => {
  const scheme = location.protocol === 'https:' ? 'wss' : 'ws';
  return `${scheme}://${location.host}/${token ? `?token=${encodeURIComponent(token)}` : ''}`;
}, onConnection, onStatus);
const scene = new Scene(link, news, notice);
const driving = new Driving(document.querySelectorAll('#drive button'), drive);

function news() {
  isDirty = true;
}

function onConnection(isOpen) {
  if (isOpen) {
    scene.learnRights();
    scene.look();
  } else {
    driving.stop();
    at('notice').textContent = '';  // what it waits for stands there
  }
  news();
}

function notice(line, isGood = false) {
  at('notice').textContent = line;
  at('notice').classList.toggle('good', isGood);
  clearTimeout(noticeTimer);
  noticeTimer = setTimeout(() => { at('notice').textContent = ''; }, NOTICE);
}

function onStatus(line) {
  notice(line);
  if (line.startsWith('wrong token')) {
    token = '';
    delete sessionStorage.token;
  }
}

// --- what a person does -----------------------------------------------------------------------------------------------

function drive(v, w) {
  if (scene.selected) link.publish(`${scene.selected.name}/teleop/cmd_vel`, 'geometry_msgs/Twist',
    {linear: {x: v}, angular: {z: w}});
}

function send(action, type, goal) {
  const id = `page-${Date.now()}-${Math.random().toString(36).slice(2)}`;
  if (!link.publish(`${scene.selected.name}/${action}/goal`, `rumba_msg/${type}ActionGoal`, {goal_id: {id}, goal}))
    notice('not connected');
}

function goTo(point) {
  scene.selected.target = point;
  send('go_to', 'GoTo', {target: {...onMap(scene.frame, point), theta: null}});
  news();
}

function choose(event) {
  const box = floor.canvas.getBoundingClientRect();
  const point = floor.toPoint(event.clientX - box.left, event.clientY - box.top);
  if (!point || !scene.selected) return null;
  scene.selected.target = point;
  at('x').value = point.x.toFixed(2);
  at('y').value = point.y.toFixed(2);
  news();
  return point;
}

async function call(service, args) {
  try {
    const answer = await link.call(service.startsWith('/') ? service : `${scene.state.node}/${service}`, args);
    if (answer.message) notice(answer.message, answer.success !== false);
  } catch (error) {
    onStatus(error.message);
  }
}

function cancel(...actions) {
  for (const action of actions) link.publish(`${scene.selected.name}/${action}/cancel`, 'actionlib_msgs/GoalID', {});
}

at('clean').onclick = () => {
  if (scene.selected.isCleaning) cancel('clean');
  else send('clean', 'Clean', {resume: scene.selected.canResume});
};
at('clean-from-start').onclick = () => send('clean', 'Clean', {});
at('home').onclick = () => send('dock', 'Dock', {});
at('undock').onclick = () => send('undock', 'Undock', {});
at('brushes').onclick = () => call(`${scene.selected.name}/set_brushes_up`, {data: !scene.selected.brushesUp});
at('stop').onclick = () => {
  driving.stop();
  cancel(...ACTIONS);
  scene.selected.target = null;
};
at('pause').onclick = () => call(scene.state.is_paused ? 'resume' : 'pause');
at('speed').onchange = () => call('tuning/set_parameters',
  {config: {doubles: [{name: 'speed', value: Number(at('speed').value)}]}});
at('reset').onclick = () => {
  const isSure = at('reset').classList.toggle('sure');
  at('reset').textContent = isSure ? 'Really?' : 'Reset';
  clearTimeout(sureTimer);
  if (isSure) sureTimer = setTimeout(() => at('reset').classList.contains('sure') && unsure(), SURE);
  else call('reset');
};
function unsure() {
  at('reset').classList.remove('sure');
  at('reset').textContent = 'Reset';
}
at('go').onsubmit = event => {
  event.preventDefault();
  const point = {x: at('x').valueAsNumber, y: at('y').valueAsNumber};
  if (Number.isFinite(point.x) && Number.isFinite(point.y)) goTo(point);
  else notice('Give x and y in metres, or click on the floor');
};
at('access').onsubmit = event => {
  event.preventDefault();
  token = sessionStorage.token = at('token').value;
  at('token').value = '';
  at('access').hidden = true;
  link.restart();
};
at('robots').onchange = () => {
  scene.wanted = sessionStorage.robot = at('robots').value;
  scene.select(scene.robots.find(robot => robot.name === scene.wanted));
};
at('laser').onchange = () => {
  localStorage.laser = at('laser').checked ? 'on' : 'off';
  scene.showLaser(at('laser').checked);
};
at('laser').checked = localStorage.laser === 'on';
scene.showLaser(at('laser').checked);
floor.canvas.onclick = choose;
floor.canvas.ondblclick = event => { const point = choose(event); if (point && !whyNoGoing()) goTo(point); };
addEventListener('keydown', event => {
  if (event.key === 'Escape' && !at('stop').disabled) at('stop').click();
});
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { floor.readColours(); news(); });

// --- what it shows ----------------------------------------------------------------------------------------------------

// Why a robot cannot be driven, cannot be sent to clean, or cannot go to a point; empty if it can.
function whyNoDriving() {
  if (!link.isOpen) return 'not connected';
  if (!scene.selected) return 'there is no robot';
  return scene.mayDrive(scene.selected) ? '' : `needs the token of ${scene.selected.label}`;
}

function whyNoCleaning() {
  return whyNoDriving() || (scene.selected.mission ? '' : 'no cleaner is running');
}

function whyNoGoing() {
  return whyNoCleaning() || (scene.frame ? '' : 'it is not known where the map of the robot lies');
}

function whyNoTime() {
  if (!link.isOpen) return 'not connected';
  if (!scene.hasSimulator) return 'there is no simulator';
  return scene.mayChangeAll ? '' : 'needs the token of the whole page';
}

function text(id, value) {
  if (at(id).textContent !== value) at(id).textContent = value;
}

function meter(id, share, words) {
  at(id).value = share ?? 0;
  text(`${id}-text`, words);
}

function duration(seconds) {
  const whole = Math.floor(seconds), two = number => String(number).padStart(2, '0');
  return `${Math.floor(whole / 3600)}:${two(Math.floor(whole / 60) % 60)}:${two(whole % 60)}`;
}

function fixed(number, digits, unit) {
  return Number.isFinite(number) ? `${number.toFixed(digits)} ${unit}` : '–';
}

function showRobot(robot) {
  const {cleaning, battery, pose} = robot ?? {};
  text('state', !link.isOpen ? 'Not connected' : robot?.state ?? '–');
  text('detail', link.isOpen && robot ? robot.detail : '');
  at('status').classList.toggle('stale', !link.isOpen || !scene.hasSimulator);
  const swept = cleaning ? 100 * cleaning.coverage : null;
  meter('coverage', swept, swept === null ? '–' : `${swept.toFixed(1)} %`);
  const charge = battery && battery.percentage !== null ? 100 * battery.percentage : null;
  meter('battery', charge, charge === null ? '–' : `${robot.isCharging ? '⚡ ' : ''}${charge.toFixed(0)} %`);
  at('battery').classList.toggle('low', charge !== null && charge < 15);
  at('battery').title = robot?.isCharging ? 'charging' : '';
  text('position', pose ? `${pose.x.toFixed(2)}, ${pose.y.toFixed(2)} m` : '–');
  text('distance', fixed(cleaning?.distance, 1, 'm'));
  text('area', cleaning ? `${cleaning.cleaned_area.toFixed(1)} of ${cleaning.reachable_area.toFixed(1)} m²` : '–');
  text('left-over', robot?.timeLeft || '–');
  text('time', Number.isFinite(robot?.stamp) && scene.state?.is_time_simulated ? duration(robot.stamp) : 'real time');
}

function enable(why, ...names) {
  for (const name of names) Object.assign(at(name), {disabled: Boolean(why), title: why});
}

function showControls() {
  const {state, selected} = scene, isCleaning = Boolean(selected?.isCleaning), canResume = Boolean(selected?.canResume);
  text('clean', isCleaning ? 'Pause' : canResume ? 'Resume' : 'Clean');
  text('brushes', selected?.brushesUp ? 'Brushes down' : 'Brushes up');
  text('pause', state?.is_paused ? 'Resume time' : 'Pause time');
  enable(whyNoCleaning(), 'clean', 'stop');
  enable(whyNoCleaning() || (selected.isDocked ? 'the robot is on its dock' : ''), 'home');
  enable(whyNoCleaning() || (selected.isDocked ? '' : 'the robot is not on its dock'), 'undock');
  enable(whyNoCleaning() || (canResume ? '' : 'there is nothing to resume: press Clean'), 'clean-from-start');
  enable(whyNoGoing(), 'go-to', 'x', 'y');
  enable(whyNoDriving() || (selected.brushesUp === null ? 'the robot tells nothing of its brushes' : ''), 'brushes');
  enable(whyNoDriving(), 'forward', 'left', 'back', 'right');
  enable(whyNoTime(), 'pause', 'reset', 'speed');
  if (document.activeElement !== at('speed') && Number.isFinite(state?.speed)) showSpeed(state.speed);
}

function showRights() {
  const robots = scene.rights?.robots ?? [], isWatching = Boolean(scene.rights) && !scene.mayChangeAll && !robots.length;
  const names = robots.map(name => name.split('/').pop()).join(', ');
  text('rights', isWatching ? 'You are watching. A token lets you drive.' : names && `You may drive ${names}.`);
  at('access').hidden = !isWatching;
}

function showSpeed(speed) {
  const list = at('speed');
  if (![...list.options].some(option => Number(option.value) === speed)) list.add(new Option(`${speed} ×`, speed));
  list.value = String(speed);
}

function showRobots() {
  const list = at('robots'), names = scene.robots.map(robot => robot.name);
  if (names.join() !== [...list.options].map(option => option.value).join())
    list.replaceChildren(...scene.robots.map(robot => new Option(robot.label, robot.name)));
  list.value = scene.selected?.name ?? '';
  at('chooser').hidden = names.length < 2;
}

function describe(now) {
  if (now - described < DESCRIBED) return;
  described = now;
  const places = scene.robots.filter(robot => robot.pose).map(
    robot => `${robot.label} at ${robot.pose.x.toFixed(1)}, ${robot.pose.y.toFixed(1)} metres, ${robot.state}`);
  floor.canvas.setAttribute('aria-label', `Floor plan. ${places.join('; ') || scene.missing}`);
}

function frame(now) {
  const hasNewSize = floor.resize();
  if (isDirty || hasNewSize || scene.robots.some(robot => robot.isGliding(now))) {
    isDirty = false;
    floor.map = scene.map;
    floor.foot = at('legend').offsetHeight;
    floor.paint(scene, now);
    at('stage').classList.toggle('has-map', Boolean(scene.map));
    at('unmapped').hidden = !scene.hasTrueMap;
    text('waiting', scene.missing);
    showRobots();
    showRobot(scene.selected);
    showControls();
    showRights();
    at('dock-key').hidden = !scene.docks.length;
    at('carpet-key').hidden = !scene.layers.carpet;
    at('cliff-key').hidden = !scene.layers.cliff;
    describe(now);
  }
  requestAnimationFrame(frame);
}
requestAnimationFrame(frame);
