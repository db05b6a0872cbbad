// Where the sphere is at any time. Between two knots (outputs and switches) it is interpolated, never across a switch:
// each knot has the velocities before and after it.

/** vx, vy, wx, wy, wz of a knot. */
const VELOCITIES = 5;

function knotsOf(data) {
  const { states, switches } = data;
  const size = states.time.length + switches.time.length;
  const knots = {
    size,
    time: new Float64Array(size),
    position: new Float64Array(2 * size),
    before: new Float64Array(VELOCITIES * size),
    after: new Float64Array(VELOCITIES * size),
    orientation: new Array(size).fill(null),
    mode: new Uint8Array(size),
    region: new Uint16Array(size),
    isSwitch: new Uint8Array(size),
  };
  let s = 0;
  let w = 0;
  for (let i = 0; i < size; i++) {
    // A state at the instant of a switch is the one after it.
    const takesSwitch = s === states.time.length ||
      (w < switches.time.length && switches.time[w] <= states.time[s]);
    if (takesSwitch) putSwitch(knots, i, switches, w++);
    else putState(knots, i, states, s++);
  }
  return knots;
}

function putState(knots, i, states, s) {
  knots.time[i] = states.time[s];
  knots.position.set(states.position.subarray(2 * s, 2 * s + 2), 2 * i);
  for (const side of [knots.before, knots.after]) {
    side.set(states.velocity.subarray(2 * s, 2 * s + 2), VELOCITIES * i);
    side.set(states.spin.subarray(3 * s, 3 * s + 3), VELOCITIES * i + 2);
  }
  knots.orientation[i] = unit(Array.from(states.orientation.subarray(4 * s, 4 * s + 4)));
  knots.mode[i] = states.mode[s];
  knots.region[i] = states.region[s];
}

function putSwitch(knots, i, switches, w) {
  knots.time[i] = switches.time[w];
  knots.position.set(switches.position.subarray(2 * w, 2 * w + 2), 2 * i);
  [knots.before, knots.after].forEach((side, after) => {
    const from = 2 * w + after;
    side.set(switches.velocity.subarray(2 * from, 2 * from + 2), VELOCITIES * i);
    side.set(switches.spin.subarray(3 * from, 3 * from + 3), VELOCITIES * i + 2);
  });
  knots.mode[i] = switches.kind[w] === 2 ? 0 : 1;
  knots.region[i] = switches.to[w];
  knots.isSwitch[i] = 1;
}

/** The turn from knot i over a time `after` it, by an angular velocity that is linear in time. */
function turnFrom(knots, i, after) {
  const begin = VELOCITIES * i + 2;
  const end = begin + VELOCITIES;
  const duration = knots.time[i + 1] - knots.time[i];
  const share = duration > 0 ? after / duration : 0;
  return [0, 1, 2].map((axis) => {
    const first = knots.after[begin + axis];
    return after * (first + 0.5 * share * (knots.before[end + axis] - first));
  });
}

/**
 * Orientations at the switches between two outputs i and j: turned on by the angular velocity; what is then missing
 * at j, less than half a turn, is spread evenly.
 */
function fillBetween(knots, i, j) {
  const path = [knots.orientation[i]];
  for (let k = i; k < j; k++) {
    const turn = rotation(turnFrom(knots, k, knots.time[k + 1] - knots.time[k]));
    path.push(product(turn, path[path.length - 1]));
  }
  const missing = rotationVector(product(knots.orientation[j], inverse(path[j - i])));
  const duration = knots.time[j] - knots.time[i];
  for (let k = i + 1; k < j; k++) {
    const share = duration > 0 ? (knots.time[k] - knots.time[i]) / duration : 0;
    knots.orientation[k] = unit(product(rotation(missing, share), path[k - i]));
  }
}

function fillOrientations(knots) {
  const known = [];
  for (let i = 0; i < knots.size; i++) if (knots.orientation[i]) known.push(i);
  if (knots.size > 0 && known.length === 0) {
    knots.orientation[0] = [0, 0, 0, 1];
    known.push(0);
  }
  for (let n = 0; n + 1 < known.length; n++) {
    if (known[n + 1] > known[n] + 1) fillBetween(knots, known[n], known[n + 1]);
  }
  for (let k = known[0] - 1; k >= 0; k--) {
    const turn = rotation(turnFrom(knots, k, knots.time[k + 1] - knots.time[k]));
    knots.orientation[k] = product(inverse(turn), knots.orientation[k + 1]);
  }
  for (let k = known[known.length - 1] + 1; k < knots.size; k++) {
    const turn = rotation(turnFrom(knots, k - 1, knots.time[k] - knots.time[k - 1]));
    knots.orientation[k] = product(turn, knots.orientation[k - 1]);
  }
}

