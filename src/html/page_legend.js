// What the colours mean, and what the numbers are now.

const MAX_NAMES = 6;

function describe(material) {
  const parts = [];
  if (material.friction > 0) parts.push(`friction ${figures(material.friction)}`);
  if (material.rollingResistance > 0) parts.push(`rolling resistance ${figures(material.rollingResistance)}`);
  if (material.spinFriction > 0) parts.push(`spin friction ${figures(material.spinFriction)}`);
  const [x, y] = material.belt;
  if (x !== 0 || y !== 0) parts.push(`belt (${figures(x)}, ${figures(y)}) m/s`);
  if (material.rate !== 0) parts.push(`turntable ${figures(material.rate)} rad/s ${material.rate > 0 ? "\u21ba" : "\u21bb"}`);
  return parts.join(", ");
}

function legendRow(color, isLine, title, names) {
  const row = document.createElement("div");
  row.className = "row";
  const swatch = document.createElement("span");
  swatch.className = isLine ? "swatch line" : "swatch";
  swatch.style.background = color;
  const what = document.createElement("span");
  what.className = "what";
  what.textContent = title;
  if (names) {
    const list = document.createElement("div");
    list.className = "names";
    list.textContent = names;
    what.append(list);
  }
  row.append(swatch, what);
  return row;
}

function namesOn(data, index) {
  const names = index === 0 ? ["base"] : [];
  let count = names.length;
  let cells = data.cells && data.cells.material === index ? "cells of the image" : "";
  for (const region of data.regions) {
    if (region.material !== index) continue;
    if (region.cell) cells = "cells of the image";
    else count++;
    if (!region.cell && region.name > 0 && names.length < MAX_NAMES) names.push(data.names[region.name]);
  }
  if (cells) names.push(cells);
  if (names.length === 0) return count > 0 ? `${count} regions` : "";
  const more = count - names.length + (cells ? 1 : 0);
  return names.join(", ") + (more > 0 ? ` and ${more} more` : "");
}

function fillLegend(data, motion, view) {
  const body = document.getElementById("legend-body");
  data.materials.forEach((material, i) => {
    const names = namesOn(data, i);
    if (!names || i >= 40) return;
    const coefficients = describe(material);
    body.append(legendRow(material.color, false, material.law + (coefficients ? `: ${coefficients}` : ""), names));
  });
  const modes = new Set();
  for (let i = 0; i + 1 < motion.knots.size; i++) modes.add(motion.modeOn(i));
  for (const mode of [...modes].sort()) body.append(legendRow(MODE_COLORS[mode], true, `path, ${MODES[mode]}`));
  if (view && view.impulses.any) body.append(legendRow(IMPULSE_COLOR, true, "impulse of the ground"));
  if (view && view.slip.fastest > 0) body.append(legendRow(SLIP_COLOR, true, "slip of the contact"));
  if (view) {
    const row = legendRow("rgba(0, 0, 0, 0.15)", true, "grid");
    body.append(row);
    view.ground.grid.changed = (step) => { row.lastChild.textContent = `grid of ${figures(step)} m`; };
  }
  if (window.matchMedia("(max-width: 900px)").matches) document.getElementById("legend").open = false;
}

class Readout {
  constructor(data, motion) {
    this.data = data;
    this.time = document.getElementById("time");
    this.doing = document.getElementById("doing");
    this.decimals = decimalsOf(motion.end - motion.begin);
    const table = document.getElementById("numbers");
    this.cells = ["x, y|m", "speed|m/s", "spin|rad/s"].map((row) => {
      const [name, unit] = row.split("|");
      const line = table.insertRow();
      line.append(cell(name), cell(""), cell(unit));
      return line.cells[1];
    });
  }

  /** A coordinate to a hundredth of the radius or a ten thousandth of the view, whichever is less. */
  placeText(value) {
    const size = Math.min(this.data.view, 30 * this.data.sphere.radius);
    return size > 1e-6 && size < 1e15 ? value.toFixed(Math.max(0, 3 - Math.floor(Math.log10(size)))) : figures(value);
  }

  show(time, state) {
    this.time.textContent = time.toFixed(this.decimals);
    if (!state) return;
    const region = this.data.names[state.region];
    this.doing.textContent = MODES[state.mode] + (region ? ` on ${region}` : "");
    this.doing.style.setProperty("--mode", MODE_COLORS[state.mode]);
    const at = state.place.map((value, axis) => this.placeText(value + this.data.origin[axis]));
    this.cells[0].textContent = at.join(", ");
    this.cells[1].textContent = figures(Math.hypot(...state.velocity));
    this.cells[2].textContent = figures(Math.hypot(...state.spin));
  }
}

function fillHeader(data, motion) {
  document.getElementById("title").textContent = data.title;
  document.title = data.title;
  const { sphere } = data;
  const count = data.switches.time.length;
  document.getElementById("summary").textContent =
    `${data.states.time.length} outputs, ${count} ${count === 1 ? "switch" : "switches"}, up to t = ` +
    `${figures(motion.end, 6)} s; sphere of ${figures(sphere.mass)} kg, radius ${figures(sphere.radius)} m`;
  const notes = data.leftOut.map((text) => text[0].toUpperCase() + text.slice(1) + ".");
  if (data.ended) notes.unshift(`The run was not finished: ${data.ended}.`);
  if (motion.empty) notes.unshift("Nothing of the motion was recorded.");
  document.getElementById("notes").append(...notes.map((text) => {
    const note = document.createElement("p");
    note.textContent = text;
    return note;
  }));
}
