// Names of regions on the ground: HTML over the picture, each where its region has most room.

const MAX_LABELS = 40;

function isInside(point, rings) {
  let inside = false;
  for (const ring of rings) {
    for (let i = 0, j = ring.length - 1; i < ring.length; j = i++) {
      const [a, b] = [ring[i], ring[j]];
      if ((a[1] > point[1]) !== (b[1] > point[1]) &&
          point[0] < a[0] + ((b[0] - a[0]) * (point[1] - a[1])) / (b[1] - a[1])) inside = !inside;
    }
  }
  return inside;
}

function distanceToRings(point, rings) {
  let nearest = Infinity;
  for (const ring of rings) {
    for (let i = 0; i < ring.length; i++) {
      const a = ring[i];
      const b = ring[(i + 1) % ring.length];
      const along = [b[0] - a[0], b[1] - a[1]];
      const square = along[0] * along[0] + along[1] * along[1];
      const s = square > 0 ? ((point[0] - a[0]) * along[0] + (point[1] - a[1]) * along[1]) / square : 0;
      const at = Math.min(1, Math.max(0, s));
      nearest = Math.min(nearest, Math.hypot(point[0] - a[0] - at * along[0], point[1] - a[1] - at * along[1]));
    }
  }
  return nearest;
}

/** The place in a region, as far as it is in view and on top, that is farthest from all edges [m]; null: none. */
function roomiestPlace(rings, above, extent) {
  const low = [0, 1].map((axis) => Math.max(-extent[axis], Math.min(...rings[0].map((corner) => corner[axis]))));
  const high = [0, 1].map((axis) => Math.min(extent[axis], Math.max(...rings[0].map((corner) => corner[axis]))));
  const side = 12;
  let best = null;
  let room = 0;
  for (let n = 0; n < side * side; n++) {
    const point = [0, 1].map((axis) => {
      const step = axis === 0 ? n % side : Math.floor(n / side);
      return low[axis] + ((step + 0.5) / side) * (high[axis] - low[axis]);
    });
    if (!isInside(point, rings) || above.some((other) => isInside(point, other))) continue;
    const here = Math.min(distanceToRings(point, rings), ...above.map((other) => distanceToRings(point, other)),
      extent[0] - Math.abs(point[0]), extent[1] - Math.abs(point[1]));
    if (here > room) [best, room] = [point, here];
  }
  return best;
}

class Labels {
  constructor(data) {
    this.frame = document.getElementById("labels");
    this.labels = [];
    const named = data.regions.filter((region) => region.name > 0);
    if (named.length > MAX_LABELS) return;
    named.forEach((region, i) => {
      const above = named.slice(i + 1).map((other) => other.rings);
      const place = roomiestPlace(region.rings, above, data.extent);
      if (place) this.add(data.names[region.name], place.map((value) => value / data.view));
    });
  }

  add(name, place) {
    const element = document.createElement("span");
    element.textContent = name;
    this.frame.append(element);
    this.labels.push({ element, place, half: [element.offsetWidth / 2, element.offsetHeight / 2] });
  }

  /** Puts the names where a camera sees their places; of two that would meet the first one. */
  update(camera, width, height) {
    const shown = [];
    for (const { element, place, half } of this.labels) {
      const seen = new THREE.Vector3(place[0], place[1], 0).project(camera);
      const x = ((seen.x + 1) / 2) * width;
      const y = ((1 - seen.y) / 2) * height;
      const meets = (other) => Math.abs(other.x - x) < other.half[0] + half[0] && Math.abs(other.y - y) < other.half[1] + half[1];
      const isSeen = seen.z < 1 && Math.abs(seen.x) < 1 && Math.abs(seen.y) < 1 && !shown.some(meets);
      element.style.visibility = isSeen ? "visible" : "hidden";
      if (!isSeen) continue;
      shown.push({ x, y, half });
      element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -50%)`;
    }
  }
}