class Motion {
  constructor(data) {
    this.data = data;
    this.knots = knotsOf(data);
    fillOrientations(this.knots);
    this.empty = this.knots.size === 0;
    this.begin = this.empty ? 0 : this.knots.time[0];
    this.end = this.empty ? 0 : this.knots.time[this.knots.size - 1];
  }

  /** Index of the knot with which the motion at a time begins. */
  knotAt(time) {
    return Math.max(0, lastNotAfter(this.knots.time, time));
  }

  /** Position on the piece from knot i, relative to the origin [m]: a cubic with the velocities at its ends. */
  placeOn(i, after) {
    const { time, position, before, after: later } = this.knots;
    const duration = time[i + 1] - time[i];
    const s = duration > 0 ? after / duration : 0;
    const rise = s * s * (3 - 2 * s);
    return [0, 1].map((axis) => {
      const a = position[2 * i + axis];
      const b = position[2 * i + 2 + axis];
      const from = later[VELOCITIES * i + axis];
      const to = before[VELOCITIES * (i + 1) + axis];
      return a + rise * (b - a) + duration * s * (1 - s) * ((1 - s) * from - s * to);
    });
  }

  orientationOn(i, after) {
    const { time, orientation } = this.knots;
    const duration = time[i + 1] - time[i];
    const whole = product(rotation(turnFrom(this.knots, i, duration)), orientation[i]);
    const missing = rotationVector(product(orientation[i + 1], inverse(whole)));
    const turned = product(rotation(turnFrom(this.knots, i, after)), orientation[i]);
    return unit(product(rotation(missing, duration > 0 ? after / duration : 0), turned));
  }

  /** vx, vy, wx, wy, wz on the piece from knot i. */
  velocitiesOn(i, after) {
    const { time, before, after: later } = this.knots;
    const s = after / (time[i + 1] - time[i]);
    return [0, 1, 2, 3, 4].map((part) => {
      const first = later[VELOCITIES * i + part];
      return first + s * (before[VELOCITIES * (i + 1) + part] - first);
    });
  }

  /** How the sphere moves on the piece from knot i: as at the output with which it begins or ends. */
  modeOn(i) {
    const { isSwitch, mode, size } = this.knots;
    return isSwitch[i] && i + 1 < size && !isSwitch[i + 1] ? mode[i + 1] : mode[i];
  }

  /** The sphere at a time between begin and end; places are relative to the origin. */
  at(time) {
    const { knots } = this;
    const i = this.knotAt(time);
    const after = time - knots.time[i];
    const inside = i + 1 < knots.size && after > 0;
    const at = VELOCITIES * i;
    const velocities = inside ? this.velocitiesOn(i, after) : Array.from(knots.after.subarray(at, at + VELOCITIES));
    const place = inside ? this.placeOn(i, after) : [knots.position[2 * i], knots.position[2 * i + 1]];
    const mode = this.modeOn(i);
    const region = knots.region[i];
    return {
      time,
      place,
      orientation: inside ? this.orientationOn(i, after) : knots.orientation[i],
      velocity: velocities.slice(0, 2),
      spin: velocities.slice(2),
      mode,
      region,
      slip: this.slip(velocities, place, mode, region),
      energy: this.energy(velocities),
    };
  }

  energy(velocities) {
    const { mass, gyrationRadius } = this.data.sphere;
    const [vx, vy, ...spin] = velocities;
    const turn = gyrationRadius * Math.hypot(spin[0], spin[1], spin[2]);
    return 0.5 * mass * (vx * vx + vy * vy + turn * turn);
  }

  /** Velocity of the contact point relative to the ground where it may slip [m/s]; else 0. */
  slip(velocities, place, mode, region) {
    if (mode !== 0 && mode !== 2) return [0, 0];
    const [vx, vy, wx, wy] = velocities;
    const { radius } = this.data.sphere;
    const [ux, uy] = this.groundVelocity(this.data.materials[this.data.materialOfName[region]], place);
    const slip = [vx - radius * wy - ux, vy + radius * wx - uy];
    const rounding = 1e-6 * (Math.hypot(vx, vy) + radius * Math.hypot(wx, wy) + Math.hypot(ux, uy));
    return Math.hypot(...slip) > rounding ? slip : [0, 0];
  }

  groundVelocity(material, place) {
    const x = place[0] + this.data.origin[0] - material.center[0];
    const y = place[1] + this.data.origin[1] - material.center[1];
    return [material.belt[0] - material.rate * y, material.belt[1] + material.rate * x];
  }
}
