// Identification: the trials with the fitted curve, its band and residuals; the values; the
// findings.

/// Curve, band and residuals are part of the data (drawn_fit.h), which are also used for the print
/// figures.
function fitCharts(parent, model, fit, kind, xTitle, yTitle) {
  if (!fit) return;
  const rows = model.trials.filter((t) => t.kind === kind);
  const about = (t) => model.findings.filter((f) => f.file === t.file && f.line === t.line);
  const note = (t) => [`${t.file}:${t.line}`, ...about(t).map((f) => f.message)].join("\n");
  const good = rows.filter((t) => !about(t).some(isWarning)), odd = rows.filter((t) => about(t).some(isWarning));
  const as = (list, point) => list.filter((t) => isNumber(t.measured)).map((t) => [...point(t), note(t)]);
  const series = [];
  if (fit.curve.length) {
    const {law} = fit;
    if (fit.has_band) series.push({name: "95 % band of the curve", kind: "band", points: fit.curve.map(([w, value, half]) => [w, Math.max(0, value - half), value + half]), colour: "var(--three)"});
    const words = [law.constant ? digits(law.constant) : "", `${digits(law.alpha)} w^${digits(law.beta, 3)}`, law.quadratic ? `${digits(law.quadratic)} w²` : ""];
    series.push({name: `fit ${words.filter(Boolean).join(" + ")}`, kind: "line", points: fit.curve.map(([w, value]) => [w, value]), colour: "var(--three)"});
  }
  const measured = (t) => [t.measured, t.input];
  series.push({name: "measured", kind: "points", points: as(good, measured), colour: "var(--one)"},
    {name: "measured, with a warning", kind: "points", shape: "diamond", size: 90, points: as(odd, measured), colour: "var(--two)"});
  plot(parent, {title: `${kind} trials`, x: xTitle, y: yTitle, series, byPoint: true, height: 300});
  residualChart(parent, kind, fit, model.trials, xTitle, note);
}

/// Residuals, in percent of the prediction, and the band that contains 99 of 100 rows if errors are
/// normal.
function residualChart(parent, kind, fit, trials, xTitle, note) {
  const left = fit.left_over.map(([i, percentage]) => [trials[i].measured, percentage, note(trials[i])]);
  if (!left.length) return;
  const ends = [Math.min(...left.map((p) => p[0])), Math.max(...left.map((p) => p[0]))];
  const bound = fit.bound_percent;
  plot(parent, {title: `${kind} trials: measured less predicted`, x: xTitle, y: "% of the prediction", byPoint: true, height: 300, series: [
    {name: `99 % band, ±${digits(bound, 3)} %`, kind: "band", points: ends.map((x) => [x, -bound, bound]), colour: "var(--dim)"},
    {name: "as predicted", kind: "line", points: ends.map((x) => [x, 0]), colour: "var(--dim)", width: 1, dash: [3, 3]},
    {name: "left over", kind: "points", points: left, colour: "var(--one)"}]});
}

/// The coast-down: m' du/dt = -g1(u) from each initial speed, and the measured stops.
function coastdownChart(parent, model, coasts) {
  if (!coasts.length) return;
  const rows = model.trials.filter((t) => t.kind === "coastdown");
  const curves = coasts.map((coast) => ({name: `model, from ${digits(coast.initial_speed_mps)} m/s`, kind: "line", points: coast.points, colour: "var(--three)"}));
  const stops = rows.map((t) => [t.measured, 0, `${t.file}:${t.line}: from ${digits(t.input)} m/s`]);
  plot(parent, {title: "coast-down", x: "t, s", y: "speed, m/s", byPoint: true, height: 300,
    series: [...curves, {name: "stop, measured", kind: "points", points: stops, colour: "var(--one)"}]});
}

