// Interactive part of the page: at every move of a slider, runs awmr's simulation and constraints,
// compiled to WebAssembly (live/live.cpp).

const liveColumns = ["t_s", "psi_rad", "psi_ref_rad", "u_mps", "force_left", "force_right",
  "steering_rad", "r_radps"];
/// The sliders: gains and other values. `log`: the slider has a logarithmic scale.
const liveSliders = [
  {key: "lambda", name: "lambda, 1/s", low: 0.5, high: 15, log: true},
  {key: "mu", name: "mu, rad/s²", low: 1, high: 200, log: true},
  {key: "epsilon", name: "epsilon, rad/s", low: 0.1, high: 50, log: true},
  {key: "speed_mu", name: "mu_s, m/s²", low: 0.5, high: 100, log: true},
  {key: "speed_epsilon", name: "epsilon_s, m/s", low: 0.05, high: 10, log: true},
  {key: "observer", name: "observer's bandwidth, rad/s", low: 0.2, high: 20, log: true},
  {key: "sample_time_s", name: "sample time, s", low: 0.002, high: 0.1, log: true},
  {key: "mass", name: "mass factor", low: 0.5, high: 2, log: true},
  {key: "friction", name: "friction factor", low: 0.5, high: 2, log: true},
  {key: "heading_noise_deg", name: "heading noise, deg", low: 0, high: 5, log: false},
];

/// Loads the WebAssembly module and passes the numbers of the setup to it. Returns a function that
/// simulates the given slider settings and returns {columns, ended, constraints, metrics}. `ended`
/// is false if the simulation diverges.
async function liveModule(packed, numbers) {
  const bytes = Uint8Array.from(atob(packed), (c) => c.charCodeAt(0));
  const unpacked = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  const wasm = await new Response(unpacked).arrayBuffer();
  // The C library imports system functions that the simulation does not need. Every call returns
  // 52, the error code for "not available" (ENOSYS).
  const system = new Proxy({}, {get: () => () => 52});
  const {exports} = (await WebAssembly.instantiate(wasm,
    {wasi_snapshot_preview1: system})).instance;
  exports._initialize();
  const room = exports.live_setup(numbers.length);
  new Float64Array(exports.memory.buffer, room, numbers.length).set(numbers);
  exports.live_begin();
  return (s) => {
    const ended = exports.live_run(s.lambda, s.mu, s.epsilon, s.speed_mu, s.speed_epsilon,
      s.observer || 0, modes.indexOf(s.mode), s.sample_time_s,
      s.mass, s.friction, s.heading_noise_deg);
    const text = new TextDecoder().decode(new Uint8Array(exports.memory.buffer,
      exports.live_text(), exports.live_size()).slice());
    const table = new Float64Array(exports.memory.buffer, exports.live_table(),
      exports.live_rows() * liveColumns.length).slice();
    const columns = Object.fromEntries(liveColumns.map((name, i) =>
      [name, Array.from({length: exports.live_rows()}, (_, k) =>
        table[k * liveColumns.length + i])]));
    return {columns, ended: Boolean(ended), ...JSON.parse(text)};
  };
}

/// The gains as JSON for --gains. `observer`: the tuned observer, whose limits are kept; null
/// without one.
function gainsDocument(s, observer) {
  const gains = {schema: "awmr.gains/1", heading: {lambda: s.lambda, mu: s.mu, epsilon: s.epsilon},
    speed: {mu: s.speed_mu, epsilon: s.speed_epsilon}};
  return observer ? {...gains, observer: {...observer, bandwidth_radps: s.observer}} : gains;
}

function liveSlider(parent, slider, settings, changed) {
  const row = add(parent, "label", undefined, {class: "slider"});
  write(add(row, "span"), slider.name);
  const input = add(row, "input", undefined, {type: "range", min: 0, max: 1000, step: 1});
  const shown = add(row, "output");
  const low = Math.min(slider.low, settings[slider.key]),
    high = Math.max(slider.high, settings[slider.key]);
  const place = () => 1000 * (slider.log
    ? Math.log(settings[slider.key] / low) / Math.log(high / low)
      : (settings[slider.key] - low) / (high - low));
  const show = () => {
    input.value = place();
    shown.textContent = digits(settings[slider.key], 4);
  };
  input.oninput = () => {
    const part = input.value / 1000;
    settings[slider.key] = Number((slider.log ? low * (high / low) ** part : low +
      part * (high - low)).toPrecision(4));
    shown.textContent = digits(settings[slider.key], 4);
    changed();
  };
  show();
  return show;
}

const degreesOf = (list) => list.map((x) => x * 180 / Math.PI);
const pairs = (x, y) => x.map((v, i) => [v, y[i]]);
/// Reduces a long run to about 2 `most` points: the minimum and the maximum in each of `most`
/// intervals of time.
function thinned(points, most = 500) {
  const stretch = Math.ceil(points.length / most);
  if (stretch < 3) return points;
  const kept = [];
  for (let i = 0; i < points.length; i += stretch) {
    const part = points.slice(i, i + stretch).sort((a, b) => a[1] - b[1]);
    kept.push(...[part[0], part[part.length - 1]].sort((a, b) => a[0] - b[0]));
  }
  return kept;
}

