// Where lasers are mounted on their robots.

const CENTRE = {x: 0, y: 0, theta: 0, side: 1};
const LASER = /(^|\/)laser$/;  // names of frames

// Mountings by their frames, as a message of /tf_static tells them: poses on the robot, and -1 as side if upside down.
export function mountingsIn({transforms}) {
  const found = {};
  for (const {child_frame_id: frame, transform: {translation: {x, y}, rotation: q}} of transforms) {
    const theta = Math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y ** 2 + q.z ** 2));
    if (LASER.test(frame) && [x, y, theta].every(Number.isFinite))
      found[frame] = {x, y, theta, side: q.x ** 2 + q.y ** 2 > 0.5 ? -1 : 1};
  }
  return found;
}

// The outline of what a laser of a robot at a pose sees: the ends of its beams, and the laser itself if there is a gap.
export function outline(robot, scan, mounting = CENTRE) {
  const cos = Math.cos(robot.theta), sin = Math.sin(robot.theta), theta = robot.theta + mounting.theta;
  const x = robot.x + cos * mounting.x - sin * mounting.y, y = robot.y + sin * mounting.x + cos * mounting.y;
  const ends = scan.ranges.map((range, number) => {
    const length = range === null ? scan.range_max : range;
    const angle = theta + mounting.side * (scan.angle_min + number * scan.angle_increment);
    return {x: x + length * Math.cos(angle), y: y + length * Math.sin(angle)};
  });
  const isRound = Math.abs((ends.length + 0.5) * scan.angle_increment) > 2 * Math.PI;
  return isRound ? ends : [...ends, {x, y}];
}
