// The table of the switches; a click on a row goes to its time.

const ROWS_AT_ONCE = 200;

function cell(text, className) {
  const element = document.createElement("td");
  element.textContent = text;
  if (className) element.className = className;
  return element;
}

class SwitchTable {
  constructor(data, motion, player) {
    this.switches = data.switches;
    this.names = data.names;
    this.player = player;
    this.motion = motion;
    this.rows = [];
    this.decimals = decimalsOf(motion.end - motion.begin);
    this.frame = document.getElementById("table-frame");
    if (data.switches.time.length === 0) {
      document.getElementById("switches").hidden = true;
      return;
    }
    const table = document.getElementById("table");
    table.innerHTML = '<thead><tr><th class="number">t [s]</th><th>what</th><th>ground</th>' +
      '<th class="number" title="of the ground on the sphere">impulse<br>[N s]</th><th class="number">energy<br>lost [J]</th></tr></thead>';
    this.body = table.createTBody();
    this.addRows();
  }

  /** Some at once, so that the page is there before the last one. */
  addRows() {
    const end = Math.min(this.rows.length + ROWS_AT_ONCE, this.switches.time.length);
    while (this.rows.length < end) this.addRow(this.rows.length);
    if (end < this.switches.time.length) setTimeout(() => this.addRows(), 0);
  }

  addRow(i) {
    const { time, kind, cause, from, to, impulse, lost } = this.switches;
    const row = this.body.insertRow();
    const what = cell("");
    const dot = document.createElement("span");
    dot.className = "dot";
    dot.style.background = KIND_COLORS[kind[i]];
    const why = document.createElement("div");
    why.className = "cause";
    why.textContent = CAUSES[cause[i]] || "";
    what.append(dot, KINDS[kind[i]], why);
    const ground = from[i] === to[i] ? this.names[to[i]] : `${this.names[from[i]] || "\u2013"} \u2192 ${this.names[to[i]]}`;
    row.append(cell(time[i].toFixed(this.decimals), "number"), what, cell(ground, "text"),
      cell(figures(Math.hypot(impulse[3 * i], impulse[3 * i + 1])), "number"), cell(figures(this.isRounding(i) ? 0 : lost[i], 3), "number"));
    row.addEventListener("click", () => this.player.seek(time[i]));
    this.rows.push(row);
  }

  /** Whether what is lost is no more than the rounding of the energy. */
  isRounding(i) {
    const { velocity, spin, lost } = this.switches;
    const energy = this.motion.energy([...velocity.subarray(4 * i, 4 * i + 2), ...spin.subarray(6 * i, 6 * i + 3)]);
    return Math.abs(lost[i]) < 1e-12 * energy;
  }

  /** Marks the last switch that is not after a time. */
  show(time) {
    const at = lastNotAfter(this.switches.time, time);
    if (at === this.chosen) return;
    if (this.rows[this.chosen]) this.rows[this.chosen].className = "";
    this.chosen = at;
    const row = this.rows[at];
    if (!row) return;
    row.className = "chosen";
    const above = row.offsetTop - this.frame.scrollTop;
    const isSeen = above > row.offsetHeight && above + row.offsetHeight < this.frame.clientHeight;
    if (!isSeen) this.frame.scrollTop = row.offsetTop - this.frame.clientHeight / 2;
  }
}
