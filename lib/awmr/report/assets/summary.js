// Summary on one screen and one printed page: four tiles, the vehicle and its heading response,
// gains, first findings and next steps.

const isWarning = (f) => f.severity === "warning" || f.severity === "error";

function tile(list, tone, head, figure, text) {
  const item = add(list, "li", undefined, {class: tone});
  add(item, "b", head);
  mark(item, tone);
  add(item, "span", figure, {class: "figure"});
  add(item, "span", text, {class: "small"});
}

/// Logs that were not among the data of the fit, by hash and by name without folders.
function unseenLogs({model, validation}) {
  const base = (name) => name.split("/").pop();
  const hashes = model.inputs.map((input) => input.sha256);
  const fitted = [...model.inputs, ...(validation.inputs || []).filter((input) =>
    hashes.includes(input.sha256))];
  const names = fitted.map((input) => base(input.name));
  return (validation.logs || []).filter((log) => !names.includes(base(log.file)));
}

/// The largest error of the model: of its predictions of logs that were not fitted, else of logs
/// that were, else of its trials.
function modelTile(list, data) {
  const {validation} = data;
  if (!validation) return tile(list, "doubt", "Model error", "not validated",
    "awmr validate compares the model with data");
  const tone = validation.passed === false ? "bad" : "good";
  const unseen = unseenLogs(data);
  const logs = unseen.length ? unseen : validation.logs || [];
  const source = unseen.length ? "not fitted" : "fitted";
  const errors = logs.flatMap((log) => Object.entries(log.channels).map(([name, c]) =>
    [(c.long_horizon || {}).nrmse,
    `largest NRMSE, ${channelWords(name)}, ${log.file} (${source})`]));
  const trials = Object.entries(validation.rms_relative_error || {}).filter(([, error]) =>
    isNumber(error));
  if (!errors.length && trials.length) {
    errors.push([Math.max(...trials.map(([, error]) => error)),
      `largest RMS of ${trials.map(([kind]) => kind).join(", ")}, on the fitted trials`]);
  }
  const found = errors.filter(([error]) => isNumber(error)).sort((a, b) => b[0] - a[0])[0];
  if (found) return tile(list, tone, "Model error", percent(found[0]), found[1]);
  const drives = validation.drives || [];
  if (!drives.length) return tile(list, tone, "Model error", validation.passed ? "validated"
    : "not validated", validation.verdict || "");
  const outside = drives.filter((drive) => !drive.inside).length;
  tile(list, outside ? "bad" : "good", "Model against drives",
    `${drives.length - outside} of ${drives.length} as predicted`,
    `drives under the controller, over ${plural(drives[0].draws, "predicted drive")}`);
}

/// Settling time of the baseline's and of the tuned gains in the mode of the gains: medians over
/// draws that were not tuned on, else the first manoeuvre of the tuning.
function settlingTile(list, gains) {
  if (!gains) return tile(list, "doubt", "Settling time", "no gains",
    "awmr tune computes gains for the model");
  const broken = (gains.constraints || []).filter((c) => c.required && !(c.margin >= 0));
  const unmet = (gains.goals || []).filter((goal) => goal.gains === "robust"
    && goal.verdict !== "met");
  const tone = broken.length ? "bad" : unmet.length ? "doubt" : "good";
  const met = broken.length ? `${plural(broken.length, "constraint")} broken`
    : "every constraint kept";
  const {by_scenario: byScenario = {}, quantiles = {}} = gains.robust || {};
  const sets = Object.values(byScenario)[0] || quantiles;
  const mode = gains.mode || modes.filter((m) => sets[m] || (gains.metrics || {})[m]).pop();
  const median = (set) => (set.completed_share < 0.5 ? null : (set.settling_time_s || {}).median);
  const words = (x) => (isNumber(x) ? `${digits(x)} s` : absentWords.settling_time_s);
  const change = (from, to) => (isNumber(from) && isNumber(to) ? `${digits(from)} → ${words(to)}`
    : `${words(from)} → ${words(to)}`);
  const {robust: after, baseline: before} = sets[mode] || {};
  if (after && before) {
    return tile(list, tone, "Settling time", change(median(before), median(after)),
      `${baselineWords(gains)} → tuned, ${mode}, median of ${gains.robust.judged_draws} draws; ` +
      `${met}`);
  }
  const [manoeuvre, metrics] = Object.entries((gains.metrics || {})[mode] || {})[0] || [];
  if (!metrics) return tile(list, tone, "Gains", "given", "no tuning is recorded with these gains");
  const base = (((gains.baseline || {}).metrics || {})[mode] || {})[manoeuvre];
  tile(list, tone, "Settling time", base ? change(base.settling_time_s, metrics.settling_time_s)
    : words(metrics.settling_time_s),
    `${base ? `${baselineWords(gains)} → tuned, ` : ""}${mode}, ${scenarioWords(manoeuvre)}; ` +
    `${met}`);
}

