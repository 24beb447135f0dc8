// What a map contains besides the cells of /map: carpet, cliffs and docks, as /rosapi/floor tells.

export const NO_LAYERS = {width: 0, height: 0, carpet: null, cliff: null, docks: []};

// The layers of an answer, with a value for each cell of the map.
export function layersOf({width, height, carpet, cliff, docks}) {
  return {width, height, carpet: cells(carpet, width * height), cliff: cells(cliff, width * height), docks};
}

// The cells of a layer, 0 or 1, of the lengths of its runs; null for a layer that the map lacks.
export function cells(runs, count) {
  if (!runs.length) return null;
  const layer = new Uint8Array(count);
  let at = 0;
  runs.forEach((length, number) => { layer.fill(number % 2, at, at += length); });
  return layer;
}
