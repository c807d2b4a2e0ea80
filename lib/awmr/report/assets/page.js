"use strict";
// Draws the report from the results embedded in the page. Text goes in as text nodes only.
const data = JSON.parse(document.getElementById("data").textContent);
const root = document.getElementById("report");
root.textContent = "";
const dark = matchMedia("(prefers-color-scheme: dark)").matches;
const colours = dark ? ["#6ea8ff", "#ffb86b", "#7ee0a1"] : ["#1f6feb", "#c2570c", "#1a7f4b"];
const modes = ["differential", "steering", "combined"];
Chart.defaults.color = dark ? "#9aa6b5" : "#5b6675";
Chart.defaults.borderColor = dark ? "#333c49" : "#e2e6ec";
Chart.defaults.animation = false;

function add(parent, tag, text, attributes) {
  const node = document.createElement(tag);
  if (text !== undefined) node.textContent = text;
  for (const [name, value] of Object.entries(attributes || {})) node.setAttribute(name, value);
  parent.appendChild(node);
  return node;
}
const digits = (x, n) => (x === null || x === undefined ? "–" : Number(x).toPrecision(n || 4));

function table(parent, head, rows, numeric, best) {
  const t = add(add(parent, "div", undefined, {class: "scroll"}), "table");
  const header = add(add(t, "thead"), "tr");
  head.forEach((name, i) => add(header, "th", name, {scope: "col", class: numeric.includes(i) ? "n" : ""}));
  const body = add(t, "tbody");
  rows.forEach((row, k) => {
    const line = add(body, "tr");
    row.forEach((cell, i) => {
      const marks = [numeric.includes(i) ? "n" : "", best && best(k, i) ? "best" : ""].join(" ").trim();
      add(line, "td", cell, {class: marks});
    });
  });
}

function chart(parent, title, x, y, datasets, ratio) {
  const figure = add(parent, "figure");
  const canvas = add(add(figure, "div", undefined, {class: "plot"}), "canvas", undefined,
    {role: "img", "aria-label": title});
  add(figure, "figcaption", title);
  new Chart(canvas, {
    type: "scatter",
    data: {datasets},
    options: {
      maintainAspectRatio: false, parsing: false, normalized: true,
      interaction: {mode: "nearest", intersect: false},
      plugins: {
        legend: {labels: {boxWidth: 14, boxHeight: 2}},
        tooltip: {callbacks: {label: (c) => `${c.dataset.label}: ${digits(c.raw.x)}, ${digits(c.raw.y)}` +
          (c.raw.note ? ` – ${c.raw.note}` : "")}},
      },
      scales: {x: {title: {display: true, text: x}}, y: {title: {display: true, text: y}}},
    },
  });
}
const line = (label, points, colour, dash) => ({label, data: points, showLine: true, pointRadius: 0,
  borderWidth: 1.8, borderColor: colour, backgroundColor: colour, borderDash: dash || []});
const dots = (label, points, colour) => ({label, data: points, pointRadius: 5, borderColor: colour,
  backgroundColor: colour});
function section(title, lead) {
  add(root, "h2", title);
  if (lead) add(root, "p", lead, {class: "lead"});
  return add(root, "div");
}

const model = data.model;
add(root, "h1", model.vehicle.name);
add(root, "p", "Trials → identify → model → tune → gains → validate, emit, compare. " +
  `${model.trials.length} trial rows, ${model.findings.length} findings, awmr ${model.version}.`, {class: "lead"});
if (data.validation) add(root, "p", data.validation.verdict_text || data.validation.verdict);

