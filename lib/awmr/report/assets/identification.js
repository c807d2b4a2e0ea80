// Section of the identification: trials with the fitted curve, its band and residuals; parameter
// values; logs and drives.

/// Style of measured trials: points in the text colour. Trials with a warning are hollow diamonds.
const measuredLook = {kind: "points", colour: "var(--ink)"};
const warnedLook = {kind: "points", colour: "var(--warn)", fill: "var(--paper)", shape: "diamond",
  size: 90};
const modelLook = {kind: "line", colour: "var(--model)"};

const axisWords = {surge: ["speed, m/s", "thrust τ_speed"],
  turning: ["yaw rate, rad/s", "yaw moment τ_turn, m"]};

/// Returns a function that gives the tooltip of a trial: file and row of the trial, and the
/// findings about it.
function rowNote(model) {
  return (t) => [`${t.file}:${t.line}`, ...findingsOfRow(model, t).map((f) =>
    f.message)].join("\n");
}
const findingsOfRow = (model, t) => model.findings.filter((f) => f.file === t.file
  && f.line === t.line);

/// Chart of the steady runs with the fitted curve and its confidence band. Curve, band and
/// residuals are computed by the program (drawn_fit.h), as for the print figures.
function fitChart(parent, model, fit, kind, height = 300) {
  if (!fit) return undefined;
  const rows = model.trials.filter((t) => t.kind === kind && isNumber(t.measured));
  const isOdd = (t) => findingsOfRow(model, t).some(isWarning);
  const note = rowNote(model);
  const points = (list) => list.map((t) => [t.measured, t.input, note(t)]);
  const series = [];
  if (fit.curve.length) {
    const {law} = fit;
    if (fit.has_band) {
      series.push({name: "95 % band of the curve", kind: "band", colour: "var(--model)",
        points: fit.curve.map(([w, value, half]) => [w, Math.max(0, value - half), value + half])});
    }
    const terms = [law.constant ? digits(law.constant) : "",
      `${digits(law.alpha)} w^${digits(law.beta)}`,
      law.quadratic ? `${digits(law.quadratic)} w²` : ""];
    series.push({name: `fit ${terms.filter(Boolean).join(" + ")}`, ...modelLook,
      points: fit.curve.map(([w, value]) => [w, value])});
  }
  series.push({name: "measured", ...measuredLook, points: points(rows.filter((t) => !isOdd(t)))},
    {name: "measured, with a warning", ...warnedLook, points: points(rows.filter(isOdd))});
  const [x, y] = axisWords[kind];
  return plot(parent, {title: `${kind} trials`, x, y, series, byPoint: true, zero: "xy", height});
}

/// Chart of the residuals of the speed or yaw rate in percent of the prediction, with the limits
/// that contain 99 % of normally distributed residuals.
function residualChart(parent, model, fit, kind) {
  if (!fit) return;
  const note = rowNote(model);
  const points = fit.left_over.map(([i, percentage]) =>
    [model.trials[i].measured, percentage, note(model.trials[i])]);
  if (!points.length) return;
  const last = Math.max(...points.map((p) => p[0])), bound = fit.bound_percent;
  const level = (y) => [[0, y], [last, y]];
  plot(parent, {title: `${kind} trials: residuals`, x: axisWords[kind][0],
    y: `${axisWords[kind][0].split(",")[0]}: measured − predicted, %`, byPoint: true, height: 300, zero: "xy", series: [
    {name: `99 % limits, ±${digits(bound)} %`, kind: "line", colour: "var(--model)", width: 1.4,
      points: [...level(bound), [null, null], ...level(-bound)]},
    {name: "as predicted", kind: "line", points: level(0), colour: "var(--dim)", width: 1},
    {name: "residual", ...measuredLook, points}]});
}

/// Coast-downs: the model m' du/dt = -g1(u) from each initial speed, and the measured stop times.
function coastdownChart(parent, model, coasts) {
  if (!coasts.length) return;
  const rows = model.trials.filter((t) => t.kind === "coastdown");
  const curves = coasts.map((coast) =>
    ({name: `model, from ${digits(coast.initial_speed_mps)} m/s`, ...modelLook,
      points: coast.points}));
  const stops = rows.map((t) => [t.measured, 0,
    `${t.file}:${t.line}: from ${digits(t.input)} m/s`]);
  plot(parent, {title: "coast-down", x: "t, s", y: "speed, m/s", byPoint: true, height: 300,
    zero: "xy",
    series: [...curves, {name: "stop, measured", ...measuredLook, points: stops}]});
}

