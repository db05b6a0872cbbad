// The data of the page: arrays in base64 become numbers.

const MODES = ["free", "rolling", "sliding", "edge sliding", "resting"];
const KINDS = ["", "applied", "released", "exchanged"];
const CAUSES = ["edge", "placed", "slip ended", "grip lost", "livelock", "livelock ended", "kicked", "accumulation"];
const KIND_COLORS = ["#888888", "#d6336c", "#1c7ed6", "#e8890c"];
const MODE_COLORS = ["#1864ab", "#087f5b", "#d9480f", "#6741d9", "#495057"];
const LAW_COLORS = { smooth: "#b8dbf2", rough: "#e0bd85", rubber: "#9e99a8", coulomb: "#c7d99e" };

function bytesOf(text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

function arrayOf(Type, text) {
  return new Type(bytesOf(text).buffer);
}

function floatsOf(packed) {
  const floats = arrayOf(Float32Array, packed.data);
  return Float64Array.from(floats, (value) => value * packed.scale);
}

function statesOf(packed) {
  return {
    time: arrayOf(Float64Array, packed.time),
    position: floatsOf(packed.position),
    orientation: Float64Array.from(arrayOf(Int16Array, packed.orientation), (value) => value / 32767),
    velocity: floatsOf(packed.velocity),
    spin: floatsOf(packed.spin),
    mode: bytesOf(packed.mode),
    region: arrayOf(Uint16Array, packed.region),
  };
}

function switchesOf(packed) {
  return {
    time: arrayOf(Float64Array, packed.time),
    position: floatsOf(packed.position),
    impulse: floatsOf(packed.impulse),
    velocity: floatsOf(packed.velocity),
    spin: floatsOf(packed.spin),
    lost: floatsOf(packed.lost),
    kind: bytesOf(packed.kind),
    cause: bytesOf(packed.cause),
    from: arrayOf(Uint16Array, packed.from),
    to: arrayOf(Uint16Array, packed.to),
  };
}

/** A list of {material, name, cell, rings}; a ring is a list of [x, y], the first one the outline, others holes. */
function regionsOf(packed) {
  const material = arrayOf(Uint16Array, packed.material);
  const name = arrayOf(Uint16Array, packed.name);
  const cell = bytesOf(packed.cell);
  const counts = bytesOf(packed.rings);
  const lengths = arrayOf(Uint32Array, packed.lengths);
  const corners = floatsOf(packed.corners);
  const regions = [];
  let ring = 0;
  let corner = 0;
  for (let i = 0; i < material.length; i++) {
    const rings = [];
    for (let k = 0; k < counts[i]; k++, ring++) {
      const points = [];
      for (let n = 0; n < lengths[ring]; n++, corner++) points.push([corners[2 * corner], corners[2 * corner + 1]]);
      rings.push(points);
    }
    regions.push({ material: material[i], name: name[i], cell: cell[i] === 1, rings });
  }
  return regions;
}

function cellsOf(packed) {
  return packed && Object.assign({}, packed, { bits: bytesOf(packed.bits) });
}

/** Each law has a colour; its materials differ in how dark it is. */
function giveColors(materials) {
  const count = {};
  for (const material of materials) {
    const shade = Math.min(4, count[material.law] || 0);
    count[material.law] = shade + 1;
    const parts = [1, 3, 5].map((at) => parseInt(LAW_COLORS[material.law].substr(at, 2), 16));
    material.color = `rgb(${parts.map((part) => Math.round(part * (1 - 0.045 * shade))).join(", ")})`;
  }
  return materials;
}

function readData() {
  const packed = JSON.parse(document.getElementById("data").textContent);
  return {
    title: packed.title,
    ended: packed.ended,
    sphere: packed.sphere,
    origin: packed.origin,
    view: packed.view,
    extent: packed.extent,
    inside: packed.inside,
    names: packed.names.map((entry) => entry[0]),
    materialOfName: packed.names.map((entry) => entry[1]),
    materials: giveColors(packed.materials),
    leftOut: packed.leftOut,
    states: statesOf(packed.states),
    switches: switchesOf(packed.switches),
    regions: regionsOf(packed.regions),
    cells: cellsOf(packed.cells),
  };
}
