// Puts the page together.

function makeView(motion, data) {
  try {
    return new View(motion, data);
  } catch (error) {
    document.getElementById("no-view").hidden = false;
    document.getElementById("views").hidden = true;
    document.querySelectorAll("#stage > canvas").forEach((canvas) => canvas.remove());
    return null;
  }
}

function connectViews(view, player) {
  const buttons = [...document.querySelectorAll("#views button")];
  const choose = (mode) => {
    view.setMode(mode);
    buttons.forEach((button) => button.classList.toggle("chosen", button.dataset.view === mode));
    player.changed();
  };
  buttons.forEach((button) => button.addEventListener("click", () => choose(button.dataset.view)));
  return choose;
}

/** The time of a link such as page.html#t=1.5; NaN where it has none. */
function timeOfLink() {
  const match = /[#&]t=([^&]+)/.exec(window.location.hash);
  return match ? Number(match[1]) : NaN;
}

/**
 * window.hybridSphere, for tests and for the console of a browser:
 *   seek(t), play(), pause()    t [s]
 *   time, playing, begin, end   what is shown, whether it goes on, the run's first and last time [s]
 *   state()                     what is shown: time, position [m], orientation [x, y, z, w], velocity [m/s],
 *                               spin [rad/s], slip [m/s], energy [J], mode, region; null where nothing was recorded
 *   switches                    the times of the switches [s]
 *   view(mode)                  "whole", "follow" or "above"
 *   hasView                     whether there is WebGL
 *   firstFrame                  when the first picture was there, since the page was called [ms]; 0 before
 *   settled                     whether all that comes after it is there: plots and names of regions
 */
function makeHandle(data, motion, player, view, choose) {
  const state = () => {
    if (motion.empty) return null;
    const { place, mode, region, ...rest } = motion.at(player.time);
    return Object.assign(rest, {
      position: place.map((value, axis) => value + data.origin[axis]),
      mode: MODES[mode],
      region: data.names[region],
    });
  };
  return {
    seek: (time) => player.seek(time),
    play: () => player.play(),
    pause: () => player.pause(),
    get time() { return player.time; },
    get playing() { return player.playing; },
    begin: motion.begin,
    end: motion.end,
    state,
    switches: Array.from(data.switches.time),
    view: choose,
    hasView: view !== null,
    firstFrame: 0,
    settled: false,
  };
}

/** Draws whenever something has changed, at most once a frame. */
function keepDrawing(parts, player, motion) {
  let waits = false;
  const draw = (now) => {
    waits = false;
    if (player.playing) player.tick(now);
    const state = motion.empty ? null : motion.at(player.time);
    parts.forEach((part) => part(state, player.time));
    if (!window.hybridSphere.firstFrame) window.hybridSphere.firstFrame = performance.now();
    if (player.playing) request();
  };
  const request = () => {
    if (waits) return;
    waits = true;
    requestAnimationFrame(draw);
  };
  player.listeners.push(request);
  return request;
}

function afterFirstFrame(action) {
  requestAnimationFrame(() => setTimeout(action, 0));
}

function start() {
  const data = readData();
  const motion = new Motion(data);
  const player = new Player(motion);
  const view = makeView(motion, data);
  fillHeader(data, motion);
  fillLegend(data, motion, view);
  connectButtons(player);
  connectKeys(player);
  const timeline = new Timeline(motion, player);
  let plots = null;
  const table = new SwitchTable(data, motion, player);
  const readout = new Readout(data, motion);
  const choose = view ? connectViews(view, player) : () => {};
  window.hybridSphere = makeHandle(data, motion, player, view, choose);
  const request = keepDrawing([
    (state) => { if (view) view.show(state); },
    (state, time) => readout.show(time, state),
    () => timeline.show(),
    (state) => { if (plots) plots.show(state); },
    (state, time) => table.show(time),
  ], player, motion);
  const resize = () => {
    if (view) view.resize();
    timeline.resize();
    if (plots) plots.resize();
    request();
  };
  window.addEventListener("resize", resize);
  window.addEventListener("hashchange", () => player.seek(timeOfLink()));
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  if (dark.addEventListener) dark.addEventListener("change", () => { if (view) view.setSky(); resize(); });
  player.seek(timeOfLink());
  resize();
  if (view) {
    choose(data.sphere.radius < SMALL_SPHERE * data.view ? "follow" : "whole");
    view.controls.addEventListener("change", request);
    document.getElementById("legend").addEventListener("toggle", () => { view.width = 0; resize(); });
  }
  // What may come after the first picture.
  afterFirstFrame(() => {
    plots = new Plots(motion, player);
    if (view) {
      view.showRest();
      view.labels = new Labels(data);
    }
    resize();
    requestAnimationFrame(() => { window.hybridSphere.settled = true; });
  });
}
