// Interactive gains: the program's own simulator and constraints, compiled to WebAssembly, run at
// every move of a slider.

const liveColumns = ["t_s", "psi_rad", "psi_ref_rad", "u_mps", "force_left", "force_right", "steering_rad", "r_radps"];
/// Gains and other adjustable values; `log`: the slider has a logarithmic scale.
const liveSliders = [
  {key: "lambda", name: "lambda, 1/s", low: 0.5, high: 15, log: true}, {key: "mu", name: "mu, rad/s²", low: 1, high: 200, log: true},
  {key: "epsilon", name: "epsilon, rad/s", low: 0.1, high: 50, log: true}, {key: "speed_mu", name: "mu_s, m/s²", low: 0.5, high: 100, log: true},
  {key: "speed_epsilon", name: "epsilon_s, m/s", low: 0.05, high: 10, log: true},
  {key: "observer", name: "observer's bandwidth, rad/s", low: 0.2, high: 20, log: true},
  {key: "sample_time_s", name: "sample time, s", low: 0.002, high: 0.1, log: true},
  {key: "mass", name: "mass, times the model's", low: 0.5, high: 2, log: true},
  {key: "friction", name: "friction, times the model's", low: 0.5, high: 2, log: true},
  {key: "heading_noise_deg", name: "heading noise, deg", low: 0, high: 5, log: false},
];

/// Loads the module, initialised with the setup's numbers; returns a function from settings to
/// {rows, constraints, metrics, ended}.
async function liveModule(packed, numbers) {
  const bytes = Uint8Array.from(atob(packed), (c) => c.charCodeAt(0));
  const wasm = await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
  // The C library needs system functions that are never used: every call returns "not available".
  const system = new Proxy({}, {get: () => () => 52});
  const {exports} = (await WebAssembly.instantiate(wasm, {wasi_snapshot_preview1: system})).instance;
  exports._initialize();
  const room = exports.live_setup(numbers.length);
  new Float64Array(exports.memory.buffer, room, numbers.length).set(numbers);
  exports.live_begin();
  return (s) => {
    const ended = exports.live_run(s.lambda, s.mu, s.epsilon, s.speed_mu, s.speed_epsilon, s.observer || 0, modes.indexOf(s.mode), s.sample_time_s,
      s.mass, s.friction, s.heading_noise_deg);
    const text = new TextDecoder().decode(new Uint8Array(exports.memory.buffer, exports.live_text(), exports.live_size()).slice());
    const table = new Float64Array(exports.memory.buffer, exports.live_table(), exports.live_rows() * liveColumns.length).slice();
    const columns = Object.fromEntries(liveColumns.map((name, i) => [name, Array.from({length: exports.live_rows()}, (_, k) => table[k * liveColumns.length + i])]));
    return {columns, ended: Boolean(ended), ...JSON.parse(text)};
  };
}

/// The gains in the form that --gains accepts; `observer`: the tuned one, if any.
function gainsDocument(s, observer) {
  const gains = {schema: "awmr.gains/1", heading: {lambda: s.lambda, mu: s.mu, epsilon: s.epsilon}, speed: {mu: s.speed_mu, epsilon: s.speed_epsilon}};
  return observer ? {...gains, observer: {...observer, bandwidth_radps: s.observer}} : gains;
}

function liveSlider(parent, slider, settings, changed) {
  const row = add(parent, "label", undefined, {class: "slider"});
  add(row, "span", slider.name);
  const input = add(row, "input", undefined, {type: "range", min: 0, max: 1000, step: 1});
  const shown = add(row, "output");
  const low = Math.min(slider.low, settings[slider.key]), high = Math.max(slider.high, settings[slider.key]);
  const place = () => 1000 * (slider.log ? Math.log(settings[slider.key] / low) / Math.log(high / low) : (settings[slider.key] - low) / (high - low));
  const show = () => {
    input.value = place();
    shown.textContent = digits(settings[slider.key], 4);
  };
  input.oninput = () => {
    const part = input.value / 1000;
    settings[slider.key] = Number((slider.log ? low * (high / low) ** part : low + part * (high - low)).toPrecision(4));
    shown.textContent = digits(settings[slider.key], 4);
    changed();
  };
  show();
  return show;
}

const degreesOf = (list) => list.map((x) => x * 180 / Math.PI);
const pairs = (x, y) => x.map((v, i) => [v, y[i]]);
/// Reduces a long run to about one row per pixel; keeps the minimum and the maximum of each
/// interval.
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