/// Rows of a table of parameters. Values are rounded to the second digit of their standard error.
function estimateRows(rows) {
  return rows.map(([name, e]) => {
    const round = (x) => (!isNumber(x) ? "–" : e.std_error > 0 ? x.toFixed(decimalsOf(e.std_error))
      : digits(x, 4));
    return [name, isNumber(e.value) ? round(e.value) : "unknown", e.std_error > 0
      ? round(e.std_error) : "–",
      e.ci95 ? `${round(e.ci95[0])} to ${round(e.ci95[1])}` : "–", symbolic(e.unit),
        isNumber(e.value) ? `${e.source}, ${e.method}` : ""];
  });
}
const estimateHead = ["quantity", "#value", "#standard error", "95 % interval", "unit", "origin"];
/// All quantities (objects with a key `value`) in `entry` and its members, with their paths:
/// [["surge.alpha", {...}], ...].
const leaves = (entry, path) => (entry && typeof entry === "object"
  ? ("value" in entry ? [[path, entry]]
  : Object.entries(entry).flatMap(([key, below]) => leaves(below, path ? `${path}.${key}` : key)))
    : []);

/// Correlation of each pair of parameters: a table, coloured by strength.
function correlations(parent, covariance) {
  const names = covariance.parameters.filter((_, i) => covariance.matrix[i][i] > 0);
  if (names.length < 2) return;
  const at = names.map((name) => covariance.parameters.indexOf(name));
  const box = folded(parent, "Correlations");
  small(box, "Near ±1, the data determine only a combination of the two. Darker cells: stronger correlation.");
  const node = table(box, ["", ...names.map((name) => `#${name}`)],
    at.map((i, k) => [names[k], ...at.map((j) =>
    digits(covariance.matrix[i][j] / Math.sqrt(covariance.matrix[i][i] * covariance.matrix[j][j]),
      2))]));
  for (const cell of node.querySelectorAll("td.n")) {
    const r = Math.max(-1, Math.min(1, Number(cell.textContent) || 0));
    cell.style.background = `color-mix(in srgb, var(--dim) ${Math.round(45 * Math.abs(r))}%, ` +
      `transparent)`;
  }
}

function estimatorsTable(parent, estimates) {
  const box = folded(parent, `Estimators side by side (${estimates.length})`);
  small(box, "The paper's log-linear fit assumes errors on the logarithm of the force. But the " +
    "force is a command, which is exact; the time is measured.");
  table(box, ["of", "estimator", "noise on", "estimates", "#AICc", "#residual std", "#rows",
    "why the search stopped"], estimates.map((r) => [r.subject,
    [r.estimator, r.family].filter(Boolean).join(", "), r.noise,
      r.parameters.map((p) =>
        `${p.name} ${digits(p.value)} ± ${digits(p.std_error, 2)}`).join("; "),
    digits(r.aicc), digits(r.residual_std, 3), r.rows_used, r.stop_reason.split(". ")[0]]));
}

/// Table with one row per trial: the change of the most important values, in percent, if this trial
/// is left out of the fit.
function influenceTable(parent, estimates) {
  const left = estimates.filter((e) => Array.isArray(e.leave_one_out) && e.leave_one_out.length);
  if (!left.length) return;
  const box = folded(parent, "Influence: change of the values if one row is left out");
  for (const e of left) {
    const names = e.parameters.map((p) => p.name);
    const change = (one, name, i) => {
      const value = (one.parameters || {})[name] ?? (one.values || [])[i];
      return isNumber(value) ? percent(value / e.parameters[i].value - 1) : "–";
    };
    table(box, [`row (${e.estimator})`, ...names.map((n) => `#${n}`)],
      e.leave_one_out.map((one) => [
      `${one.file || ""}${one.line ? `:${one.line}` : ""}`,
        ...names.map((name, i) => change(one, name, i))]));
  }
}

/// Sentence with the result of the validation. If only data of the fit were used, a note says that
/// they do not show how well the model predicts another drive.
function validationWords(data) {
  const {validation} = data;
  if (!validation || !validation.verdict) return;
  return `${validation.verdict}.` + (unseenLogs(data).length || (validation.drives || []).length
    ? "" :
    " The model was fitted to these data. Only a log that was not used in the fit shows how well " +
    "the model predicts another drive.");
}

function identificationSection(data) {
  const {model, fits} = data;
  const box = section("Identification", model.trials.length
    ? "Each point is a row of the trials. Diamonds mark rows with a warning; point at a diamond to read its warning." : "",
      "Model");
  const words = validationWords(data);
  if (words) add(box, "p", words[0].toUpperCase() + words.slice(1));
  const charts = add(box, "div", undefined, {class: "grid"});
  for (const kind of ["surge", "turning"]) {
    fitChart(charts, model, fits[kind], kind);
    residualChart(charts, model, fits[kind], kind);
  }
  coastdownChart(charts, model, fits.coastdown);
  if (["surge", "turning"].some((kind) => fits[kind] && fits[kind].left_over.length)) {
    small(box, "A positive residual is a run that was faster than predicted from its force: a point " +
      "to the right of, and so below, the fitted curve.");
  }
  if (!charts.childElementCount) charts.remove();
  add(box, "h3", "Parameters");
  const parts = ["surge", "yaw", "sway", "wheel", "motor", "mass_norm", "inertia_norm", "steering"];
  const rows = parts.flatMap((name) => leaves(model[name], name))
    .filter(([, estimate]) => estimate.method !== "no steering");
  table(box, estimateHead, estimateRows(rows));
  if (model.si) {
    const si = folded(box, "The same in SI units");
    small(si, "The values above, multiplied by F_max = m/m', the largest force of a wheel.");
    table(si, estimateHead, estimateRows(leaves(model.si, "")));
  }
  correlations(box, model.covariance);
  influenceTable(box, model.estimates);
  estimatorsTable(box, model.estimates);
  logsPart(box, data.validation);
  tyresPart(box, data.validation);
  drivesPart(box, data.validation);
}

