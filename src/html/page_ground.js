// The ground in three.js. Lengths are divided by the size of the view. All of it lies at height 0 and is painted in
// the order of the regions, without depth; what stands on it is painted later.

const EDGE_COLOR = "#27313d";
const SMALL_SPHERE = 0.004; // radius over half the view, below which the page follows the sphere at first

/**
 * Triangles of one colour each, in the order in which they are painted. A corner is its place and, times a width that
 * the mesh is given later, an offset: lines and arrows keep in proportion to what the camera sees.
 */
class Paint {
  constructor() {
    this.places = [];
    this.offsets = [];
    this.colors = [];
  }

  get empty() {
    return this.places.length === 0;
  }

  corner(place, offset, color) {
    this.places.push(place[0], place[1], 0);
    this.offsets.push(offset[0], offset[1]);
    this.colors.push(color.r, color.g, color.b);
  }

  triangle(a, b, c, color) {
    for (const place of [a, b, c]) this.corner(place, [0, 0], color);
  }

  /** A line of width 1 between two places, with half a width beyond them. */
  line(a, b, color) {
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    if (!(length > 0)) return;
    const x = (0.5 * (b[0] - a[0])) / length;
    const y = (0.5 * (b[1] - a[1])) / length;
    const corners = [[a, [-x - y, -y + x]], [a, [-x + y, -y - x]], [b, [x + y, y - x]], [b, [x - y, y + x]]];
    for (const i of [0, 1, 2, 0, 2, 3]) this.corner(...corners[i], color);
  }

  /** An arrow from a place along a vector in widths of the mesh. */
  arrow(place, along, color) {
    const length = Math.hypot(along[0], along[1]);
    const [x, y] = [along[0] / length, along[1] / length];
    const neck = length - Math.min(0.26, 0.6 * length);
    const at = (forward, aside) => this.corner(place, [forward * x - aside * y, forward * y + aside * x], color);
    for (const [forward, aside] of [[0, 0.045], [0, -0.045], [neck, -0.045], [0, 0.045], [neck, -0.045], [neck, 0.045],
      [neck, 0.12], [neck, -0.12], [length, 0]]) at(forward, aside);
  }

  mesh(width = 0) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(this.places, 3));
    geometry.setAttribute("offset", new THREE.Float32BufferAttribute(this.offsets, 2));
    geometry.setAttribute("color", new THREE.Float32BufferAttribute(this.colors, 3));
    const material = flatMaterial({ vertexColors: THREE.VertexColors });
    material.userData.width = { value: width };
    material.onBeforeCompile = function (shader) {
      shader.uniforms.width = this.userData.width;
      shader.vertexShader = "attribute vec2 offset;\nuniform float width;\n" + shader.vertexShader.replace(
        "#include <begin_vertex>", "#include <begin_vertex>\ntransformed.xy += width * offset;");
    };
    const mesh = new THREE.Mesh(geometry, material);
    mesh.frustumCulled = false;
    return mesh;
  }
}

function setWidth(mesh, width) {
  mesh.material.userData.width.value = width;
}

function flatMaterial(options) {
  return new THREE.MeshBasicMaterial(Object.assign({ depthTest: false, depthWrite: false, side: THREE.DoubleSide }, options));
}

/** Corners of triangles that cover a region. */
function trianglesOf(rings) {
  const points = rings.map((ring) => ring.map(([x, y]) => new THREE.Vector2(x, y)));
  const all = [].concat(...rings);
  if (rings.length === 1 && rings[0].length === 3) return [rings[0]];
  return THREE.ShapeUtils.triangulateShape(points[0], points.slice(1)).map((face) => face.map((i) => all[i]));
}

function moves(material) {
  return material.belt[0] !== 0 || material.belt[1] !== 0 || material.rate !== 0;
}

/** A canvas for a texture, and its pen. */
function pictureOf(width, height) {
  const canvas = document.createElement("canvas");
  canvas.width = width;
  canvas.height = height;
  return [canvas, canvas.getContext("2d", { willReadFrequently: true })];
}

/** Arrow heads in a row, to be repeated. */
function beltPicture() {
  const [canvas, pen] = pictureOf(64, 64);
  pen.strokeStyle = "rgba(20, 60, 50, 0.45)";
  pen.lineWidth = 6;
  pen.lineJoin = pen.lineCap = "round";
  pen.beginPath();
  pen.moveTo(24, 18);
  pen.lineTo(40, 32);
  pen.lineTo(24, 46);
  pen.stroke();
  return repeated(canvas);
}