/// Modes in first place by scenario: those that stay first under every change, where that was
/// checked.
const firstOf = (scenario) => (scenario.decision ? scenario.decision.never_behind
  : scenario.ranking.filter((r) => r.rank === 1).map((r) => r.mode));

/// The best mode, if it alone is first in every ranked scenario.
function modeTile(list, comparison) {
  const ranked = ((comparison || {}).scenarios || []).filter((s) => s.ranking.length);
  if (!ranked.length) return tile(list, "doubt", "Best mode", "not compared",
    "awmr compare ranks the modes");
  const alone = distinct(ranked.map((s) => (firstOf(s).length === 1 ? firstOf(s)[0] : "")));
  const basis = comparison.samples ? plural(comparison.samples, "sample") : "nominal runs only";
  const all = ranked.length === 1
    ? `“${scenarioWords(ranked[0].name)}”` : `${ranked.length} scenarios`;
  if (alone.length === 1 && alone[0]) return tile(list, comparison.samples ? "good" : "doubt",
    "Best mode", alone[0], `${all}; ${basis}`);
  if (ranked.length > 1) {
    const wins = distinct(alone).filter(Boolean).map((mode) =>
      `${mode} first in ` +
      `${ranked.filter((s) => firstOf(s).length === 1 && firstOf(s)[0] === mode).length}`);
    const tied = ranked.filter((s) => firstOf(s).length > 1).length;
    const open = ranked.filter((s) => !firstOf(s).length).length;
    const counts = [...wins, ...(tied ? [`ties in ${tied}`] : []),
      ...(open ? [`undecided in ${open}`] : [])];
    return tile(list, "doubt", "Best mode", "undecided",
      `${counts.join(", ")} of ${all}; ${basis}`);
  }
  const level = firstOf(ranked[0]);
  tile(list, "doubt", "Best mode", "undecided",
    `${level.length ? `${level.join(" and ")} tie` : "no mode stays first"} in ${all}; ${basis}`);
}

function warningsTile(list, findings) {
  const count = (severity) => findings.filter((f) => f.severity === severity).length;
  const errors = count("error"), warnings = count("warning");
  const figure = errors ? `${plural(errors, "error")}, ${plural(warnings, "warning")}` : warnings
    ? plural(warnings, "warning") : "none";
  const first = findings.filter(isWarning)[0];
  tile(list, errors ? "bad" : warnings ? "doubt" : "good", "Warnings", figure,
    `${first ? `first: ${first.code.replaceAll("-", " ")}; ` : ""}${plural(count("note"), "note")}`);
}

function gainsTable(parent, gains) {
  const row = (name, set, objective) => [name, digits(set.heading.lambda), digits(set.heading.mu),
    digits(set.heading.epsilon), digits(set.speed.mu), digits(set.speed.epsilon),
      digits(1 / set.heading.lambda),
    digits(set.heading.epsilon / (2 * set.heading.mu)), digits(objective)];
  const {objective, robust, baseline, observer} = gains;
  const rows = [row(objective ? "tuned" : "given", gains, (objective || {}).value)];
  if (robust && robust.nominal) rows.push(row("nominal (tuned without noise)", robust.nominal));
  if (baseline && baseline.heading) rows.push(row(baselineWords(gains), baseline,
    baseline.objective));
  const head = ["gains", "#lambda, 1/s", "#mu, rad/s²", "#epsilon, rad/s", "#mu_s, m/s²",
    "#epsilon_s, m/s", "#T1, s", "#T2, s"];
  const shown = rows.some((r) => r[8] !== "–") ? [...head, "#objective"] : head;
  table(parent, shown, rows.map((r) => r.slice(0, shown.length)), (k, i) => k === 0 && i > 0
    && i < 6);
  write(add(parent, "p", undefined, {class: "small"}),
    "lambda: slope of the sliding surface, T1 = 1/lambda. mu: reaching gain. " +
    "epsilon: boundary layer, T2 = epsilon/(2 mu). mu_s, epsilon_s: the same of the speed law.");
  if (observer) {
    small(parent, `With a disturbance observer of ${digits(observer.bandwidth_radps)} rad/s, ` +
      `which compensates up to ` +
      `${digits(observer.yaw_max_m)} m and ${digits(observer.surge_max)} of F_max. It works in ` +
      `the firmware, too.`);
  }
}

/// Next steps, most useful first.
function nextSteps(data) {
  const steps = [];
  const {model, gains, validation, suggest} = data;
  if (model.findings.some((f) => f.severity === "error" || f.code === "not-identifiable")) {
    steps.push("Record the trial that the finding “not-identifiable” names: the model is " +
      "incomplete.");
  }
  if (data.header) steps.push("Include awmr_params.h, next to this page, in your sketch; awmr " +
    "emit writes the controller around it.");
  if (!gains) steps.push("Tune gains: awmr tune.");
  if (!data.pil && gains) steps.push("Run the firmware on the emulated chip before it drives: " +
    "awmr pil, with its result as pil.json next to this page.");
  const first = ((suggest || {}).trials || [])[0];
  steps.push(first ? `Record next, for the largest gain in certainty: ${first.words}.`
    : "Find out which trial to record next: awmr suggest.");
  if (model.findings.some(isWarning)) steps.push("Compare the rows that have a warning with your " +
    "notes.");
  if (!(validation && (validation.logs || []).length)) {
    steps.push("Record a drive that was not fitted, and compare the model with it: awmr validate " +
      "--log.");
  }
  return steps;
}

