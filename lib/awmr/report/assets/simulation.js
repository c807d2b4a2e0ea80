// Section of the simulations: each scenario in all modes. The charts of a scenario share one legend
// and one cursor.

const signals = [
  {title: "heading", y: "heading ψ, deg", value: "psi_deg", reference: "psi_ref_deg"},
  {title: "speed", y: "speed, m/s", value: "u_mps", reference: "u_ref_mps", zero: "y"},
  {title: "force, left wheels", y: "F′L", value: "force_left", zero: "y"},
  {title: "force, right wheels", y: "F′R", value: "force_right", zero: "y"},
  {title: "steering angle", y: "steering δ, deg", value: "steering_deg"},
  {title: "sideslip", y: "sideslip, deg", value: "sideslip_deg"},
  {title: "yaw rate", y: "yaw rate, deg/s", value: "r_degps"},
];
const referenceLook = {name: "reference", kind: "line", colour: "var(--dim)", width: 1.2};
const obstacleLook = {name: "obstacle", kind: "circle", colour: "var(--dim)"};
const nameOf = (run) => run.mode + (run.gains === "paper" ? ", the paper's gains" : "");
/// Order of the runs: first by gains, with the tuned ones first, then by mode.
const byMode = (a, b) => (a.gains === b.gains ? modes.indexOf(a.mode) - modes.indexOf(b.mode)
  : a.gains === "tuned" ? -1 : 1);

/// Series of a run for a chart: its column y over its column x. The mode determines the hue, the
/// set of gains the dashes. Runs with the paper's gains are hidden at first.
function lineOf(run, x, y) {
  const points = run.columns[x].map((value, i) => [value, run.columns[y][i]]);
  const look = {name: nameOf(run), kind: "line", points, ...modeStyle[run.mode]};
  return run.gains === "tuned" ? look : {...look, width: 1.4, dash: gainsStyle.paper.dash,
    opacity: 1, hidden: true};
}
function referenceOf(run, x, y) {
  return {...referenceLook, points: run.columns[x].map((v, i) => [v, run.columns[y][i]])};
}

/// The points of a scenario's path: the waypoints, or the corners of a line.
function waypointsOf(scenario) {
  const guidance = (scenario || {}).guidance || {};
  if (Array.isArray(guidance.points_m)) return guidance.points_m;
  return guidance.from_m && guidance.to_m ? [guidance.from_m, guidance.to_m] : [];
}

/// Shade for yaw rates above the highest one at which yaw resistance was measured, where the model
/// extrapolates. A list with one series, or empty if yaw resistance was not measured.
function extrapolatedYawRates() {
  const limit = report.yaw_rate_measured_degps;
  return isNumber(limit) ? [{name: `extrapolated, beyond ±${digits(limit)} deg/s`, kind: "shade",
    limit, colour: "var(--shade)"}] : [];
}

function scenarioPart(parent, stem, runs, scenario, open) {
  const box = folded(parent, scenarioWords(stem), open);
  const group = [];
  const first = runs[0];
  // With guidance, each run has its own heading reference; otherwise all runs share one.
  const sameHeading = !(scenario && scenario.guidance) || scenario.guidance.type === "heading";
  const entries = runs.map((run) => lineOf(run, "t_s", "psi_deg"));
  const points = waypointsOf(scenario).filter((p) => Array.isArray(p));
  const circles = ((scenario || {}).obstacles || []).map((o) =>
    ({x: o.x_m, y: o.y_m, radius: o.radius_m, name: obstacleLook.name}));
  const course = {name: points.length > 2 ? "waypoints" : "ends of the line", kind: "points",
    shape: "cross", points, colour: "var(--ink)"};
  const shade = extrapolatedYawRates().filter(({limit}) =>
    runs.some((run) => run.columns.r_degps.some((r) => Math.abs(r) > limit)));
  legend(box, [...entries, referenceLook, ...(points.length ? [course] : []),
    ...(circles.length ? [obstacleLook] : []), ...shade], group);
  const grid = add(box, "div", undefined, {class: "grid"});
  plot(grid, {title: "path", x: "x, m", y: "y, m", equal: true, legend: false, group, circles,
    series: [
    ...runs.map((run) => lineOf(run, "x_m", "y_m")),
    course]});
  for (const signal of signals) {
    if (signal.value === "steering_deg" && !isSteered(report.model.vehicle)) continue;
    const series = runs.map((run) => lineOf(run, "t_s", signal.value));
    if (signal.reference && (sameHeading
      || signal.value !== "psi_deg")) series.push(referenceOf(first, "t_s", signal.reference));
    if (signal.value === "r_degps") series.push(...shade);
    plot(grid, {title: signal.title, x: "t, s", y: signal.y, legend: false, group, series,
      height: 220, zero: signal.zero || "", least: 0.1});
  }
}

function simulationSection(data) {
  if (!data.runs.length) return;
  const box = section("Simulations",
    "Path plots use equal scales. Drag over a chart to zoom it and its neighbours, double-click " +
    "to reset.");
  // Same order as in the comparison.
  const names = ((data.comparison || {}).scenarios || []).map((s) => s.name);
  const place = (stem) => names.indexOf((data.scenarios[stem] || {}).name);
  const byScenario = [...groupBy(data.runs, (run) => run.scenario)].sort((a, b) =>
    place(a[0]) - place(b[0]));
  byScenario.forEach(([stem, runs], i) => {
    scenarioPart(box, stem, [...runs].sort(byMode), data.scenarios[stem], i === 0 && isWide);
  });
}