function repeated(canvas) {
  const texture = new THREE.CanvasTexture(canvas);
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.anisotropy = 4;
  texture.matrixAutoUpdate = false;
  return texture;
}

/** Arrow heads along circles; the picture is as wide as so many rings. */
function turntablePicture(rings, sign) {
  const size = 1024;
  const [canvas, pen] = pictureOf(size, size);
  const step = size / (2 * rings);
  pen.strokeStyle = "rgba(20, 60, 50, 0.45)";
  pen.lineWidth = 0.09 * step;
  pen.lineJoin = pen.lineCap = "round";
  pen.translate(size / 2, size / 2);
  for (let ring = 0; ring < rings - 0.5; ring++) {
    const count = Math.max(4, Math.round(2 * Math.PI * (ring + 0.5)));
    for (let i = 0; i < count; i++) {
      pen.save();
      pen.rotate((2 * Math.PI * i) / count);
      pen.translate((ring + 0.5) * step, 0);
      pen.beginPath();
      // Canvas rows run downwards: counter-clockwise on the ground is towards -y here.
      pen.moveTo(-0.22 * step, 0.13 * step * sign);
      pen.lineTo(0, -0.13 * step * sign);
      pen.lineTo(0.22 * step, 0.13 * step * sign);
      pen.stroke();
      pen.restore();
    }
  }
  const texture = new THREE.CanvasTexture(canvas);
  texture.anisotropy = 4;
  texture.matrixAutoUpdate = false;
  return texture;
}

/** The pattern over a moving region, which moves with its ground. */
class MovingPattern {
  constructor(rings, material, data) {
    const positions = [];
    this.coordinates = [];
    for (const corner of [].concat(...trianglesOf(rings))) {
      positions.push(corner[0], corner[1], 0);
      this.coordinates.push(corner);
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(positions, 3));
    const unit = data.view;
    const radius = data.sphere.radius / unit;
    const size = radius < SMALL_SPHERE ? 5 * radius : Math.max(1.7 * radius, 0.09);
    if (material.rate !== 0) this.turn(material, data, size, rings);
    else this.run(material, unit, size);
    const uv = [].concat(...this.coordinates.map((corner) => this.uvOf(corner)));
    geometry.setAttribute("uv", new THREE.Float32BufferAttribute(uv, 2));
    this.mesh = new THREE.Mesh(geometry, flatMaterial({ map: this.texture }));
    // Painted among the opaque, in the order of the regions.
    this.mesh.material.blending = THREE.CustomBlending;
    this.mesh.frustumCulled = false;
  }

  run(material, unit, size) {
    const [x, y] = material.belt;
    const speed = Math.hypot(x, y);
    this.texture = beltPicture();
    this.uvOf = (corner) => [(corner[0] * x + corner[1] * y) / (speed * size), (corner[1] * x - corner[0] * y) / (speed * size)];
    this.move = (time) => {
      const shift = (((speed / unit) * time) / size) % 1;
      this.texture.matrix.set(1, 0, -shift, 0, 1, 0, 0, 0, 1);
    };
  }

  turn(material, data, size, rings) {
    const center = [0, 1].map((axis) => (material.center[axis] - data.origin[axis]) / data.view);
    const reach = Math.max(...rings[0].map((corner) => Math.hypot(corner[0] - center[0], corner[1] - center[1])));
    const circles = Math.min(24, Math.max(2, Math.ceil(reach / size)));
    const width = 2 * Math.max(reach, 1e-9) * 1.02;
    this.texture = turntablePicture(circles, Math.sign(material.rate));
    this.uvOf = (corner) => [(corner[0] - center[0]) / width, (corner[1] - center[1]) / width];
    this.move = (time) => {
      const angle = (material.rate * time) % (2 * Math.PI);
      const c = Math.cos(angle);
      const s = Math.sin(angle);
      this.texture.matrix.set(c, s, 0.5, -s, c, 0.5, 0, 0, 1);
    };
  }
}

