// Section of the tuning: constraints, search, and performance of the gains on drawn vehicles that
// were not used for tuning.

const gainsWords = {robust: "tuned", nominal: "nominal", baseline: "baseline",
  paper: "the paper's"};

/// Name of the baseline: the gains relative to which objectives are computed, so that theirs is 1.
/// In older files without `source` these are the paper's gains.
function baselineWords(gains) {
  const {source = "paper"} = gains.baseline || {};
  return {paper: "the paper's gains", "pole-placement": "pole placement"}[source] || source;
}

/// Text on the unmodelled variation of the drawn vehicles: the factors of their masses and the ranges
/// of their wheel forces, which apply in addition to the model's covariance. Empty without variation.
function openWords(open) {
  if (!open) return "";
  const masses = open.mass_factors ? [`m' and I'z times ${open.mass_factors.join(", ")}`] : [];
  const forces = open.wheel_forces
    ? [`F' ${open.wheel_forces.map((f) => `${f.min} to ${f.max}`).join(", ")}`] : [];
  return `; unmodelled: ${[...masses, ...forces].join("; ")}`;
}

/// Text and tone for the state of a constraint: met, at its limit, not met or violated.
function constraintState({margin, required, limit}) {
  if (!(margin >= 0)) return required ? ["violated", "bad"] : ["not met", "doubt"];
  return [margin < 0.01 * Math.abs(limit) ? "at its limit" : "met", "good"];
}

/// Sense of the limit of a constraint, "at-most" or "at-least". Results of the interactive part do
/// not contain it; it is then derived from value, limit and margin.
const senseOf = ({sense, value, limit, margin}) => sense ||
  (Math.abs(limit - value - margin) <= Math.abs(value - limit - margin) ? "at-most" : "at-least");

/// Bar chart of a constraint: a bar from 0 to the value, a line at the limit, and a shade on the
/// permitted side. at(x) is the position of x in percent of the width.
function constraintBar(constraint) {
  const {value, limit, margin} = constraint;
  const reach = 1.25 * Math.max(Math.abs(value), Math.abs(limit)) || 1;
  const low = Math.min(0, value, limit) < 0 ? -reach : 0;
  const at = (x) => 100 * (x - low) / (reach - low);
  const svg = drawIn(document.createElement("span"), "svg",
    {class: `bar${margin >= 0 ? "" : " broken"}`, "aria-hidden": "true"});
  const block = (from, to, y, height, classes) =>
    drawIn(svg, "rect", {x: `${Math.min(from, to)}%`, y: `${y}%`,
    width: `${Math.abs(to - from)}%`, height: `${height}%`, class: classes});
  block(0, 100, 0, 100, "track");
  block(at(limit), senseOf(constraint) === "at-least" ? 100 : 0, 0, 100, "safe");
  block(at(0), at(value), 30, 40, "value");
  drawIn(svg, "line", {x1: `${at(limit)}%`, x2: `${at(limit)}%`, y1: "0", y2: "100%",
    class: "limit"});
  return svg;
}

/// Table of the constraints with value, limit and permitted side.
function constraintsTable(parent, constraints) {
  if (!constraints.length) return;
  const signs = {"at-least": "≥ ", "at-most": "≤ "};
  small(parent, "Bars are values, red lines are limits, the shaded side is permitted.");
  table(parent, ["constraint", "state", "value and limit", "#value", "#limit", "meaning"],
    constraints.map((c) => {
    const [state, tone] = constraintState(c);
    const cell = document.createElement("span");
    cell.className = "state";
    mark(cell, tone);
    cell.append(` ${state}`);
    const bar = isNumber(c.value) && isNumber(c.limit) ? constraintBar(c) : "–";
    return [symbolic(c.name + (c.required ? "" : " (reported only)")), cell, bar, digits(c.value),
      `${signs[senseOf(c)]}${digits(c.limit)}`, symbolic(c.meaning)];
  }));
}

/// Chart of settling time against control variation: the Pareto front of the search, and the named
/// gains.
function tradeOffChart(parent, gains) {
  const {trade_off: tradeOff} = gains;
  if (!tradeOff) return;
  const at = (p) => [p.settling_time_s, p.control_variation];
  const words = {...gainsWords, tuned: "tuned", baseline: baselineWords(gains), lqi: "LQI"};
  const series = [{name: "Pareto front of the search", kind: "line", points: tradeOff.front.map(at),
    colour: "var(--dim)", width: 1.2},
    ...Object.entries(tradeOff.gains).map(([name, point]) =>
      ({name: words[name] || name, kind: "points", size: 80,
      points: [at(point)], colour: "var(--ink)", shape: (gainsStyle[name] || {}).shape}))];
  add(parent, "h3", "Settling time and control variation");
  small(parent, "Means over the modes, manoeuvres and vehicles of the search. The line shows the best compromises: " +
    "no gains that meet every constraint have both shorter settling and less variation than gains on the line.");
  plot(add(parent, "div", undefined, {class: "grid"}),
    {title: "trade-off", x: "settling time, s", y: "control variation, 1/s", series, height: 260,
      zero: "xy", byPoint: true});
}

