// Tuning: active constraints, and performance of the gains on sampled vehicles that were not used
// for tuning.

const setOrder = ["robust", "nominal", "baseline", "paper"];
const setColour = {robust: "var(--one)", nominal: "var(--three)", baseline: "var(--two)", paper: "var(--three)"};
const setWords = {robust: "tuned", nominal: "nominal", baseline: "baseline", paper: "the paper's"};

/// Baseline for which the objective is 1; files without `source` use the paper's gains.
function baselineWords(gains) {
  const {source} = gains.baseline || {};
  return !source || source === "paper" ? "the paper's gains" : source === "pole-placement" ? "pole placement" : source;
}

/// Describes the unmodelled variation of the vehicles; empty if there is none.
function openWords(open) {
  if (!open) return "";
  const masses = open.mass_factors ? [`m' and I'z times ${open.mass_factors.join(", ")}`] : [];
  const forces = open.wheel_forces ? [`F' ${open.wheel_forces.map((f) => `${f.min} to ${f.max}`).join(", ")}`] : [];
  return `; open: ${[...masses, ...forces].join("; ")}`;
}

function constraintsTable(parent, constraints) {
  add(parent, "h3", "Constraints");
  const state = (c) => (c.margin < 0 ? (c.required ? "broken" : "not kept") : c.margin < 0.01 * Math.abs(c.limit) ? "binds" : "kept");
  table(parent, ["constraint", "", "#value", "#limit", "#margin", "meaning"], constraints.map((c) => [
    c.name + (c.required ? "" : " (told, not asked)"), state(c), digits(c.value), `${({"at-least": "≥ ", "at-most": "≤ "})[c.sense] || ""}${digits(c.limit)}`, digits(c.margin, 3), c.meaning]));
}

/// Settling time against command activity: what the search met, and the named gains.
function tradeOffChart(parent, gains) {
  const {trade_off: tradeOff} = gains;
  if (!tradeOff) return;
  const at = (p) => [p.settling_time_s, p.control_variation];
  const words = {...setWords, tuned: "tuned", baseline: baselineWords(gains), lqi: "LQI"};
  const colour = {...setColour, tuned: setColour.robust, lqi: "var(--ink)"};
  const series = [{name: "met by the search", kind: "line", points: tradeOff.front.map(at), colour: "var(--dim)", width: 1.2},
    ...Object.entries(tradeOff.gains).map(([name, point]) => ({name: words[name] || name, kind: "points", points: [at(point)], colour: colour[name]}))];
  add(parent, "h3", "Settling against command activity");
  add(parent, "p", "Means over the modes, manoeuvres and plants of the search; nothing that the search met and that keeps every constraint is better in both than the line.", {class: "small"});
  plot(add(parent, "div", undefined, {class: "grid"}), {title: "trade-off", x: "settling time, s", y: "control variation, 1/s", series, height: 260});
}

/// The worst damping and delay margin of the heading loop over the model's confidence set.
function certificateTable(parent, certificate) {
  if (!certificate) return;
  add(parent, "h3", "Certificate");
  add(parent, "p", `The worst cases over the model's parameters (${certificate.set}) and yaw rates of ${certificate.yaw_rate_degps.map((r) => digits(r, 3)).join(" to ")} deg/s, ` +
    `with readings ${digits(certificate.latency_s)} s late: ${certificate.method}.`, {class: "small"});
  const place = (worst) => `${digits(worst.yaw_rate_degps, 3)} deg/s; ${Object.entries(worst.parameters).map(([name, value]) => `${name} ${digits(value)}`).join(", ")}`;
  const margin = (seconds) => (seconds === null ? "any" : digits(seconds, 3));
  table(parent, ["mode", "#damping", "at", "#delay margin, s", "at"], Object.entries(certificate.modes).map(([mode, {damping, delay_margin: delay}]) => [
    mode, digits(damping.min, 3), place(damping), margin(delay.min_s), place(delay)]));
}

/// The best objective so far against evaluations, of the search for the tuned gains and of the one without noise.
function historyChart(parent, gains) {
  const of = (name, history, look) => {
    if (!history || !history.best.length) return [];
    const last = history.best[history.best.length - 1];
    const steps = history.best.map((s) => [s.evaluation, s.objective]);
    return [{name, kind: "line", step: true, points: [...steps, [history.evaluations, last.objective]], ...look}];
  };
  const own = (gains.search || {}).history, {nominal_history: nominal} = gains.robust || {};
  const series = [...of(gains.robust ? "tuned" : "tuned (nominal)", own, {colour: setColour.robust, width: 2.4}),
    ...of("nominal", nominal, {colour: setColour.nominal, width: 1.6, dash: [7, 3]})];
  if (!series.length) return;
  const all = series.flatMap((s) => s.points.map((p) => p[0]));
  series.push({name: baselineWords(gains), kind: "line", points: [[Math.min(...all), 1], [Math.max(...all), 1]], colour: setColour.baseline, width: 1.2, dash: [2, 3]});
  add(parent, "h3", "The search");
  const phases = [["tuned", own], ["nominal", nominal]].filter(([, h]) => h && h.best.length)
    .map(([name, h]) => `${name}: local from evaluation ${h.global_evaluations + 1} of ${h.evaluations}`);
  add(parent, "p", `The best gains so far that keep every constraint; 1 is ${baselineWords(gains)}. A global search, then a local one (${phases.join("; ")}). ` +
    (nominal ? "Each is over the baseline under its own conditions." : ""), {class: "small"});
  plot(add(parent, "div", undefined, {class: "grid"}), {title: "objective, best so far", x: "evaluation", y: "objective", series, height: 260});
}