function cellsMesh(cells, data, color) {
  const pixels = new Uint8Array(4 * cells.columns * cells.rows);
  for (let i = 0; i < cells.columns * cells.rows; i++) {
    const on = (cells.bits[i >> 3] >> (7 - (i & 7))) & 1;
    pixels.set([255 * color.r, 255 * color.g, 255 * color.b, on * 255], 4 * i);
  }
  const texture = new THREE.DataTexture(pixels, cells.columns, cells.rows, THREE.RGBAFormat);
  texture.needsUpdate = true;
  const [low, high] = [cells.low, cells.high].map((corner) => corner.map((value) => value / data.view));
  const mesh = new THREE.Mesh(new THREE.PlaneBufferGeometry(high[0] - low[0], high[1] - low[1]),
    flatMaterial({ map: texture, alphaTest: 0.5 }));
  mesh.position.set((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, 0);
  return mesh;
}

const GRID_LINES = 40; // to each side

/** Lines over the ground, to see distances by: around what the camera looks at, as far apart as is seen well. */
class Grid {
  constructor(data) {
    this.data = data;
    this.half = data.inside / data.view;
    this.lines = new THREE.LineSegments(new THREE.BufferGeometry(),
      new THREE.LineBasicMaterial({ color: "#000000", transparent: true, opacity: 0.1, depthWrite: false }));
    this.lines.frustumCulled = false;
    this.step = 0; // [m]
  }

  update(target, distance) {
    const { origin, view } = this.data;
    const step = roundStep((distance * view) / 12);
    const middle = [target.x, target.y].map((value, axis) => Math.round((value * view + origin[axis]) / (5 * step)) * 5);
    if (step === this.step && middle[0] === this.middle[0] && middle[1] === this.middle[1]) return;
    [this.step, this.middle] = [step, middle];
    const bound = (value) => Math.min(this.half, Math.max(-this.half, value));
    const places = [0, 1].map((axis) => {
      const all = [];
      for (let i = -GRID_LINES; i <= GRID_LINES; i++) all.push(((middle[axis] + i) * step - origin[axis]) / view);
      return all;
    });
    const points = [];
    const [xs, ys] = places;
    // In pieces: not every driver cuts a line at the camera.
    for (const x of xs) if (Math.abs(x) < this.half) this.add(points, ys, (y) => [x, bound(y), 0]);
    for (const y of ys) if (Math.abs(y) < this.half) this.add(points, xs, (x) => [bound(x), y, 0]);
    this.lines.geometry.setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
    if (this.changed) this.changed(step);
  }

  add(points, along, placeOf) {
    for (let k = 0; k + 8 < along.length; k += 8) points.push(...placeOf(along[k]), ...placeOf(along[k + 8]));
  }
}

/** The whole ground; `move` puts the moving patterns where they are at a time. */
class GroundView {
  constructor(data) {
    this.group = new THREE.Group();
    this.patterns = [];
    this.data = data;
    this.colorOf = data.materials.map((material) => new THREE.Color(material.color));
    this.edge = new THREE.Color(EDGE_COLOR);
    this.meshes = [];
    this.paint = new Paint();
    this.paintRegion([this.square()], 0, true);
    if (data.cells) {
      this.flush();
      this.add(cellsMesh(data.cells, data, this.colorOf[data.cells.material]));
    }
    for (const region of data.regions) {
      const rings = region.rings.map((ring) => ring.map((corner) => [corner[0] / data.view, corner[1] / data.view]));
      this.paintRegion(rings, region.material, region.cell);
    }
    this.flush();
    this.grid = new Grid(data);
    this.group.add(this.grid.lines);
  }

  square() {
    const half = this.data.inside / this.data.view;
    return [[-half, -half], [half, -half], [half, half], [-half, half]];
  }

  add(mesh) {
    mesh.renderOrder = this.group.children.length - 1000;
    this.group.add(mesh);
  }

  flush() {
    if (!this.paint.empty) {
      this.meshes.push(this.paint.mesh());
      this.add(this.meshes[this.meshes.length - 1]);
    }
    this.paint = new Paint();
  }

  paintRegion(rings, index, withoutEdge) {
    const material = this.data.materials[index];
    for (const [a, b, c] of trianglesOf(rings)) this.paint.triangle(a, b, c, this.colorOf[index]);
    if (moves(material) && this.patterns.length < 60) {
      this.flush();
      const pattern = new MovingPattern(rings, material, this.data);
      this.patterns.push(pattern);
      this.add(pattern.mesh);
    }
    if (!withoutEdge) rings.forEach((ring) => this.paintEdge(ring));
  }

  paintEdge(ring) {
    const half = (this.data.inside / this.data.view) * (1 - 1e-6);
    ring.forEach((a, i) => {
      const b = ring[(i + 1) % ring.length];
      const alongBorder = [0, 1].some((axis) => Math.abs(a[axis]) >= half && a[axis] === b[axis]);
      if (!alongBorder) this.paint.line(a, b, this.edge);
    });
  }

  move(time) {
    for (const pattern of this.patterns) pattern.move(time);
  }

  /** @param distance  of the camera from what it looks at, `target` */
  see(target, distance) {
    for (const mesh of this.meshes) setWidth(mesh, Math.min(0.006, 0.003 * distance));
    this.grid.update(target, distance);
  }
}