/// Table of the worst damping ratio and delay margin of the heading loop over the model's
/// confidence set.
function certificateTable(parent, certificate) {
  if (!certificate) return;
  add(parent, "h3", "Certificate");
  small(parent, `Worst cases over the model's parameters (${certificate.set}) and yaw rates of ` +
    `${certificate.yaw_rate_degps.map((r) => digits(r, 3)).join(" to ")} deg/s, ` +
    `with a latency of ${digits(certificate.latency_s)} s: ${certificate.method}.`);
  const place = (worst) =>
    `${digits(worst.yaw_rate_degps, 3)} deg/s; ` +
    `${Object.entries(worst.parameters).map(([name, value]) => `${name} ${digits(value)}`).join(", ")}`;
  const margin = (seconds) => (seconds === null ? "any" : digits(seconds, 3));
  table(parent, ["mode", "#damping", "at", "#delay margin, s", "at"],
    Object.entries(certificate.modes).map(([mode, {damping, delay_margin: delay}]) => [
    modeCell(mode), digits(damping.min, 3), place(damping), margin(delay.min_s), place(delay)]));
}

/// Chart of the best objective so far over the number of evaluations, for the search of the tuned
/// gains and, in older files, for the nominal search.
function historyChart(parent, gains) {
  const own = (gains.search || {}).history, {nominal_history: nominal} = gains.robust || {};
  const searches = [["robust", own, 2.4], ["nominal", nominal, 1.6]].filter(([, h]) => h
    && h.best.length);
  if (!searches.length) return;
  const series = searches.map(([set, history, width]) => {
    const steps = history.best.map((s) => [s.evaluation, s.objective]);
    return {name: set === "robust" && !gains.robust ? "tuned (nominal)" : gainsWords[set],
      kind: "line", step: true,
      points: [...steps, [history.evaluations, steps[steps.length - 1][1]]], colour: "var(--ink)",
        width, dash: gainsStyle[set].dash};
  });
  const last = Math.max(...searches.map(([, h]) => h.evaluations));
  series.push({name: baselineWords(gains), kind: "line", points: [[0, 1], [last, 1]],
    colour: "var(--ink)", width: 1.2, dash: gainsStyle.baseline.dash});
  add(parent, "h3", "Search");
  const phases = searches.map(([set, h]) =>
    `${gainsWords[set]}: local from evaluation ${h.global_evaluations + 1} of ${h.evaluations}`);
  small(parent, `The best gains so far that meet every constraint; 1 is ${baselineWords(gains)}. ` +
    `A global search, then a local one (${phases.join("; ")}).` +
    (nominal ? " Each objective is relative to that of the baseline under the same conditions." : ""));
  plot(add(parent, "div", undefined, {class: "grid"}),
    {title: "objective, best so far", x: "evaluation", y: "objective", series, height: 260,
      zero: "xy"});
}

const robustFigures = [["settling_time_s", "settling time, s"],
  ["overshoot_deg", "overshoot, deg"], ["heading_iae_degs", "heading error, deg s"],
  ["control_variation", "control variation, 1/s"],
    ["steering_rate_rms_degps", "steering rate, RMS, deg/s"]];

function goalsTable(parent, goals) {
  if (!goals || !goals.length) return;
  add(parent, "h3", "Goals");
  small(parent, "Share of the newly drawn vehicles for which every limit of the goal is met, with its 95 % interval.");
  const limits = (goal) => Object.entries(goal.at_most).map(([name, most]) =>
    `${metricWords(name)} at most ${digits(most)}`).join("; ") + (goal.soft ? " (soft)" : "");
  table(parent, ["goal", "mode", "gains", "#required", "#kept", "verdict"],
    goals.map((goal) => [limits(goal), modeCell(goal.mode), gainsWords[goal.gains] || goal.gains,
    percent(goal.share),
      `${percent(goal.held / goal.runs)} (${percent(goal.ci95[0])} to ${percent(goal.ci95[1])})`,
        goal.gains === "robust" ? goal.verdict : ""]));
}

function robustCharts(parent, robust) {
  if (!robust || !robust.quantiles) return;
  const n = robust.noise, late = robust.latency;
  add(parent, "h3", "On vehicles that were not used for tuning");
  small(parent, `${robust.judged_draws} newly drawn vehicles ` +
    `(${robust.drawn_from}${openWords(robust.open)}); noise: heading ${n.heading_deg} deg, yaw ` +
    `rate ${n.yaw_rate_degps} deg/s, ` +
    `speed ${n.speed_mps} m/s; latency ${late.heading_s} s; motor lag ` +
    `${robust.motor_time_constant_s} s. The mark is the median, the bar ends at the 95 % quantile.`);
  if (!robust.by_scenario) return quantileCharts(parent, robust.quantiles);
  for (const [scenario, quantiles] of Object.entries(robust.by_scenario)) {
    add(parent, "h4", scenarioWords(scenario));
    quantileCharts(parent, quantiles);
  }
}