const robustFigures = [["settling_time_s", "settling time, s"], ["overshoot_deg", "overshoot, deg"], ["heading_iae_degs", "heading error, deg s"],
  ["control_variation", "control variation, 1/s"], ["steering_rate_rms_degps", "steering rate, RMS, deg/s"]];

function goalsTable(parent, goals) {
  if (!goals || !goals.length) return;
  add(parent, "h3", "Goals");
  add(parent, "p", "In how many fresh draws every limit is kept, with the 95 % interval of that share.", {class: "small"});
  const limits = (goal) => Object.entries(goal.at_most).map(([name, most]) => `${metricWords(name)} at most ${digits(most)}`).join("; ") + (goal.soft ? " (soft)" : "");
  table(parent, ["goal", "mode", "gains", "#asked", "#kept", "verdict"], goals.map((goal) => [limits(goal), goal.mode, setWords[goal.gains] || goal.gains,
    percent(goal.share), `${percent(goal.held / goal.runs)} (${percent(goal.ci95[0])} to ${percent(goal.ci95[1])})`, goal.gains === "robust" ? goal.verdict : ""]));
}

function robustCharts(parent, robust) {
  if (!robust || !robust.quantiles) return;
  const n = robust.noise, late = robust.latency;
  add(parent, "h3", "On draws that none was tuned on");
  add(parent, "p", `${robust.judged_draws} fresh draws (${robust.drawn_from}${openWords(robust.open)}); heading noise ${n.heading_deg} deg, yaw rate ${n.yaw_rate_degps} deg/s, ` +
    `speed ${n.speed_mps} m/s; readings ${late.heading_s} s late; motors ${robust.motor_time_constant_s} s behind. From the median (mark) to the 95 % quantile.`, {class: "small"});
  if (!robust.by_scenario) return quantileCharts(parent, robust.quantiles);
  for (const [scenario, quantiles] of Object.entries(robust.by_scenario)) {
    add(parent, "h4", scenario);
    quantileCharts(parent, quantiles);
  }
}

function quantileCharts(parent, quantiles) {
  const grid = add(parent, "div", undefined, {class: "grid small"});
  for (const [figure, title] of robustFigures) {
    const rows = Object.entries(quantiles).flatMap(([mode, sets]) => setOrder.filter((name) => (sets[name] || {})[figure]).map((name) => [name, sets[name]]).map(([name, q]) => {
      const {median, q95} = q[figure];
      return {label: `${mode}, ${setWords[name] || name}`, low: median, high: q95, middle: median, colour: setColour[name] || "var(--dim)",
        note: `${mode}, ${setWords[name] || name}\nmedian ${digits(median)}, 95 % ${digits(q95)}\nsettled: ${percent(q.completed_share)}`};
    }));
    ranges(grid, {title, rows, zero: true});
  }
}

function sensitivityTable(parent, sensitivity) {
  if (!sensitivity) return;
  const box = folded(parent, "What moves the tuned loop");
  add(box, "p", `Total Sobol indices over ${sensitivity.samples} samples: the share of how far a figure varies that is left while this alone is not known. `
    + "Noise level, latency and lag each from none to twice what is assumed.", {class: "small"});
  const mostMoving = (figure) => [...figure.by_input].sort((a, b) => b.total - a.total).slice(0, 3)
    .map((one) => `${one.input} ${digits(one.total, 2)} (${digits(one.total_ci95[0], 2)} to ${digits(one.total_ci95[1], 2)})`).join("; ");
  table(box, ["mode", "figure", "#mean and spread", "moved most by"], sensitivity.figures.map((figure) => [figure.mode, metricWords(figure.figure),
    `${digits(figure.mean, 3)} ± ${digits(figure.std, 2)}`, mostMoving(figure)]));
}

function tuningSection(data) {
  const {gains} = data;
  if (!gains) return;
  const box = section("Tuning");
  if (gains.search) add(box, "p", `${gains.search.algorithm}: ${gains.search.evaluations} evaluations, ${gains.search.stop_reason}.`, {class: "small"});
  if (gains.objective && gains.objective.formula) add(box, "p", `Objective: ${gains.objective.formula}.`, {class: "small"});
  if (Array.isArray(gains.constraints)) constraintsTable(box, gains.constraints);
  certificateTable(box, gains.certificate);
  tradeOffChart(box, gains);
  historyChart(box, gains);
  goalsTable(box, gains.goals);
  robustCharts(box, gains.robust);
  sensitivityTable(box, gains.sensitivity);
  metricsTable(box, gains);
}

/// Metrics of the objective, by mode and scenario: tuned, and the baseline's in brackets.
function metricsTable(parent, gains) {
  const base = (gains.baseline || {}).metrics || {};
  const rows = Object.entries(gains.metrics || {}).flatMap(([mode, scenarios]) => Object.entries(scenarios).map(([name, m]) => {
    const paper = (base[mode] || {})[name] || {};
    const pair = (key) => `${digits(m[key], 3)} (${digits(paper[key], 3)})`;
    return [mode, name, pair("settling_time_s"), pair("overshoot_deg"), pair("heading_iae_degs"), pair("control_variation"), pair("sideslip_max_deg")];
  }));
  if (!rows.length) return;
  const box = folded(parent, `Figures by mode and manoeuvre (in brackets ${baselineWords(gains)})`);
  table(box, ["mode", "manoeuvre", "#settling, s", "#overshoot, deg", "#heading error, deg s", "#variation, 1/s", "#sideslip, deg"], rows);
}
