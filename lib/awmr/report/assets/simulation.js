// Simulations: a scenario in all modes; all of its charts share one legend and one cursor.

const signals = [
  {title: "heading", y: "heading, deg", value: "psi_deg", reference: "psi_ref_deg"},
  {title: "speed", y: "speed, m/s", value: "u_mps", reference: "u_ref_mps"},
  {title: "force, left wheels", y: "F'L", value: "force_left"},
  {title: "force, right wheels", y: "F'R", value: "force_right"},
  {title: "steering angle", y: "steering, deg", value: "steering_deg"},
  {title: "sideslip", y: "sideslip, deg", value: "sideslip_deg"},
  {title: "yaw rate", y: "yaw rate, deg/s", value: "r_degps"},
];
const gainsWords = {tuned: "", paper: ", the paper's gains"};
const referenceLook = {name: "reference", kind: "line", colour: "var(--dim)", width: 1.2, dash: [4, 3]};
const obstacleLook = {name: "obstacle", kind: "circle", colour: "var(--bad)"};
const nameOf = (run) => run.mode + gainsWords[run.gains];

function lineOf(run, x, y) {
  const points = run.columns[x].map((value, i) => [value, run.columns[y][i]]);
  const look = modeStyle[run.mode];
  return run.gains === "tuned" ? {name: nameOf(run), kind: "line", points, ...look}
    : {name: nameOf(run), kind: "line", points, ...look, width: 1.2, dash: [2, 3], opacity: 1, hidden: true};
}
function referenceOf(run, x, y) {
  return {...referenceLook, points: run.columns[x].map((v, i) => [v, run.columns[y][i]])};
}

/// The points of the path: waypoints or the ends of a line.
function waypointsOf(scenario) {
  const guidance = (scenario || {}).guidance || {};
  if (Array.isArray(guidance.points_m)) return guidance.points_m;
  return guidance.from_m && guidance.to_m ? [guidance.from_m, guidance.to_m] : [];
}

function scenarioPart(parent, stem, runs, scenario, open) {
  const details = add(parent, "details");
  details.open = open;
  add(details, "summary", scenario && scenario.name && scenario.name !== stem ? `${scenario.name} (${stem})` : stem);
  const group = [];
  const box = add(details, "div");
  const first = runs[0];
  // With guidance, each run has its own heading reference; without it, the reference is the same
  // for all.
  const sameHeading = !(scenario && scenario.guidance) || scenario.guidance.type === "heading";
  const entries = runs.map((run) => lineOf(run, "t_s", "psi_deg"));
  const points = waypointsOf(scenario).filter((p) => Array.isArray(p));
  const circles = ((scenario || {}).obstacles || []).map((o) => ({x: o.x_m, y: o.y_m, radius: o.radius_m, name: obstacleLook.name}));
  const course = {name: points.length > 2 ? "waypoints" : "ends of the line", kind: "points", shape: "cross", points, colour: "var(--ink)"};
  legend(box, [...entries, referenceLook, ...(points.length ? [course] : []), ...(circles.length ? [obstacleLook] : [])], group);
  const grid = add(box, "div", undefined, {class: "grid"});
  plot(grid, {title: "path", x: "x, m", y: "y, m", equal: true, legend: false, group, circles, series: [
    ...runs.map((run) => lineOf(run, "x_m", "y_m")),
    course]});
  for (const signal of signals) {
    const series = runs.map((run) => lineOf(run, "t_s", signal.value));
    if (signal.reference && (sameHeading || signal.value !== "psi_deg")) series.push(referenceOf(first, "t_s", signal.reference));
    plot(grid, {title: signal.title, x: "t, s", y: signal.y, legend: false, group, series, height: 220});
  }
}

function simulationSection(data) {
  if (!data.runs.length) return;
  const box = section("Simulations", "The paths' axes are equal. A drag over a chart enlarges it and those beside it, a double click takes that back.");
  // Same order as in the comparison.
  const names = ((data.comparison || {}).scenarios || []).map((s) => s.name);
  const place = (stem) => names.indexOf((data.scenarios[stem] || {}).name);
  const byScenario = [...groupBy(data.runs, (run) => run.scenario)].sort((a, b) => place(a[0]) - place(b[0]));
  byScenario.forEach(([stem, runs], i) => {
    const ordered = [...runs].sort((a, b) => (a.gains === b.gains ? modes.indexOf(a.mode) - modes.indexOf(b.mode) : a.gains === "tuned" ? -1 : 1));
    scenarioPart(box, stem, ordered, data.scenarios[stem], i === 0 && innerWidth > 640);
  });
}