function estimateRows(rows) {
  return rows.map(([name, e]) => [name, digits(e.value, 5), digits(e.std_error, 2), interval(e.ci95), e.unit, `${e.source}, ${e.method}`]);
}
const estimateHead = ["quantity", "#value", "#standard error", "95 % interval", "unit", "origin"];
/// All quantities below `entry`, by path.
const leaves = (entry, path) => (entry && typeof entry === "object" ? ("value" in entry ? [[path, entry]]
  : Object.entries(entry).flatMap(([key, below]) => leaves(below, path ? `${path}.${key}` : key))) : []);

/// Correlation of each pair of parameters: a table, coloured by strength.
function correlations(parent, covariance) {
  const names = covariance.parameters.filter((_, i) => covariance.matrix[i][i] > 0);
  if (names.length < 2) return;
  const at = names.map((name) => covariance.parameters.indexOf(name));
  const box = folded(parent, "Correlations");
  add(box, "p", "Near ±1, the data show only a combination of the two.", {class: "small"});
  const node = table(box, ["", ...names.map((name) => `#${name}`)], at.map((i, k) => [names[k], ...at.map((j) =>
    digits(covariance.matrix[i][j] / Math.sqrt(covariance.matrix[i][i] * covariance.matrix[j][j]), 2))]));
  for (const cell of node.querySelectorAll("td.n")) {
    const r = Math.max(-1, Math.min(1, Number(cell.textContent) || 0));
    cell.style.background = `color-mix(in srgb, var(${r < 0 ? "--two" : "--one"}) ${Math.round(45 * Math.abs(r))}%, transparent)`;
  }
}

function findingsTable(parent, findings) {
  if (!findings.length) return;
  add(parent, "h3", "Findings");
  const where = (f) => (f.file ? `${f.file}${f.line ? `:${f.line}` : ""}` : "");
  const order = ["error", "warning", "note"];
  for (const severity of order) {
    const list = findings.filter((f) => f.severity === severity);
    if (!list.length) continue;
    const box = folded(parent, plural(list.length, severity));
    box.parentNode.open = severity !== "note" && innerWidth > 640;
    table(box, ["where", "what", "code"], list.map((f) => [where(f), f.message, f.code]));
  }
}

function estimatorsTable(parent, estimates) {
  const box = folded(parent, `Estimators side by side (${estimates.length})`);
  add(box, "p", "The paper's log-linear fit puts the error on the logarithm of the force, which is set exactly; what is measured is time.", {class: "small"});
  table(box, ["of", "estimator", "noise on", "estimates", "#AICc", "#residual std", "#rows", "stopped because"], estimates.map((r) => [r.subject,
    [r.estimator, r.family].filter(Boolean).join(", "), r.noise, r.parameters.map((p) => `${p.name} ${digits(p.value)} ± ${digits(p.std_error, 2)}`).join("; "),
    digits(r.aicc), digits(r.residual_std, 3), r.rows_used, r.stop_reason.split(". ")[0]]));
}

/// The main values without each row in turn.
function influenceTable(parent, estimates) {
  const left = estimates.filter((e) => Array.isArray(e.leave_one_out) && e.leave_one_out.length);
  if (!left.length) return;
  const box = folded(parent, "Influence: the values without each row");
  for (const e of left) {
    const names = e.parameters.map((p) => p.name);
    const change = (one, name, i) => {
      const value = (one.parameters || {})[name] ?? (one.values || [])[i];
      return isNumber(value) ? percent(value / e.parameters[i].value - 1) : "–";
    };
    table(box, [`row (${e.estimator})`, ...names.map((n) => `#${n}`)], e.leave_one_out.map((one) => [
      `${one.file || ""}${one.line ? `:${one.line}` : ""}`, ...names.map((name, i) => change(one, name, i))]));
  }
}

