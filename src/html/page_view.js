// The picture: camera, light, and what is in it.

const FOV = 38;
const LATER = 1; // layer

/** Throws where there is no WebGL. */
class View {
  constructor(motion, data) {
    this.motion = motion;
    this.data = data;
    this.stage = document.getElementById("stage");
    this.renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: false });
    this.renderer.debug.checkShaderErrors = false; // which would wait for each shader
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.stage.prepend(this.renderer.domElement);
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(FOV, 1, 0.01, 100);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, this.renderer.domElement);
    this.controls.maxPolarAngle = 0.49 * Math.PI;
    this.controls.screenSpacePanning = false;
    this.controls.enableKeys = false;
    this.radius = data.sphere.radius / data.view;
    this.controls.minDistance = 1.6 * this.radius;
    this.controls.maxDistance = 12;
    this.light();
    this.fill();
    this.mode = "whole";
    this.labels = null;
  }

  light() {
    this.scene.add(new THREE.HemisphereLight("#ffffff", "#8d8f98", 0.85));
    const sun = new THREE.DirectionalLight("#ffffff", 0.5);
    sun.position.set(-0.5, 0.4, 1);
    this.scene.add(sun);
    this.scene.fog = new THREE.Fog("#ffffff", 1, 10);
    this.setSky();
  }

  setSky() {
    const sky = getComputedStyle(document.documentElement).getPropertyValue("--sky").trim();
    this.scene.background = new THREE.Color(sky);
    this.scene.fog.color.set(sky);
  }

  fill() {
    const arrow = Math.max(3.4 * this.radius, 0.16);
    this.ground = new GroundView(this.data);
    this.trail = new Trail(this.motion, this.data);
    this.impulses = new ImpulseArrows(this.data, arrow);
    this.slip = new SlipArrow(this.motion, this.data, Math.max(3 * this.radius, 0.12));
    this.ball = new Ball(this.radius);
    this.scene.add(this.ground.group, this.trail.group, this.impulses.group, this.slip.mesh, this.ball.group);
    this.place = [0, 0];
    // Each kind of material is one more program for the first picture.
    for (const part of [this.trail.group, this.impulses.group, this.slip.mesh, this.ball.marker]) {
      part.traverse((object) => object.layers.set(LATER));
    }
  }

  /** What is not in the first picture. */
  showRest() {
    this.camera.layers.enable(LATER);
  }

  /** "whole", "follow" or "above". */
  setMode(mode) {
    this.mode = mode;
    if (mode === "follow") this.stayBehind();
    else this.fit(mode === "above" ? [0, -1e-3, 1] : [0, -0.8, 0.75]);
  }

  stayBehind() {
    const [x, y] = this.place;
    const distance = Math.max(9 * this.radius, 1e-12);
    const heading = this.motion.empty ? [1, 0] : this.motion.at(this.motion.begin).velocity;
    const size = Math.hypot(...heading);
    const [hx, hy] = size > 0 ? heading.map((part) => part / size) : [1, 0];
    this.controls.target.set(x, y, this.radius);
    // From behind and from the side, so that both the turning and the way ahead are seen.
    this.camera.position.set(x + distance * (-0.75 * hx + 0.45 * hy), y + distance * (-0.75 * hy - 0.45 * hx),
      this.radius + 0.6 * distance);
    this.controls.update();
  }

  /** Puts the camera so far away in a direction that the whole path is seen. */
  fit(direction) {
    const away = new THREE.Vector3(...direction).normalize();
    const extent = this.data.extent.map((value) => value / this.data.view);
    const corners = [];
    for (const x of [-extent[0], extent[0]]) for (const y of [-extent[1], extent[1]]) corners.push(new THREE.Vector3(x, y, 0));
    this.controls.target.set(0, 0, 0);
    const right = 1 - this.covered() * 2;
    this.camera.near = 0.01;
    this.camera.far = 100;
    this.camera.updateProjectionMatrix();
    for (let distance = 0.6; distance < 12; distance *= 1.04) {
      this.camera.position.copy(away).multiplyScalar(distance);
      this.controls.update();
      this.camera.updateMatrixWorld();
      const fits = corners.every((corner) => {
        const seen = corner.clone().project(this.camera);
        return seen.z < 1 && seen.x > -0.96 && seen.x < right - 0.04 && Math.abs(seen.y) < 0.92;
      });
      if (fits) break;
    }
  }

  /** Share of the width that the legend covers. */
  covered() {
    const legend = document.getElementById("legend");
    return legend.open && this.width > 700 ? (legend.offsetWidth + 12) / this.width : 0;
  }

  resize() {
    const width = this.stage.clientWidth;
    const height = this.stage.clientHeight;
    if (width === this.width && height === this.height) return;
    [this.width, this.height] = [width, height];
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.setViewOffset(width, height, 0.5 * this.covered() * width, 0, width, height);
    if (this.mode !== "follow") this.setMode(this.mode);
  }

  show(state) {
    this.ball.group.visible = state !== null;
    if (state) this.showState(state);
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.ground.see(this.controls.target, distance);
    for (const marks of [this.trail, this.impulses, this.slip]) marks.see(distance);
    this.camera.near = 0.02 * distance;
    this.camera.far = 40 * distance + 12;
    this.camera.updateProjectionMatrix();
    this.scene.fog.near = distance + 1;
    this.scene.fog.far = distance + 3.4;
    this.ball.mark(this.height / (2 * Math.tan((FOV * Math.PI) / 360) * this.camera.position.distanceTo(this.ball.mesh.position)),
      this.height, (FOV * Math.PI) / 180);
    this.renderer.render(this.scene, this.camera);
    if (this.labels) this.labels.update(this.camera, this.width, this.height);
  }

  showState(state) {
    const place = state.place.map((value) => value / this.data.view);
    if (this.mode === "follow") {
      for (const moved of [this.camera.position, this.controls.target]) {
        moved.x += place[0] - this.place[0];
        moved.y += place[1] - this.place[1];
      }
      this.camera.lookAt(this.controls.target);
    }
    this.place = place;
    this.ball.update(place, state.orientation);
    this.ground.move(state.time);
    this.trail.update(state.time);
    this.impulses.update(state.time);
    this.slip.update(state);
  }
}