function liveCharts(parent, start) {
  const grid = add(parent, "div", undefined, {class: "grid"});
  const group = [];
  const line = (name, points, colour, more) => ({name, kind: "line", points: thinned(points), colour, ...more});
  const faint = {width: 1.2, dash: [3, 3]};
  const of = (run, key, scale = (x) => x) => pairs(run.columns.t_s, scale(run.columns[key]));
  const kinds = [
    ["heading", "heading, deg", (run) => [of(run, "psi_rad", degreesOf)], [["reference", of(start, "psi_ref_rad", degreesOf)]]],
    ["speed", "speed, m/s", (run) => [of(run, "u_mps")], []],
    ["steering angle", "steering, deg", (run) => [of(run, "steering_rad", degreesOf)], []],
    ["forces, left and right", "F'", (run) => [of(run, "force_left"), of(run, "force_right")], []],
  ];
  const charts = kinds.map(([title, y, lines, others]) => {
    const names = lines(start).length > 1 ? ["left", "right"] : ["these gains"];
    const series = [...lines(start).map((points, i) => line(names[i], points, ["var(--one)", "var(--two)"][i], {width: 2.2})),
      ...lines(start).map((points, i) => line(names.length > 1 ? `${names[i]}, tuned` : "tuned gains", points, "var(--dim)", faint)),
      ...others.map(([name, points]) => line(name, points, "var(--dim)", {width: 1, dash: [6, 3]}))];
    return {lines, chart: plot(grid, {title, x: "t, s", y, series, group, height: 220})};
  });
  return (run, tuned) => {
    for (const {lines, chart} of charts) {
      [...lines(run), ...lines(tuned)].forEach((points, i) => {
        chart.series[i].points = thinned(points);
        if (chart.view) chart.view.data(`data_${i}`, chart.series[i].points);
      });
      chart.extent = extentOf(chart.series, []);
      if (chart.view) chart.view.signal("view_x", chart.extent.x).signal("view_y", chart.extent.y).run();
    }
  };
}

async function liveSection(data) {
  const packed = document.getElementById("wasm").textContent;
  if (!packed && data.gains) section("Try other gains", "No sliders: this awmr was built without WebAssembly. To have them: scripts/setup all, scripts/build release, then awmr report.");
  if (!packed || !data.live) return;
  const box = section("Try other gains", `${data.live.scenario}, simulated here by the program's own code as you move the sliders. Grey: the tuned gains under the same conditions.`);
  box.parentNode.parentNode.classList.add("live");
  const {heading, speed, observer} = data.gains;
  const gains = {lambda: heading.lambda, mu: heading.mu, epsilon: heading.epsilon, speed_mu: speed.mu, speed_epsilon: speed.epsilon,
    ...(observer && {observer: observer.bandwidth_radps})};
  const tuned = {...gains,
    mode: data.live.modes[data.live.modes.length - 1], sample_time_s: data.live.sample_time_s, mass: 1, friction: 1, heading_noise_deg: 0};
  const settings = {...tuned};
  let run = null;
  try {
    run = await liveModule(packed, data.live.numbers);
  } catch (error) {
    add(box, "p", `This browser cannot run it (${error.message}).`);
    return;
  }
  const controls = add(box, "div", undefined, {class: "controls"});
  const choice = add(controls, "label", undefined, {class: "slider"});
  add(choice, "span", "mode");
  const select = add(choice, "select");
  for (const mode of data.live.modes) add(select, "option", mode);
  select.value = settings.mode;
  const shows = liveSliders.filter((slider) => slider.key in tuned).map((slider) => liveSlider(controls, slider, settings, () => changed()));
  const buttons = add(box, "p");
  const copy = add(buttons, "button", "Copy these gains as JSON", {type: "button"});
  const back = add(buttons, "button", "Back to the tuned gains", {type: "button"});
  const said = add(buttons, "span", "", {role: "status", class: "small"});
  const shownGains = add(box, "pre");
  const redraw = liveCharts(box, run(settings));
  const tables = add(box, "div");
  let waiting = false;
  /// At most one run per frame.
  function changed() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      const result = run(settings);
      const besides = run({...settings, ...gains});
      redraw(result, besides);
      liveTables(tables, result, besides);
      shownGains.textContent = JSON.stringify(gainsDocument(settings, observer));
      said.textContent = result.ended ? "" : " The simulation could not go on: these gains let a number grow without bound.";
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
      await navigator.clipboard.writeText(JSON.stringify(gainsDocument(settings, observer), null, 1));
      said.textContent = " Copied: save them as a file, which simulate, compare and emit take for their gains.";
    } catch {
      said.textContent = " This browser does not let a page copy; the gains stand below.";
    }
  };
  changed();
  window.awmrLive = {run, tuned};  // for access to the page by script
}

function liveTables(parent, result, tuned) {
  parent.textContent = "";
  const state = (c) => (c.margin >= 0 ? "kept" : c.required ? "broken" : "not kept");
  const node = table(parent, ["constraint", "", "#value", "#limit", "#margin", "meaning"], result.constraints.map((c) => [c.name, state(c),
    digits(c.value), digits(c.limit), digits(c.margin, 3), c.meaning]));
  result.constraints.forEach((c, i) => {
    if (!(c.margin >= 0)) node.tBodies[0].rows[i].cells[1].classList.add(c.required ? "error" : "warning");
  });
  const names = Object.keys(result.metrics);
  table(parent, ["figure", "#these gains", "#tuned"], names.map((name) => [metricWords(name), digits(result.metrics[name]), digits(tuned.metrics[name])]));
}