function identificationSection(data) {
  const {model} = data;
  const box = section("Identification", model.trials.length
    ? "Points are the trials' rows; diamonds carry a warning, which shows under the pointer." : "");
  const charts = add(box, "div", undefined, {class: "grid"});
  fitCharts(charts, model, data.fits.surge, "surge", "speed, m/s", "tau_speed");
  fitCharts(charts, model, data.fits.turning, "turning", "yaw rate, rad/s", "tau_turn, m");
  coastdownChart(charts, model, data.fits.coastdown);
  if (!charts.childElementCount) charts.remove();
  add(box, "h3", "Parameters");
  const parts = ["surge", "yaw", "sway", "wheel", "mass_norm", "inertia_norm", "steering"];
  table(box, estimateHead, estimateRows(parts.flatMap((name) => leaves(model[name], name))));
  if (model.si) {
    const si = folded(box, "The same in SI units");
    add(si, "p", "What the equations divide by F_max = m/m', the largest force of a wheel, times it again.", {class: "small"});
    table(si, estimateHead, estimateRows(leaves(model.si, "")));
  }
  correlations(box, model.covariance);
  influenceTable(box, model.estimates);
  estimatorsTable(box, model.estimates);
  findingsTable(box, model.findings);
  logsPart(box, data.validation);
  drivesPart(box, data.validation);
}

/// Drives under the controller compared with their predictions.
function drivesPart(parent, validation) {
  for (const drive of (validation || {}).drives || []) {
    add(parent, "h3", `The drive ${drive.file} against “${drive.scenario}”, ${drive.mode}: ${drive.inside ? "as foretold" : "not as foretold"}`);
    add(parent, "p", `${digits(drive.duration_s)} s against ${drive.draws} foretold drives; as far off as this one or farther: ` +
      `${percent(drive.p_value)} of them. Distances are those of half seconds, over the spread of the foretold.`, {class: "small"});
    table(parent, ["channel", "#samples", "#distance", "#allowed", "#outside since, s", "#measured less foretold"],
      Object.entries(drive.channels).map(([name, c]) => [name, c.samples, digits(c.distance, 3), digits(c.allowed, 3),
        c.outside_since_s === null ? "" : digits(c.outside_since_s), `${digits(c.difference, 3)} ${c.unit}`]));
    if (drive.suspects.length) {
      table(parent, ["what would explain it, alone", "#value", "#explains"],
        drive.suspects.map((s) => [s.what, `${digits(s.value, 3)} ${s.unit}`, percent(s.explained)]));
    }
  }
}

/// Measured and predicted signals by channel; results of older versions have no series.
function logCharts(parent, log) {
  const channels = Object.entries(log.channels).filter(([, c]) => c.series);
  if (!channels.length) return;
  const grid = add(folded(parent, `${log.file}: measured and predicted`), "div", undefined, {class: "grid"});
  const group = [];
  for (const [name, {series, unit}] of channels) {
    const points = (key) => series.t_s.map((t, i) => [t, series[key][i]]);
    const words = name.replace(/_[a-z]+$/, "").replaceAll("_", " ");
    // The prediction is drawn over the noisy measurement and must be visible on it.
    plot(grid, {title: words, x: "t, s", y: `${words}, ${unit}`, group, height: 220, series: [
      {name: "measured", kind: "line", points: points("measured"), colour: "var(--one)", width: 1.2, opacity: 0.45},
      {name: "predicted", kind: "line", points: points("predicted"), colour: "var(--two)", width: 2}]});
  }
}

function logsPart(parent, validation) {
  const logs = (validation || {}).logs || [];
  if (!logs.length) return;
  add(parent, "h3", "Logs, measured against predicted");
  add(parent, "p", "Predicted from the commands alone over windows; NRMSE is the error over the signal's own deviation.", {class: "small"});
  table(parent, ["log", "channel", "#samples", "#R², to the next row", "#R², over a window", "#NRMSE, over a window"],
    logs.flatMap((log) => Object.entries(log.channels).map(([name, c]) => [`${log.file}, windows of ${digits(log.horizon_s)} s`, name, c.samples,
      digits(c.one_step.r2), digits(c.long_horizon.r2), digits(c.long_horizon.nrmse, 3)])));
  for (const log of logs) logCharts(parent, log);
}
