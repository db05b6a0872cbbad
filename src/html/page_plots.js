// Plots against time, with a cursor; a click seeks. At a switch both sides are drawn.

const PLOT_LEFT = 52;
const PLOT_RIGHT = 6;

/** Times and values of a quantity at both sides of every knot. */
function seriesOf(motion, valueOf) {
  const { knots } = motion;
  const series = [];
  for (let i = 0; i < knots.size; i++) {
    const at = VELOCITIES * i;
    if (knots.isSwitch[i]) series.push([knots.time[i], valueOf(knots.before.subarray(at, at + VELOCITIES), i, true)]);
    series.push([knots.time[i], valueOf(knots.after.subarray(at, at + VELOCITIES), i, false)]);
  }
  return series;
}

function plotsOf(motion) {
  const slipOf = (velocities, i, isBefore) => {
    const place = [motion.knots.position[2 * i], motion.knots.position[2 * i + 1]];
    const from = isBefore ? Math.max(0, i - 1) : i;
    return Math.hypot(...motion.slip(Array.from(velocities), place, motion.modeOn(from), motion.knots.region[from]));
  };
  const plots = [
    { name: "speed", unit: "m/s", color: "#1f6feb", valueOf: (v) => Math.hypot(v[0], v[1]),
      now: (state) => Math.hypot(...state.velocity) },
    { name: "spin", unit: "rad/s", color: "#e8590c", valueOf: (v) => Math.hypot(v[2], v[3], v[4]),
      now: (state) => Math.hypot(...state.spin) },
    { name: "kinetic energy", unit: "J", color: "#2b8a3e", valueOf: (v) => motion.energy(Array.from(v)),
      now: (state) => state.energy },
    { name: "slip of the contact", unit: "m/s", color: "#e03131", valueOf: slipOf,
      now: (state) => Math.hypot(...state.slip) },
  ];
  plots.forEach((plot) => { plot.series = seriesOf(motion, plot.valueOf); });
  return plots.filter((plot, i) => i < 3 || plot.series.some(([, value]) => value > 0));
}

/** What is to be seen of the values: from 0, unless they are all near each other. */
function rangeOf(series) {
  let low = Infinity;
  let high = -Infinity;
  for (const [, value] of series) {
    if (value < low) low = value;
    if (value > high) high = value;
  }
  if (!(high > 0)) return [0, 1];
  if (high - low > 0.25 * high || high - low < 1e-9 * high) return [0, 1.08 * high];
  const margin = 0.12 * (high - low);
  return [low - margin, high + margin];
}

class Plot {
  constructor(motion, plot, player) {
    Object.assign(this, plot);
    this.motion = motion;
    this.player = player;
    this.range = rangeOf(this.series);
    const element = document.createElement("div");
    element.className = "plot";
    element.innerHTML = '<div class="head"><span><b></b> <span class="unit"></span></span><span class="value"></span></div>' +
      '<div class="frame"><canvas></canvas><canvas></canvas></div>';
    element.querySelector("b").textContent = this.name;
    element.querySelector(".unit").textContent = `[${this.unit}]`;
    this.value = element.querySelector(".value");
    [this.canvas, this.cursor] = element.querySelectorAll("canvas");
    this.canvas.dataset.plot = this.name;
    this.element = element;
    onDrag(this.canvas, (x) => player.seek(this.timeAt(x)));
  }

  xOf(time) {
    const { begin, end } = this.motion;
    return PLOT_LEFT + (end > begin ? (time - begin) / (end - begin) : 0) * (this.width - PLOT_LEFT - PLOT_RIGHT);
  }

  timeAt(x) {
    const { begin, end } = this.motion;
    return begin + ((x - PLOT_LEFT) / (this.width - PLOT_LEFT - PLOT_RIGHT)) * (end - begin);
  }

  yOf(value) {
    const [low, high] = this.range;
    return this.height - 6 - ((value - low) / (high - low)) * (this.height - 12);
  }

  resize() {
    this.pen = sized(this.canvas);
    this.cursorPen = sized(this.cursor);
    this.width = this.canvas.clientWidth;
    this.height = this.canvas.clientHeight;
    this.draw();
  }

  draw() {
    const { pen } = this;
    const style = getComputedStyle(document.documentElement);
    const line = style.getPropertyValue("--line");
    pen.clearRect(0, 0, this.width, this.height);
    pen.font = "10px system-ui, sans-serif";
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    this.drawSwitches(line);
    const step = roundStep((this.range[1] - this.range[0]) / 3);
    for (let n = Math.ceil(this.range[0] / step); n * step <= this.range[1]; n++) {
      const y = Math.round(this.yOf(n * step)) + 0.5;
      pen.fillStyle = style.getPropertyValue("--dim");
      pen.fillText(figures(n * step, 3), PLOT_LEFT - 5, y);
      pen.fillStyle = line;
      pen.fillRect(PLOT_LEFT, y, this.width - PLOT_LEFT - PLOT_RIGHT, 1);
    }
    pen.strokeStyle = this.color;
    pen.lineWidth = 1.6;
    pen.lineJoin = "round";
    pen.beginPath();
    this.series.forEach(([time, value], i) => pen[i ? "lineTo" : "moveTo"](this.xOf(time), this.yOf(value)));
    pen.stroke();
  }

  drawSwitches(color) {
    const { time, kind } = this.motion.data.switches;
    if (time.length > 300) return;
    for (let i = 0; i < time.length; i++) {
      this.pen.fillStyle = KIND_COLORS[kind[i]];
      this.pen.globalAlpha = 0.35;
      this.pen.fillRect(this.xOf(time[i]) - 0.5, 2, 1, this.height - 4);
      this.pen.globalAlpha = 1;
    }
  }

  show(state) {
    if (!this.width || !state) return;
    this.value.textContent = figures(this.now(state));
    const pen = this.cursorPen;
    const x = this.xOf(state.time);
    pen.clearRect(0, 0, this.width, this.height);
    pen.fillStyle = getComputedStyle(document.documentElement).getPropertyValue("--ink");
    pen.fillRect(x - 0.5, 0, 1, this.height);
    pen.fillStyle = this.color;
    pen.beginPath();
    pen.arc(x, this.yOf(this.now(state)), 3.5, 0, 2 * Math.PI);
    pen.fill();
  }
}

class Plots {
  constructor(motion, player) {
    this.plots = motion.empty ? [] : plotsOf(motion).map((plot) => new Plot(motion, plot, player));
    document.getElementById("plots").append(...this.plots.map((plot) => plot.element));
  }

  resize() {
    this.plots.forEach((plot) => plot.resize());
  }

  show(state) {
    this.plots.forEach((plot) => plot.show(state));
  }
}