/// Tyres of the four-wheel plant fitted to logs, and the prediction errors of this plant and of the
/// 3-DOF model on windows to which the tyres were not fitted.
function tyresPart(parent, validation) {
  const {tyres} = validation || {};
  if (!tyres) return;
  const better = {model: "the 3-DOF model predicts better",
    "four-wheel": "this plant predicts better than the 3-DOF model"}[tyres.better] || "neither plant predicts better";
  add(parent, "h3", `Plant with four wheels and tyres: ${better}`);
  small(parent, "Friction and cornering stiffness were fitted to the logs. Errors are root mean " +
    `squares over ${tyres.windows} windows, each predicted by a fit to other windows.`);
  const range = (key) => (tyres.estimates[key] ? interval(tyres.estimates[key].ci95)
    : "default (not determined by the logs)");
  table(parent, ["tyres", "#value", "95 % interval"], [
    ["friction", digits(tyres.friction), range("friction")],
    ["cornering stiffness, 1/rad", digits(tyres.cornering_stiffness_per_rad),
      range("cornering_stiffness_per_rad")]]);
  table(parent, ["channel", "#error of the model", "#error on tyres"],
    Object.entries(tyres.held_out).map(([name, error]) =>
      [channelWords(name), digits(error.model_rms), digits(error.four_wheel_rms)]));
}

/// Drives under the controller, each compared with the simulated drives that predict it.
function drivesPart(parent, validation) {
  for (const drive of (validation || {}).drives || []) {
    add(parent, "h3", `Drive ${drive.file}, “${scenarioWords(drive.scenario)}”, ${drive.mode}: ` +
      `${drive.inside ? "as predicted" : "not as predicted"}`);
    small(parent, `${digits(drive.duration_s)} s, compared with ${drive.draws} predicted drives. ` +
      `Of all these drives, including this one, ${percent(drive.p_value)} are at least ` +
      "as far from the mean prediction as this one. A distance is the difference of means over half a " +
      "second, divided by the standard deviation of the predictions.");
    table(parent, ["channel", "#samples", "#distance", "#allowed", "#outside since, s",
      "#measured − predicted"],
      Object.entries(drive.channels).map(([name, c]) =>
        [channelWords(name), c.samples, digits(c.distance, 3), digits(c.allowed, 3),
        c.outside_since_s === null ? "" : digits(c.outside_since_s),
          `${digits(c.difference, 3)} ${c.unit}`]));
    if (drive.suspects.length) {
      table(parent, ["fault hypothesis, alone", "#value", "#explains"],
        drive.suspects.map((s) => [s.what, `${digits(s.value, 3)} ${s.unit}`,
          percent(s.explained)]));
    }
  }
}

/// "yaw_rate_radps" as "yaw rate"
const channelWords = (name) => name.replace(/_[a-z]+$/, "").replaceAll("_", " ");

/// Chart of a channel of a log. The prediction is drawn over the noisy measurement.
function channelChart(parent, log, name, more) {
  const {series, unit} = log.channels[name];
  const points = (key) => series.t_s.map((t, i) => [t, series[key][i]]);
  return plot(parent, {title: `${channelWords(name)}: ${log.file}`, x: "t, s",
    y: `${channelWords(name)}, ${unit}`, height: 220, ...more, series: [
    {name: "measured", kind: "line", points: points("measured"), colour: "var(--ink)", width: 1.2,
      opacity: 0.45},
    {name: "predicted", ...modelLook, points: points("predicted")}]});
}

/// Charts of all channels of a log. Results of older versions have no series to draw.
function logCharts(parent, log) {
  const names = Object.keys(log.channels).filter((name) => log.channels[name].series);
  if (!names.length) return;
  const grid = add(folded(parent, `${log.file}: measured and predicted`), "div", undefined,
    {class: "grid"});
  const group = [];
  for (const name of names) channelChart(grid, log, name, {group});
}

function logsPart(parent, validation) {
  const logs = (validation || {}).logs || [];
  if (!logs.length) return;
  add(parent, "h3", "Logs, measured and predicted");
  small(parent, "Predicted from the commands alone, from the measured state at the start of each window. " +
    "NRMSE is the RMS error divided by the signal's standard deviation.");
  table(parent, ["log", "channel", "#samples", "#R², to the next row", "#R², over a window",
    "#NRMSE, over a window"],
    logs.flatMap((log) => Object.entries(log.channels).map(([name, c]) =>
      [`${log.file}, windows of ${digits(log.horizon_s)} s`, channelWords(name), c.samples,
      digits(c.one_step.r2), digits(c.long_horizon.r2), digits(c.long_horizon.nrmse)])));
  for (const log of logs) logCharts(parent, log);
}
