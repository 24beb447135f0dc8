// Paints the floor with its robots onto a canvas.

import {laidOver, onFloor} from './own_map.js';

const MARGIN = 16;  // [CSS pixels] around the map
const BODY = 0.175;  // [m] radius of a robot
const BUMPER = 65 * Math.PI / 180;  // [rad] to each side of the front that the bumper covers
const DOCK = 0.3;  // [m] width of a dock
const LINE = 2;  // [CSS pixels] width of paths: thinner ones are nowhere as dark as their colour
const SMALLEST = 7;  // [pixels] radius at which a robot is drawn, at least
const STRIPES = 0.12;  // [m] from one stripe of a colour to the next, along an axis
const WALL = 65;  // [%] from this probability on a cell is a wall
const DOTS = 0.15;  // [m] from one dot of a carpet to the next
const FAINT = 0.72;  // share of the background in the colour of what the robot's own map does not show
export const ROBOT_COLOURS = ['#1f6fd6', '#d9580d', '#7a43c4', '#00857c', '#b3266e', '#7a6a00'];

export class Floor {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d');
    this.cells = document.createElement('canvas');
    this.map = null;
    this.painted = this.known = null;
    this.foot = 0;  // [CSS pixels] at the lower edge that the map leaves free
    this.readColours();
  }

  readColours() {
    const style = getComputedStyle(document.documentElement);
    this.colour = name => style.getPropertyValue(`--${name}`).trim();
    this.painted = null;
  }

  // Keep the size of the canvas that of the screen; returns whether it has changed.
  resize() {
    const {clientWidth, clientHeight} = this.canvas, ratio = window.devicePixelRatio || 1;
    const [width, height] = [Math.round(clientWidth * ratio), Math.round(clientHeight * ratio)];
    if (this.canvas.width === width && this.canvas.height === height) return false;
    Object.assign(this.canvas, {width, height});
    return true;
  }

  // Where the map lies on the canvas.
  view() {
    const {info} = this.map, ratio = window.devicePixelRatio || 1, margin = MARGIN * ratio, foot = this.foot * ratio;
    const width = info.width * info.resolution, height = info.height * info.resolution;
    const scale = Math.min((this.canvas.width - 2 * margin) / width, (this.canvas.height - margin - foot) / height);
    return {scale, left: (this.canvas.width - scale * width) / 2, ratio, height: scale * height,
      top: (this.canvas.height - foot + margin - scale * height) / 2, x: info.origin.position.x, y: info.origin.position.y};
  }

  toPixel(view, x, y) {
    return [view.left + (x - view.x) * view.scale, view.top + view.height - (y - view.y) * view.scale];
  }

  // The point [m] at a place on the screen [CSS pixels from the corner of the canvas].
  toPoint(left, top) {
    if (!this.map) return null;
    const view = this.view();
    return {x: view.x + (left * view.ratio - view.left) / view.scale,
      y: view.y + (view.top + view.height - top * view.ratio) / view.scale};
  }

  // One pixel for each cell.
  paintCells(coverage, known, layers) {
    const {info, data} = this.map, {width, height} = info;
    const same = coverage && coverage.data.length === data.length ? coverage.data : null;
    Object.assign(this.cells, {width, height});
    const context = this.cells.getContext('2d'), image = context.createImageData(width, height);
    const pixels = new Uint32Array(image.data.buffer);
    const [background, toSweep, swept, ...others] =
      ['background', 'to-sweep', 'swept', 'unknown', 'wall', 'out-of-reach', 'stripe', 'cliff', 'drop', 'carpet'].map(
        name => packed(this.colour(name)));
    const colours = [...Array.from({length: 101}, (_, share) => mixed(toSweep, swept, share / 100)), ...others];
    const faint = colours.map(colour => mixed(colour, background, FAINT));
    const [carpet, cliff] = layers.width === width && layers.height === height ? [layers.carpet, layers.cliff] : [];
    const [unknown, wall, outOfReach, stripe, bright, drop, dot] = [101, 102, 103, 104, 105, 106, 107];
    const apart = Math.max(Math.round(DOTS / info.resolution), 2);
    for (let row = 0, at = 0; row < height; row++) {
      let to = (height - 1 - row) * width;
      for (let column = 0; column < width; column++, at++, to++) {
        const isFirst = (row + column) * info.resolution % STRIPES < STRIPES / 2;
        let colour = 100;
        if (data[at] < 0) colour = unknown;
        else if (data[at] >= WALL) colour = wall;
        else if (cliff?.[at]) colour = isFirst ? bright : drop;
        else if (carpet?.[at] && row % apart === 0 && column % apart === 0) colour = dot;
        else if (same && same[at] < 0) colour = isFirst ? outOfReach : stripe;
        else if (same) colour = Math.min(same[at], 100);
        if (!known) pixels[to] = colours[colour];
        else if (known[at] >= WALL) pixels[to] = colours[wall];
        else pixels[to] = (known[at] < 0 || colour === wall ? faint : colours)[colour];
      }
    }
    context.putImageData(image, 0, 0);
  }

  // What the robot's own map shows in each cell of the true one; null if that is shown itself.
  knownCells({hasTrueMap, ownMap, ownFrame}) {
    if (!hasTrueMap) return null;
    const of = [this.map, ownMap, ownFrame];
    if (!this.known || of.some((part, at) => part !== this.known.of[at]))
      this.known = {of, cells: laidOver(ownMap, ownFrame, this.map)};
    return this.known.cells;
  }

  paint(scene, now) {
    const {context, canvas} = this;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = this.colour('background');
    context.fillRect(0, 0, canvas.width, canvas.height);
    if (!this.map) return;
    const coverage = scene.selected?.coverage ?? null, known = this.knownCells(scene);
    if (this.painted?.map !== this.map || this.painted.coverage !== coverage || this.painted.known !== known
        || this.painted.layers !== scene.layers) {
      this.paintCells(coverage, known, scene.layers);
      this.painted = {map: this.map, coverage, known, layers: scene.layers};
    }
    const view = this.view(), {cells} = this;
    context.imageSmoothingEnabled = view.scale * this.map.info.resolution < 3;
    context.drawImage(cells, view.left, view.top, cells.width * this.map.info.resolution * view.scale, view.height);
    for (const dock of scene.docks) this.paintDock(view, dock);
    for (const marker of scene.obstacles) this.paintObstacle(view, marker);
    if (scene.selected && scene.frame) this.paintPlan(view, scene.selected, scene.frame);
    if (scene.selected) this.paintTrail(view, scene.selected);
    if (scene.selected) this.paintLaser(view, scene.selected);
    if (scene.target) this.paintTarget(view, scene.target);
    for (const robot of scene.robots) this.paintRobot(view, robot, robot === scene.selected, robot.shown(now));
  }

  // Before the robot that stands on it.
  paintDock(view, {x, y, theta}) {
    const {context} = this, [column, row] = this.toPixel(view, x, y), unit = Math.max(view.scale, SMALLEST * view.ratio / BODY);
    context.save();
    context.translate(column, row);
    context.rotate(-theta);
    context.fillStyle = this.colour('dock');
    context.strokeStyle = this.colour('body-edge');
    context.lineWidth = view.ratio;
    context.beginPath();
    context.rect(BODY * unit, -DOCK / 2 * unit, BODY / 2 * unit, DOCK * unit);
    context.fill();
    context.stroke();
    context.restore();
  }

  paintObstacle(view, {type, pose, scale}) {
    const [x, y] = this.toPixel(view, pose.position.x, pose.position.y), {context} = this;
    const q = pose.orientation;
    context.save();
    context.translate(x, y);
    context.rotate(-Math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y ** 2 + q.z ** 2)));
    context.fillStyle = this.colour('obstacle');
    const [width, height] = [scale.x * view.scale, scale.y * view.scale];
    context.beginPath();
    if (type === 1) context.rect(-width / 2, -height / 2, width, height);
    else context.ellipse(0, 0, width / 2, height / 2, 0, 0, 2 * Math.PI);
    context.fill();
    context.restore();
  }

  paintPlan(view, robot, frame) {
    const {context} = this;
    context.beginPath();
    for (const point of robot.plan) {
      const {x, y} = onFloor(frame, point);
      context.lineTo(...this.toPixel(view, x, y));
    }
    context.strokeStyle = this.colour(`line-${robot.number}`);
    context.lineWidth = LINE * view.ratio;
    context.setLineDash([3 * view.ratio, 3 * view.ratio]);
    context.stroke();
    context.setLineDash([]);
  }

  paintTrail(view, robot) {
    const {context} = this;
    context.beginPath();
    for (const point of robot.trail) {
      const [x, y] = this.toPixel(view, point.x, point.y);
      if (point.jumped) context.moveTo(x, y);
      else context.lineTo(x, y);
    }
    context.strokeStyle = this.colour(`line-${robot.number}`);
    context.lineWidth = LINE * view.ratio;
    context.stroke();
  }

  paintLaser(view, robot) {
    const {scan} = robot, {context} = this;
    if (!scan) return;
    context.beginPath();
    for (const {x, y} of scan) context.lineTo(...this.toPixel(view, x, y));
    context.closePath();
    context.fillStyle = this.colour('laser');
    context.fill();
    context.strokeStyle = this.colour('laser-edge');
    context.lineWidth = view.ratio;
    context.stroke();
  }

  paintTarget(view, target) {
    const [x, y] = this.toPixel(view, target.x, target.y), {context} = this, size = 8 * view.ratio;
    context.strokeStyle = this.colour('target');
    context.lineWidth = 2.5 * view.ratio;
    context.beginPath();
    context.arc(x, y, size, 0, 2 * Math.PI);
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      context.moveTo(x + dx * size * 0.5, y + dy * size * 0.5);
      context.lineTo(x + dx * size * 1.6, y + dy * size * 1.6);
    }
    context.stroke();
  }

  paintRobot(view, robot, isSelected, pose) {
    if (!pose) return;
    const [x, y] = this.toPixel(view, pose.x, pose.y), {context} = this;
    const radius = Math.max(BODY * view.scale, SMALLEST * view.ratio);
    if (isSelected) {
      context.beginPath();
      context.arc(x, y, radius + 4 * view.ratio, 0, 2 * Math.PI);
      context.lineWidth = 2 * view.ratio;
      context.strokeStyle = robot.colour;
      context.stroke();
    }
    context.save();
    context.translate(x, y);
    context.rotate(-pose.theta);
    context.scale(radius, radius);
    this.paintBody(robot, view.ratio / radius);
    context.restore();
    context.font = `${12 * view.ratio}px system-ui, sans-serif`;
    context.textAlign = 'center';
    context.lineWidth = 3 * view.ratio;
    context.strokeStyle = this.colour('card');
    context.fillStyle = this.colour('text');
    const below = y + radius + 16 * view.ratio;
    context.strokeText(robot.label, x, below);
    context.fillText(robot.label, x, below);
  }

  // Body, bumper, brush and heading of a robot of radius 1 that faces right; `pixel` is the size of one.
  paintBody(robot, pixel) {
    const {context} = this;
    context.beginPath();
    context.arc(0, 0, 1, 0, 2 * Math.PI);
    context.fillStyle = this.colour('body');
    context.fill();
    context.lineWidth = pixel;
    context.strokeStyle = this.colour('body-edge');
    context.stroke();
    context.beginPath();
    context.arc(0, 0, 0.9, -BUMPER, BUMPER);
    context.lineWidth = 0.16;
    context.strokeStyle = robot.colour;
    context.stroke();
    context.beginPath();
    context.rect(-0.2, -0.5, 0.2, 1);
    context.lineWidth = pixel;
    context.strokeStyle = context.fillStyle = this.colour(robot.brushesUp === false ? 'lit' : 'body-edge');
    if (robot.brushesUp === false) context.fill();
    if (robot.brushesUp !== null) context.stroke();
    context.beginPath();
    for (const [ahead, aside] of [[0.7, 0], [0.2, 0.4], [0.2, -0.4]]) context.lineTo(ahead, aside);
    context.fillStyle = robot.colour;
    context.fill();
  }
}

// A colour #rrggbb as a pixel.
function packed(colour) {
  const [red, green, blue] = [1, 3, 5].map(at => parseInt(colour.slice(at, at + 2), 16));
  return (0xff000000 | blue << 16 | green << 8 | red) >>> 0;
}

function mixed(from, to, share) {
  let result = 0xff000000;
  for (const shift of [0, 8, 16]) {
    const [a, b] = [from >>> shift & 255, to >>> shift & 255];
    result |= Math.round(a + share * (b - a)) << shift;
  }
  return result >>> 0;
}
