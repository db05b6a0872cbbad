// The sphere: a beach ball, whose pattern looks the same in no two orientations, as the node's markers draw it.

function ballPicture() {
  const [canvas, pen] = pictureOf(512, 256);
  const stripes = ["#e61f24", "#ffffff", "#1f59d9", "#ffffff", "#ffd11f", "#ffffff"];
  stripes.forEach((color, i) => {
    pen.fillStyle = color;
    pen.fillRect((512 / 6) * i, 0, 512 / 6 + 1, 256);
  });
  pen.fillStyle = "#26a64d";
  pen.fillRect(0, 0, 512, 32);
  pen.fillStyle = "#ff801a";
  pen.fillRect(0, 224, 512, 32);
  pen.fillStyle = "rgba(20, 30, 45, 0.55)";
  for (let i = 0; i < 6; i++) pen.fillRect((512 / 6) * i - 1, 32, 2, 192);
  pen.fillRect(0, 31, 512, 2);
  pen.fillRect(0, 223, 512, 2);
  const texture = new THREE.CanvasTexture(canvas);
  texture.anisotropy = 4;
  return texture;
}

function shadowPicture() {
  const [canvas, pen] = pictureOf(128, 128);
  const shade = pen.createRadialGradient(64, 64, 0, 64, 64, 64);
  shade.addColorStop(0, "rgba(0, 0, 0, 0.6)");
  shade.addColorStop(0.45, "rgba(0, 0, 0, 0.35)");
  shade.addColorStop(1, "rgba(0, 0, 0, 0)");
  pen.fillStyle = shade;
  pen.fillRect(0, 0, 128, 128);
  return new THREE.CanvasTexture(canvas);
}

/** A ring of constant size on the screen, which shows where a sphere is that is too small to be seen. */
function markerSprite() {
  const [canvas, pen] = pictureOf(64, 64);
  for (const [color, width] of [["#ffffff", 12], ["#e61f24", 7]]) {
    pen.strokeStyle = color;
    pen.lineWidth = width;
    pen.beginPath();
    pen.arc(32, 32, 22, 0, 2 * Math.PI);
    pen.stroke();
  }
  const sprite = new THREE.Sprite(new THREE.SpriteMaterial({
    map: new THREE.CanvasTexture(canvas), depthTest: false, sizeAttenuation: false, fog: false }));
  sprite.renderOrder = 10;
  return sprite;
}

class Ball {
  /** @param radius  in units of the view */
  constructor(radius) {
    this.radius = radius;
    // The poles of three.js are on y, those of the ball on z.
    const geometry = new THREE.SphereBufferGeometry(1, 48, 32).rotateX(Math.PI / 2);
    this.mesh = new THREE.Mesh(geometry,
      new THREE.MeshLambertMaterial({ map: ballPicture() }));
    this.mesh.scale.setScalar(radius);
    this.shadow = new THREE.Mesh(new THREE.PlaneBufferGeometry(2.8 * radius, 2.8 * radius),
      new THREE.MeshBasicMaterial({ map: shadowPicture(), transparent: true, depthWrite: false }));
    this.marker = markerSprite();
    this.marker.visible = false;
    this.group = new THREE.Group();
    this.group.add(this.mesh, this.shadow, this.marker);
    this.group.children.forEach((child) => { child.frustumCulled = false; });
  }

  update(place, orientation) {
    this.mesh.position.set(place[0], place[1], this.radius);
    this.mesh.quaternion.set(...orientation);
    this.shadow.position.set(place[0] + 0.12 * this.radius, place[1] - 0.1 * this.radius, 0);
    this.marker.position.copy(this.mesh.position);
  }

  /** @param pixels  that a length of 1 at the sphere has on the screen */
  mark(pixels, height, fov) {
    this.marker.visible = this.radius * pixels < 5;
    this.marker.scale.setScalar((2 * Math.tan(fov / 2) * 16) / height);
  }
}
