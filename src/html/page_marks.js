// What the motion leaves on the ground: the trail, an arrow for each impulse, and the slip of the contact.

const IMPULSE_COLOR = "#a3006d";
const SLIP_COLOR = "#e03131";
const MAX_TRAIL_STEPS = 20000;

/** The path as a ribbon in the colours of the modes, up to a time, and as a thin line to its end. */
class Trail {
  constructor(motion, data) {
    this.times = [];
    this.paint = new Paint();
    this.thin = [];
    this.widest = Math.max((0.2 * data.sphere.radius) / data.view, 0.008);
    const pieces = motion.knots.size - 1;
    const steps = Math.max(1, Math.min(24, Math.floor(MAX_TRAIL_STEPS / Math.max(1, pieces))));
    this.last = null;
    for (let i = 0; i < pieces; i++) this.addPiece(motion, i, steps, data.view);
    this.group = new THREE.Group();
    if (this.times.length === 0) return;
    this.ribbon = this.paint.mesh();
    this.ribbon.renderOrder = -50;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(this.thin, 3));
    this.rest = new THREE.LineSegments(geometry,
      new THREE.LineBasicMaterial({ color: "#1c2430", transparent: true, opacity: 0.35, depthWrite: false }));
    this.rest.frustumCulled = false;
    this.group.add(this.ribbon, this.rest);
  }

  addPiece(motion, i, steps, view) {
    const { time } = motion.knots;
    const duration = time[i + 1] - time[i];
    if (!(duration > 0)) return;
    const color = new THREE.Color(MODE_COLORS[motion.modeOn(i)]);
    const isCorner = i + 2 === motion.knots.size || motion.knots.isSwitch[i + 1] || motion.modeOn(i) !== motion.modeOn(i + 1);
    if (!this.last) [this.last, this.begin] = [motion.placeOn(i, 0).map((value) => value / view), time[i]];
    for (let k = 1; k <= steps; k++) {
      const next = motion.placeOn(i, (k / steps) * duration).map((value) => value / view);
      const length = Math.hypot(next[0] - this.last[0], next[1] - this.last[1]);
      // Shorter lines are not to be seen; at the corners the lines end.
      if (length === 0 || (length < 0.25 * this.widest && !(isCorner && k === steps))) continue;
      this.paint.line(this.last, next, color);
      this.times.push(this.begin);
      this.thin.push(this.last[0], this.last[1], 0, next[0], next[1], 0);
      [this.last, this.begin] = [next, time[i] + (k / steps) * duration];
    }
  }

  update(time) {
    if (!this.ribbon) return;
    const shown = lastNotAfter(this.times, time) + 1;
    this.ribbon.geometry.setDrawRange(0, 6 * shown);
    this.rest.geometry.setDrawRange(2 * shown, Infinity);
  }

  /** @param distance  of the camera from what it looks at */
  see(distance) {
    if (this.ribbon) setWidth(this.ribbon, Math.min(this.widest, 0.02 * distance));
  }
}

/** Arrows at the switches with an impulse, from the contact point along it; the largest is `longest` long. */
class ImpulseArrows {
  constructor(data, longest) {
    const { switches, view } = data;
    this.longest = longest;
    const paint = new Paint();
    const color = new THREE.Color(IMPULSE_COLOR);
    this.times = [];
    let largest = 0;
    const sizeOf = (i) => Math.hypot(switches.impulse[3 * i], switches.impulse[3 * i + 1]);
    for (let i = 0; i < switches.time.length; i++) largest = Math.max(largest, sizeOf(i));
    for (let i = 0; i < switches.time.length; i++) {
      const size = sizeOf(i);
      if (!(size > 1e-6 * largest)) continue;
      const length = 0.3 + (0.7 * size) / largest;
      const from = [switches.position[2 * i] / view, switches.position[2 * i + 1] / view];
      paint.arrow(from, [0, 1].map((axis) => (length * switches.impulse[3 * i + axis]) / size), color);
      this.times.push(switches.time[i]);
    }
    this.group = new THREE.Group();
    this.any = this.times.length > 0;
    if (!this.any) return;
    this.mesh = paint.mesh();
    this.mesh.renderOrder = -40;
    this.group.add(this.mesh);
  }

  update(time) {
    if (this.mesh) this.mesh.geometry.setDrawRange(0, 9 * (lastNotAfter(this.times, time) + 1));
  }

  see(distance) {
    if (this.mesh) setWidth(this.mesh, Math.min(this.longest, 0.35 * distance));
  }
}

/** The slip of the contact point over the ground; `longest` belongs to the fastest one. */
class SlipArrow {
  constructor(motion, data, longest) {
    this.view = data.view;
    this.longest = longest;
    this.fastest = 0;
    this.share = 1;
    for (const time of motion.knots.time) this.fastest = Math.max(this.fastest, Math.hypot(...motion.at(time).slip));
    const paint = new Paint();
    paint.arrow([0, 0], [1, 0], new THREE.Color(SLIP_COLOR));
    this.mesh = paint.mesh();
    this.mesh.renderOrder = -30;
  }

  update(state) {
    const size = Math.hypot(...state.slip);
    this.mesh.visible = size > 1e-5 * this.fastest;
    if (!this.mesh.visible) return;
    this.mesh.position.set(state.place[0] / this.view, state.place[1] / this.view, 0);
    this.mesh.rotation.z = Math.atan2(state.slip[1], state.slip[0]);
    this.share = 0.35 + (0.65 * size) / this.fastest;
  }

  see(distance) {
    setWidth(this.mesh, this.share * Math.min(this.longest, 0.35 * distance));
  }
}
