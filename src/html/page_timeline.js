// The player, the time line and the buttons.

/** A pen for a canvas whose pixels are those of the screen. */
function sized(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const pen = canvas.getContext("2d", { willReadFrequently: true });
  canvas.width = Math.max(1, Math.round(canvas.clientWidth * ratio));
  canvas.height = Math.max(1, Math.round(canvas.clientHeight * ratio));
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  return pen;
}

/** Calls a function with the x of a click, and of every place to which it is dragged. */
function onDrag(element, call) {
  let pressed = false;
  const tell = (event) => call(event.clientX - element.getBoundingClientRect().left);
  element.addEventListener("pointerdown", (event) => {
    pressed = true;
    element.setPointerCapture(event.pointerId);
    tell(event);
  });
  element.addEventListener("pointermove", (event) => { if (pressed) tell(event); });
  for (const end of ["pointerup", "pointercancel"]) element.addEventListener(end, () => { pressed = false; });
}

/** The time that is shown, and how fast it goes. */
class Player {
  constructor(motion) {
    this.motion = motion;
    this.time = motion.begin;
    this.playing = false;
    this.listeners = [];
    this.speed = this.usualSpeed();
  }

  /** 1, unless the run is then over in a moment or takes long. */
  usualSpeed() {
    const duration = this.motion.end - this.motion.begin;
    if (!(duration > 0) || (duration >= 3 && duration <= 60)) return 1;
    return roundStep(duration / 20);
  }

  seek(time) {
    const { begin, end } = this.motion;
    this.time = Math.min(end, Math.max(begin, Number.isFinite(time) ? time : begin));
    this.changed();
  }

  play() {
    if (this.time >= this.motion.end) this.time = this.motion.begin;
    this.playing = true;
    this.last = performance.now();
    this.changed();
  }

  pause() {
    this.playing = false;
    this.changed();
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  /** To the next switch, or with -1 to the one before. */
  step(direction) {
    const { time } = this.motion.data.switches;
    const at = lastNotAfter(time, this.time);
    const next = direction > 0 ? at + 1 : time[at] < this.time ? at : lastNotAfter(time, this.time * (1 - 1e-15) - 1e-300);
    const earlier = direction < 0 && time[next] === this.time ? next - 1 : next;
    if (earlier >= 0 && earlier < time.length) this.seek(time[earlier]);
    else this.seek(direction > 0 ? this.motion.end : this.motion.begin);
  }

  /** Goes on with the clock; called once a frame. */
  tick(now) {
    if (!this.playing) return;
    const time = this.time + (Math.min(250, now - this.last) / 1000) * this.speed;
    this.last = now;
    if (time >= this.motion.end) this.playing = false;
    this.seek(time);
  }

  changed() {
    this.listeners.forEach((listener) => listener());
  }
}

class Timeline {
  constructor(motion, player) {
    this.motion = motion;
    this.player = player;
    this.canvas = document.getElementById("timeline");
    this.margin = 9;
    onDrag(this.canvas, (x) => player.seek(this.timeAt(x)));
    this.canvas.setAttribute("aria-valuemin", motion.begin);
    this.canvas.setAttribute("aria-valuemax", motion.end);
  }

  xOf(time) {
    const { begin, end } = this.motion;
    return this.margin + (end > begin ? (time - begin) / (end - begin) : 0) * (this.width - 2 * this.margin);
  }

  timeAt(x) {
    const { begin, end } = this.motion;
    return begin + ((x - this.margin) / (this.width - 2 * this.margin)) * (end - begin);
  }

  resize() {
    this.pen = sized(this.canvas);
    this.width = this.canvas.clientWidth;
    this.height = this.canvas.clientHeight;
    this.style = getComputedStyle(document.documentElement);
    this.show();
  }