/// One row of a quantile chart. A run that does not settle counts with its duration, so the median
/// is a settling time only if at least half of the runs settle; else the row shows "never settled".
function quantileRow(mode, name, set, figure) {
  const {median, q95} = set[figure], label = `${mode}, ${gainsWords[name]}`;
  const settled = `settled: ${percent(set.completed_share)}`;
  const look = {label, colour: colourOf(mode), ...gainsStyle[name]};
  if (figure === "settling_time_s" && set.completed_share < 0.5) {
    return {...look, absent: absentWords[figure], note: `${label}\n${settled}`};
  }
  return {...look, low: median, high: q95, middle: median,
    note: `${label}\nmedian ${digits(median)}, 95 % ${digits(q95)}\n${settled}`};
}

/// Range charts of the metrics on drawn vehicles: median to 95 % quantile. The mode determines the
/// hue of a row, the set of gains its line and mark.
function quantileCharts(parent, quantiles) {
  const grid = add(parent, "div", undefined, {class: "grid thirds"});
  for (const [figure, title] of robustFigures) {
    const rows = Object.entries(quantiles).flatMap(([mode, sets]) =>
      gainsOrder.filter((name) => (sets[name] || {})[figure])
        .map((name) => quantileRow(mode, name, sets[name], figure)));
    ranges(grid, {title, rows});
  }
}

/// Sentence with the objectives of the tuned gains and the baseline, and the number of goals that
/// are met.
function objectiveWords(gains) {
  const {objective, baseline, goals = []} = gains;
  if (!objective) return "";
  const held = objective.held_out
    ? ` On manoeuvres that were not used for tuning: ${digits(objective.held_out.value)}.` : "";
  const robust = goals.filter((goal) => goal.gains === "robust");
  const count = (verdict) => robust.filter((goal) => goal.verdict === verdict).length;
  return `Objective ${digits(objective.value)}; ${baselineWords(gains)}: ` +
    `${digits((baseline || {}).objective ?? 1)}; less is better.${held}` +
    (robust.length ? ` Of ${plural(robust.length, "goal")} on newly drawn vehicles, ${count("met")} met, ` +
      `${count("missed")} missed.` : "");
}

/// Results of one search, for all modes or for one. `name`: of the mode; empty for all modes.
function tuningOf(gains, name) {
  const {search, objective, constraints = []} = gains;
  if (!search && !objective && !constraints.length && !gains.robust && !gains.metrics) return;
  const box = section(name ? `Tuning, ${name}` : "Tuning", objectiveWords(gains));
  if (constraints.length) add(box, "h3", "Constraints");
  constraintsTable(box, constraints);
  certificateTable(box, gains.certificate);
  tradeOffChart(box, gains);
  historyChart(box, gains);
  if (search) small(box,
    `${search.algorithm}: ${search.evaluations} evaluations, ${search.stop_reason}.`);
  if (objective && objective.formula) small(box, `Objective: ${objective.formula}.`);
  goalsTable(box, gains.goals);
  robustCharts(box, gains.robust);
  metricsTable(box, gains);
}

/// Results of the tuning. Modes with gains of their own have a section each; the other results are
/// then those of combined mode.
function tuningSection(data) {
  const {gains} = data;
  if (!gains) return;
  const modes = Object.entries(gains.modes || {});
  for (const [mode, own] of modes) tuningOf(own, mode);
  tuningOf(gains, modes.length ? "combined" : "");
}

/// Table of the metrics in the objective, by mode and scenario. Each cell has the value with the
/// tuned gains and, in brackets, that with the baseline.
function metricsTable(parent, gains) {
  const base = (gains.baseline || {}).metrics || {};
  const rows = Object.entries(gains.metrics || {}).flatMap(([mode, scenarios]) =>
    Object.entries(scenarios).map(([name, m]) => {
    const paper = (base[mode] || {})[name] || {};
    const pair = (key) => `${metricValue(key, m[key])} (${metricValue(key, paper[key])})`;
    return [modeCell(mode), scenarioWords(name), pair("settling_time_s"), pair("overshoot_deg"),
      pair("heading_iae_degs"), pair("control_variation"), pair("sideslip_max_deg")];
  }));
  if (!rows.length) return;
  const box = folded(parent,
    `Metrics by mode and manoeuvre (in brackets: ${baselineWords(gains)})`);
  table(box, ["mode", "manoeuvre", "#settling time, s", "#overshoot, deg", "#heading error, deg s",
    "#control variation, 1/s", "#sideslip, deg"], rows);
}