/// Adds two sets of charts under the same conditions: of the run with the slider values, in the hue
/// of its mode, and of the run with the tuned gains, in grey. Returns a function that updates them.
function liveCharts(parent, start) {
  const group = [];
  const line = (name, colour, width) => ({name, kind: "line", colour, width});
  const lines = [line("tuned gains", "var(--dim)", 4), line("these gains", "var(--live)", 1.8)];
  const shade = extrapolatedYawRates();
  const box = add(parent, "div");
  legend(box, [...lines, referenceLook, ...shade], group);
  const grid = add(box, "div", undefined, {class: "grid thirds"});
  const of = (run, key, scale = (x) => x) =>
    thinned(pairs(run.columns.t_s, scale(run.columns[key])));
  const kinds = [["heading", "heading ψ, deg", "psi_rad", degreesOf],
    ["yaw rate", "yaw rate, deg/s", "r_radps", degreesOf],
    ["speed", "speed, m/s", "u_mps"], ["steering angle", "steering δ, deg", "steering_rad",
      degreesOf],
    ["force, left wheels", "F′L", "force_left"], ["force, right wheels", "F′R", "force_right"]]
    .filter(([, , key]) => key !== "steering_rad" || isSteered(report.model.vehicle));
  const charts = kinds.map(([title, y, key, scale]) => {
    const series = lines.map((look) => ({...look, points: of(start, key, scale)}));
    if (key === "psi_rad") series.push({...referenceLook,
      points: of(start, "psi_ref_rad", degreesOf)});
    if (key === "r_radps") series.push(...shade);
    return [key, scale, plot(grid, {title, x: "t, s", y, series, group, legend: false, height: 190,
      zero: scale ? "" : "y"})];
  });
  return (run, tuned, mode) => {
    box.style.setProperty("--live", colourOf(mode));
    for (const [key, scale, chart] of charts) {
      [tuned, run].forEach((one, i) => { chart.series[i].points = of(one, key, scale); });
      chart.extent = extentOf(chart);
      const {view, extent, series} = chart;
      if (!view) continue;
      for (const i of [0, 1]) view.data(`data_${i}`, series[i].points);
      view.signal("view_x", extent.x).signal("view_y", extent.y).run();
    }
  };
}

async function liveSection(data) {
  const packed = document.getElementById("wasm").textContent;
  if (!packed && data.gains) section("Try other gains",
    "This awmr was built without WebAssembly, so the page has no sliders. To get sliders, run " +
    "scripts/setup all, scripts/build release, then awmr report.", "Try gains");
  if (!packed || !data.live) return;
  const box = section("Try other gains",
    `${data.live.scenario}, simulated here by the program's own code as you move the sliders. ` +
    `Grey: the tuned gains${data.gains.modes ? " of combined mode" : ""} under the same conditions.`,
    "Try gains");
  box.parentNode.parentNode.classList.add("live");
  const {heading, speed, observer} = data.gains;
  const gains = {lambda: heading.lambda, mu: heading.mu, epsilon: heading.epsilon,
    speed_mu: speed.mu, speed_epsilon: speed.epsilon,
    ...(observer && {observer: observer.bandwidth_radps})};
  const tuned = {...gains,
    mode: data.live.modes[data.live.modes.length - 1], sample_time_s: data.live.sample_time_s,
      mass: 1, friction: 1, heading_noise_deg: 0};
  const settings = {...tuned};
  let run = null;
  try {
    run = await liveModule(packed, data.live.numbers);
  } catch (error) {
    add(box, "p", `This browser cannot run the simulation (${error.message}).`);
    return;
  }
  const controls = add(box, "div", undefined, {class: "controls"});
  const choice = add(controls, "label", undefined, {class: "slider"});
  add(choice, "span", "mode");
  const select = add(choice, "select");
  for (const mode of data.live.modes) add(select, "option", mode);
  select.value = settings.mode;
  const shows = liveSliders.filter((slider) => slider.key in tuned).map((slider) =>
    liveSlider(controls, slider, settings, () => changed()));
  const buttons = add(box, "p");
  const copy = add(buttons, "button", "Copy these gains as JSON", {type: "button"});
  const back = add(buttons, "button", "Back to the tuned gains", {type: "button"});
  const status = add(buttons, "span", "", {role: "status", class: "small"});
  const shownGains = add(box, "pre");
  const redraw = liveCharts(box, run(settings));
  const tables = add(box, "div");
  let waiting = false;
  /// Handles a change of a slider: runs the simulation at most once per frame of the screen.
  function changed() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      const result = run(settings);
      const comparison = run({...settings, ...gains});
      redraw(result, comparison, settings.mode);
      liveTables(tables, result, comparison);
      shownGains.textContent = JSON.stringify(gainsDocument(settings, observer));
      status.textContent = result.ended ? "" : " The simulation diverges with these gains.";
    });
  }
  select.onchange = () => {
    settings.mode = select.value;
    changed();
  };
  back.onclick = () => {
    Object.assign(settings, tuned, {mode: settings.mode});
    shows.forEach((show) => show());
    changed();
  };
  copy.onclick = async () => {
    try {
      await navigator.clipboard.writeText(JSON.stringify(gainsDocument(settings, observer), null,
        1));
      status.textContent = " Copied. Save them as a file for --gains of simulate, compare and emit.";
    } catch {
      status.textContent = " This browser does not permit copying; the gains are below.";
    }
  };
  changed();
  window.awmrLive = {run, tuned};  // lets scripts, such as the tests, run it
}

function liveTables(parent, result, tuned) {
  parent.textContent = "";
  constraintsTable(parent, result.constraints);
  table(parent, ["metric", "#these gains", "#tuned gains"],
    Object.keys(result.metrics).map((name) => [metricWords(name),
    metricValue(name, result.metrics[name]), metricValue(name, tuned.metrics[name])]));
}