const whereOf = (f) => (f.file ? `${f.file}${f.line ? `:${f.line}` : ""}` : "");

/// The three findings with the largest effect.
function firstFindings(parent, findings) {
  add(parent, "h2", "Findings");
  if (!findings.length) add(parent, "p", "None.");
  const list = add(parent, "ol", undefined, {class: findings.length > 3 ? "findings short"
    : "findings"});
  for (const f of findings.slice(0, 3)) {
    const item = add(add(list, "li"), "div");
    add(item, "span", f.severity, {class: f.severity});
    item.append(` ${whereOf(f) ? `${whereOf(f)}: ` : ""}${f.message} `);
    add(item, "code", f.code);
  }
  if (findings.length <= 3) return;
  const more = add(add(parent, "p", undefined, {class: "small save"}), "a",
    `All ${findings.length} findings`, {href: "#findings"});
  more.onclick = () => document.querySelector('nav a[href="#findings"]').click();
}

/// The heading in every mode over the first scenario with heading steps, else the first; without
/// runs, trials or a log of the validation.
function responseChart(parent, data) {
  const height = 210;
  const type = (run) => (((data.scenarios[run.scenario] || {}).guidance || {}).type || "");
  const shown = data.runs.find((run) => type(run) === "heading") || data.runs[0];
  if (!shown) {
    const kind = data.fits.surge ? "surge" : "turning";
    if (data.fits[kind]) return fitChart(parent, data.model, data.fits[kind], kind, height);
    const log = ((data.validation || {}).logs || []).find((one) =>
      Object.values(one.channels).some((c) => c.series));
    if (!log) return undefined;
    const drawn = Object.keys(log.channels).filter((name) => log.channels[name].series);
    return channelChart(parent, log, drawn.find((name) => name.startsWith("heading")) || drawn[0],
      {height});
  }
  const runs = data.runs.filter((run) => run.scenario === shown.scenario
    && run.gains === "tuned").sort(byMode);
  const series = (runs.length ? runs : [shown]).map((run) =>
    ({...lineOf(run, "t_s", "psi_deg"), hidden: false}));
  if (type(shown) === "heading") series.push(referenceOf(shown, "t_s", "psi_ref_deg"));
  return plot(parent, {title: `heading response: ${scenarioWords(shown.scenario)}`, x: "t, s",
    y: "heading ψ, deg", series, height});
}

function summarySection(data) {
  const {model, gains, findings} = data;
  const root = add(document.getElementById("report"), "section");
  contentsEntry(root, "Summary");
  add(root, "h1", model.vehicle.name);
  add(root, "p", `awmr ${model.version}: ` +
    `${[plural(model.trials.length, "trial row"), plural(model.inputs.length, "input file"),
    ...(data.runs.length ? [plural(data.runs.length, "simulated run")]
      : [])].join(", ")}.`, {class: "lead"});
  const tiles = add(root, "ul", undefined, {class: "tiles"});
  modelTile(tiles, data);
  settlingTile(tiles, gains);
  modeTile(tiles, data.comparison);
  warningsTile(tiles, findings);
  const pair = add(root, "div", undefined, {class: "pair"});
  const sketch = add(pair, "figure");
  add(add(sketch, "figcaption"), "span", "the vehicle, to scale");
  vehicleSketch(sketch, model.vehicle);
  const response = add(pair, "div", undefined, {class: "response"});
  if (!responseChart(response, data)) response.remove();
  if (gains) gainsTable(root, gains);
  const words = add(root, "div", undefined, {class: "pair even"});
  firstFindings(add(words, "div"), findings);
  const next = add(words, "div");
  add(next, "h2", "Next steps");
  const steps = add(next, "ol", undefined, {class: "findings"});
  for (const step of nextSteps(data)) add(steps, "li", step);
}

/// All findings, those with the largest effect first.
function findingsSection({findings}) {
  if (findings.length <= 3) return;
  const box = section("Findings",
    "Those with the largest effect on the numbers come first. awmr explain CODE describes each.",
      "Findings");
  const rows = (list) => list.map((f) => {
    const severity = document.createElement("span");
    add(severity, "span", f.severity, {class: f.severity});
    return [severity, whereOf(f), f.message, f.code];
  });
  const warnings = findings.filter(isWarning), notes = findings.filter((f) => !isWarning(f));
  const head = ["severity", "where", "what", "code"];
  if (warnings.length) table(box, head, rows(warnings.slice(0, 12)));
  if (warnings.length > 12) table(folded(box, `${warnings.length - 12} more warnings`), head,
    rows(warnings.slice(12)));
  if (notes.length) table(folded(box, plural(notes.length, "note")), head, rows(notes));
}