function fitted(kind, law, xName, yName) {
  const points = model.trials.filter((t) => t.kind === kind);
  if (!points.length) return;
  const doubtful = (t) => model.findings.filter((f) => f.file === t.file && f.line === t.line);
  const as = (t) => ({x: t.measured, y: t.input,
    note: `${t.file}:${t.line} ` + doubtful(t).map((f) => f.message).join("; ")});
  const sets = [dots("measured", points.filter((t) => !doubtful(t).length).map(as), colours[0]),
    dots("measured, with a finding", points.filter((t) => doubtful(t).length).map(as), colours[1])];
  const {alpha, beta} = law;
  if (alpha.value !== null && beta.value !== null) {
    const top = 1.05 * Math.max(...points.map((t) => t.measured));
    // g(w) = c + alpha w^beta + q w^2; a surge run's tau_speed also loses 4 F'0 to the dead zone.
    const term = (entry) => (entry ? entry.value : 0);
    const c = term(law.coulomb) + (kind === "surge" ? 4 * term((model.wheel || {}).dead_zone) : 0);
    const q = term(law.quadratic);
    const curve = [...Array(101).keys()].map((i) => top * i / 100)
      .map((w) => ({x: w, y: c + alpha.value * w ** beta.value + q * w * w}));
    const name = `${c ? digits(c) + " + " : ""}${digits(alpha.value)} w^${digits(beta.value)}${q ? ` + ${digits(q)} w^2` : ""}`;
    sets.push(line(name, curve, colours[2]));
  }
  chart(fits, `${kind}: the identified resistance against its trials`, xName, yName, sets);
}
let fits = null;
if (model.trials.length) {
  fits = section("Resistance", "Points are the trials' rows; orange ones carry a finding. The curve is the main estimate.");
  fits.className = "grid";
  fitted("surge", model.surge, "speed, m/s", "tau_speed");
  fitted("turning", model.yaw, "yaw rate, rad/s", "tau_turn, m");
}

const quantities = [["surge.alpha", model.surge.alpha], ["surge.beta", model.surge.beta], ["yaw.alpha", model.yaw.alpha],
  ["yaw.beta", model.yaw.beta], ["sway.alpha", model.sway.alpha], ["mass_norm", model.mass_norm],
  ["inertia_norm", model.inertia_norm], ["steering.time_constant_s", model.steering.time_constant_s]];
const estimates = (where, rows) => table(where, ["", "value", "std error", "95 % interval", "unit", "origin"],
  rows.map(([name, e]) => [name, digits(e.value, 5), digits(e.std_error, 2),
    e.ci95 ? `[${digits(e.ci95[0])}, ${digits(e.ci95[1])}]` : "–", e.unit, `${e.source}, ${e.method}`]), [1, 2]);
estimates(section("Parameters"), quantities);
if (model.si) {
  const leaves = (entry, name) => ("value" in entry ? [[name, entry]]
    : Object.entries(entry).flatMap(([key, below]) => leaves(below, name ? `${name}.${key}` : key)));
  estimates(section("In SI units", "What the equations divide by F_max = m/m', the largest force of a wheel, times it again."),
    leaves(model.si, ""));
}
table(section("Estimators side by side", "The paper's log-linear fit puts the error on the logarithm of the force, which is set exactly; what is measured is time."),
  ["", "estimator", "noise on", "estimates", "AICc", "residual std", "rows", "stopped because"],
  model.estimates.map((r) => [r.subject, [r.estimator, r.family].filter(Boolean).join(", "), r.noise,
    r.parameters.map((p) => `${p.name} ${digits(p.value)} ± ${digits(p.std_error, 2)}`).join("; "),
    digits(r.aicc), digits(r.residual_std, 3), r.rows_used, r.stop_reason]), [4, 5, 6]);
if (model.findings.length) {
  const list = section("Findings");
  table(list, ["", "where", "what", "code"], model.findings.map((f) => [f.severity,
    f.file ? `${f.file}${f.line ? ":" + f.line : ""}` : "", f.message, f.code]), []);
}

if (data.validation && data.validation.logs && data.validation.logs.length) {
  table(section("Logs", "Predicted from the commands alone over windows; NRMSE is the error over the signal's own deviation."),
    ["log", "channel", "samples", "one-step R2", "long R2", "long NRMSE"],
    data.validation.logs.flatMap((l) => Object.entries(l.channels).map(([name, c]) => [l.file, name, c.samples,
      digits(c.one_step.r2), digits(c.long_horizon.r2), digits(c.long_horizon.nrmse)])), [2, 3, 4, 5]);
}

function missing(title, command) { section(title, `Not in this directory; \`${command}\` makes it.`); }