  show() {
    const { pen, width, height } = this;
    if (!width) return;
    const color = (name) => this.style.getPropertyValue(name);
    const middle = 15;
    const x = this.xOf(this.player.time);
    this.canvas.setAttribute("aria-valuenow", this.player.time);
    pen.clearRect(0, 0, width, height);
    pen.fillStyle = color("--line");
    pen.fillRect(this.margin, middle - 2, width - 2 * this.margin, 4);
    pen.fillStyle = color("--accent");
    pen.fillRect(this.margin, middle - 2, x - this.margin, 4);
    this.drawMarks(pen, middle);
    this.drawTicks(pen, color("--dim"));
    pen.fillStyle = color("--accent");
    pen.strokeStyle = color("--card");
    pen.lineWidth = 2;
    pen.beginPath();
    pen.arc(x, middle, 7, 0, 2 * Math.PI);
    pen.fill();
    pen.stroke();
  }

  drawMarks(pen, middle) {
    const { time, kind } = this.motion.data.switches;
    let last = -Infinity;
    for (let i = 0; i < time.length; i++) {
      const x = this.xOf(time[i]);
      if (x - last < 0.4) continue;
      last = x;
      pen.fillStyle = KIND_COLORS[kind[i]];
      pen.fillRect(x - 1, middle - 9, 2, 18);
    }
  }

  drawTicks(pen, color) {
    const { begin, end } = this.motion;
    if (!(end > begin)) return;
    const step = roundStep(((end - begin) * 70) / this.width);
    pen.fillStyle = color;
    pen.font = "10px system-ui, sans-serif";
    pen.textBaseline = "bottom";
    for (let n = Math.ceil(begin / step); n * step <= end * (1 + 1e-12); n++) {
      const x = this.xOf(n * step);
      pen.textAlign = x < 20 ? "left" : x > this.width - 20 ? "right" : "center";
      pen.fillText(figures(n * step, 6), x, this.height - 1);
      pen.fillRect(x - 0.5, 27, 1, 4);
    }
  }
}

function fillSpeeds(player) {
  const select = document.getElementById("speed");
  const speeds = [0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30, 100].map((factor) => {
    const base = player.speed === 1 ? 1 : player.speed;
    return factor * base;
  });
  for (const speed of new Set([...speeds, 1].sort((a, b) => a - b).map((value) => Number(value.toPrecision(3))))) {
    const option = new Option(`${figures(speed, 3)}\u00d7`, speed);
    option.selected = Math.abs(speed - player.speed) < 1e-9 * speed;
    select.append(option);
  }
  select.addEventListener("change", () => { player.speed = Number(select.value); });
}

function connectButtons(player) {
  const play = document.getElementById("play");
  const shape = document.getElementById("play-shape");
  play.addEventListener("click", () => player.toggle());
  document.getElementById("earlier").addEventListener("click", () => player.step(-1));
  document.getElementById("later").addEventListener("click", () => player.step(1));
  player.listeners.push(() => {
    shape.setAttribute("d", player.playing ? "M4 2h3v12H4zM9 2h3v12H9z" : "M4 2l10 6-10 6z");
    play.setAttribute("aria-label", player.playing ? "pause" : "play");
  });
  fillSpeeds(player);
}

function connectKeys(player) {
  const step = () => (player.motion.end - player.motion.begin) / 200;
  const actions = {
    " ": () => player.toggle(),
    ArrowLeft: () => player.seek(player.time - step()),
    ArrowRight: () => player.seek(player.time + step()),
    ArrowDown: () => player.step(-1),
    ArrowUp: () => player.step(1),
    Home: () => player.seek(player.motion.begin),
    End: () => player.seek(player.motion.end),
  };
  document.addEventListener("keydown", (event) => {
    const isOther = event.ctrlKey || event.altKey || event.metaKey || event.target.tagName === "SELECT";
    if (isOther || !actions[event.key]) return;
    if (event.key === " " && event.target.tagName === "SUMMARY") return;
    event.preventDefault();
    if (event.target.tagName === "BUTTON") event.target.blur();
    actions[event.key]();
  });
}
