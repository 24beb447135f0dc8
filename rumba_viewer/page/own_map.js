// The map that a robot makes, over the true one. Its frame is another: a pose says where that is on the floor.

export const SAME = {x: 0, y: 0, theta: 0};
const WALL = 100;

// A point of the map on the floor.
export function onFloor(frame, {x, y}) {
  const cos = Math.cos(frame.theta), sin = Math.sin(frame.theta);
  return {x: frame.x + cos * x - sin * y, y: frame.y + sin * x + cos * y};
}

// A point of the floor on the map.
export function onMap(frame, {x, y}) {
  const cos = Math.cos(frame.theta), sin = Math.sin(frame.theta), right = x - frame.x, up = y - frame.y;
  return {x: cos * right + sin * up, y: cos * up - sin * right};
}

// Where the map is on the floor, if a message of /tf_static tells it; else null.
export function frameIn({transforms}) {
  const link = transforms.find(one => one.header.frame_id === 'world' && one.child_frame_id === 'map');
  if (!link) return null;
  const {translation: {x, y}, rotation: q} = link.transform;
  const frame = {x, y, theta: Math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y ** 2 + q.z ** 2))};
  return Object.values(frame).every(Number.isFinite) ? frame : null;
}

// What the map shows at the centres of the cells of another, -1 beside it. A wall is also in the cell that has its
// centre: thin walls would have gaps between coarser cells.
export function laidOver(own, frame, floor) {
  const {width, height} = floor.info, shown = new Int8Array(width * height).fill(-1);
  if (!own || !frame) return shown;
  for (let row = 0, at = 0; row < height; row++)
    for (let column = 0; column < width; column++, at++) {
      const there = cellAt(own.info, onMap(frame, centre(floor.info, row, column)));
      if (there >= 0) shown[at] = own.data[there];
    }
  for (let row = 0, at = 0; row < own.info.height; row++)
    for (let column = 0; column < own.info.width; column++, at++)
      if (own.data[at] >= WALL) {
        const there = cellAt(floor.info, onFloor(frame, centre(own.info, row, column)));
        if (there >= 0) shown[there] = WALL;
      }
  return shown;
}

function centre({origin, resolution}, row, column) {
  return {x: origin.position.x + (column + 0.5) * resolution, y: origin.position.y + (row + 0.5) * resolution};
}

function cellAt({origin, resolution, width, height}, {x, y}) {
  const column = Math.floor((x - origin.position.x) / resolution), row = Math.floor((y - origin.position.y) / resolution);
  return column >= 0 && column < width && row >= 0 && row < height ? row * width + column : -1;
}