// What nominal, robust and the paper's gains do on draws that none of them was tuned on.
function robustTable(box, robust) {
  if (!robust || !robust.quantiles) return;
  const n = robust.noise, late = robust.latency;
  add(box, "p", `Over ${robust.judged_draws} fresh draws (${robust.drawn_from}), heading noise ${n.heading_deg} deg, ` +
    `yaw rate ${n.yaw_rate_degps} deg/s, speed ${n.speed_mps} m/s; readings ${late.heading_s} s late; motors ` +
    `${robust.motor_time_constant_s} s behind. 95 % quantiles:`);
  table(box, ["mode", "gains", "settled", "settling, s", "overshoot, deg", "heading IAE, deg s", "steering, deg/s RMS"],
    Object.entries(robust.quantiles).flatMap(([mode, sets]) => Object.entries(sets).map(([name, q]) => [mode, name,
      digits(100 * q.completed_share, 3) + " %", digits(q.settling_time_s.q95), digits(q.overshoot_deg.q95),
      digits(q.heading_iae_degs.q95), digits(q.steering_rate_rms_degps.q95)])), [2, 3, 4, 5, 6]);
}

if (data.gains) {
  const g = data.gains;
  const box = section("Gains");
  const row = (name, h, s, o) => [name, digits(h.lambda), digits(h.mu), digits(h.epsilon), digits(s.mu), digits(s.epsilon),
    digits(1 / h.lambda), digits(h.epsilon / (2 * h.mu)), digits(o)];
  table(box, ["", "lambda", "mu", "epsilon", "mu_s", "epsilon_s", "T1, s", "T2, s", "objective"],
    [row("tuned", g.heading, g.speed, g.objective.value)].concat(
      g.baseline && g.baseline.heading ? [row("the paper's", g.baseline.heading, g.baseline.speed, g.baseline.objective)] : []),
    [1, 2, 3, 4, 5, 6, 7, 8]);
  if (Array.isArray(g.constraints)) {
    robustTable(box, g.robust);
    table(box, ["constraint", "value", "limit", "margin"], g.constraints.map((c) => [c.name, digits(c.value), digits(c.limit), digits(c.margin)]), [1, 2, 3]);
  }
} else missing("Gains", "awmr tune");

const scenarios = [...new Set(data.runs.map((r) => r.scenario))];
for (const scenario of scenarios) {
  const box = section(`Response: ${scenario}`, "Solid: tuned gains. Dashed: the paper's.");
  box.className = "grid";
  const of = (x, y) => modes.flatMap((mode, i) => ["tuned", "paper"].flatMap((gains) => {
    const run = data.runs.find((r) => r.scenario === scenario && r.mode === mode && r.gains === gains);
    return run ? [line(`${mode}, ${gains}`, run.rows.map((r) => ({x: r[x] , y: r[y]})), colours[i], gains === "paper" ? [5, 4] : [])] : [];
  }));
  chart(box, "heading", "t, s", "psi, deg", of("t_s", "psi_deg"));
  chart(box, "surge speed", "t, s", "u, m/s", of("t_s", "u_mps"));
  chart(box, "commanded steering", "t, s", "d_r, deg", of("t_s", "steering_cmd_deg"));
  chart(box, "left wheel force", "t, s", "F'L", of("t_s", "force_left"));
  chart(box, "yaw rate", "t, s", "r, deg/s", of("t_s", "r_degps"));
  chart(box, "path", "x, m", "y, m", of("x_m", "y_m"));
}

if (data.comparison_csv) {
  const rows = data.comparison_csv;
  const names = Object.keys(rows[0]).filter((n) => !["scenario", "mode", "sample", "completed"].includes(n) && rows.some((r) => r[n] !== ""));
  const nominal = rows.filter((r) => r.sample === "0");
  const most = ["path_length_m", "clearance_min_m"];
  const best = (k, i) => i > 1 && !most.includes(names[i - 2]) && nominal[k][names[i - 2]] !== "" && nominal.filter((r) => r.scenario === nominal[k].scenario)
    .every((r) => r[names[i - 2]] === "" || Number(r[names[i - 2]]) >= Number(nominal[k][names[i - 2]]));
  table(section("The three yaw-control modes", "Nominal model. The least value of each scenario is emphasised; least is best for all but the path's length."),
    ["scenario", "mode", ...names], nominal.map((r) => [r.scenario, r.mode, ...names.map((n) => r[n] === "" ? "–" : digits(r[n], 3))]),
    names.map((_, i) => i + 2), best);
} else missing("The three yaw-control modes", "awmr compare");

if (data.validation) {
  table(section("The paper's claims"), ["", "verdict", "figure", "tolerance", "why"],
    data.validation.claims.map((c) => [c.id, c.verdict, c.figure, c.tolerance, c.why]), []);
} else missing("The paper's claims", "awmr validate");

table(section("Inputs"), ["file", "SHA-256"], model.inputs.map((i) => [i.name, i.sha256]), []);
