// The tiles of the summary: model error, settling time, best mode, warnings.

const isWarning = (f) => f.severity === "warning" || f.severity === "error";

function tile(list, tone, head, figure, text) {
  const item = add(list, "li", undefined, {class: tone});
  add(item, "b", head);
  mark(item, tone);
  add(item, "span", figure, {class: "figure"});
  add(item, "span", text, {class: "small"});
}

/// The validated logs that the model was not fitted to. A log of the fit is recognised by its hash,
/// or by its file name without folders.
function unseenLogs({model, validation}) {
  const base = (name) => name.split("/").pop();
  const hashes = model.inputs.map((input) => input.sha256);
  const fitted = [...model.inputs, ...(validation.inputs || []).filter((input) =>
    hashes.includes(input.sha256))];
  const names = fitted.map((input) => base(input.name));
  return (validation.logs || []).filter((log) => !names.includes(base(log.file)));
}

/// Tile of the model's largest prediction error. It uses the first of these that exists: logs that
/// were not used for the fit, logs of the fit, the trials, the comparison of drives with predicted
/// drives. The tile has no tick if a finding requires that the model is identified again.
function modelTile(list, data) {
  const {validation} = data;
  if (!validation) return tile(list, "doubt", "Model error", "not validated",
    "awmr validate compares the model with data");
  const blocking = blockingFindings(data);
  const tone = validation.passed === false ? "bad" : blocking.length ? "doubt" : "good";
  const reason = blocking.length ? `; but ${blocking[0].code.replaceAll("-", " ")}` : "";
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
  if (found) return tile(list, tone, "Model error", percent(found[0]),
    found[1] + reason);
  const drives = validation.drives || [];
  if (!drives.length) return tile(list, tone, "Model error", validation.passed ? "validated"
    : "not validated", (validation.verdict || "") + reason);
  const outside = drives.filter((drive) => !drive.inside).length;
  tile(list, outside ? "bad" : tone, "Model against drives",
    `${drives.length - outside} of ${drives.length} as predicted`,
    `drives under the controller, over ${plural(drives[0].draws, "predicted drive")}${reason}`);
}

/// Tile of the settling time with the baseline and the tuned gains: medians over drawn vehicles
/// that were not used for tuning. Without such vehicles: the times in the first scenario of the
/// tuning.
function settlingTile(list, gains) {
  if (!gains) return tile(list, "doubt", "Settling time", "no gains",
    "awmr tune computes gains for the model");
  const broken = (gains.constraints || []).filter((c) => c.required && !(c.margin >= 0));
  const unmet = (gains.goals || []).filter((goal) => goal.gains === "robust"
    && goal.verdict !== "met");
  const tone = broken.length ? "bad" : unmet.length ? "doubt" : "good";
  const met = broken.length ? `${plural(broken.length, "constraint")} violated`
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

/// The best modes of a scenario. If compare repeated the ranking with another plant, other weights
/// and other gains: the modes that are never behind in any of these rankings; none if undecided.
const firstOf = (scenario) => (!scenario.decision
  ? scenario.ranking.filter((r) => r.rank === 1).map((r) => r.mode)
  : scenario.decision.kind === "undecided" ? [] : scenario.decision.never_behind);

/// Text of the rule that prefers the best mode to the modes that are tied with it. Empty if it is
/// tied with none.
function preferredWords(ranked, best) {
  const tied = distinct(ranked.flatMap((s) =>
    (s.ranking.find((r) => r.mode === best && r.rank === 1) || {tied_with: []}).tied_with));
  return tied.length ? `; tied with ${tied.join(" and ")}, but preferred, because it alone stays ` +
    `first on another plant and with other weights and gains` : "";
}

/// Tile of the best mode: the only mode that is best in every ranked scenario, or "undecided".
function modeTile(list, comparison) {
  const ranked = ((comparison || {}).scenarios || []).filter((s) => s.ranking.length);
  if (!ranked.length) return tile(list, "doubt", "Best mode", "not compared",
    "awmr compare ranks the modes");
  const alone = distinct(ranked.map((s) => (firstOf(s).length === 1 ? firstOf(s)[0] : "")));
  const basis = comparison.samples ? plural(comparison.samples, "sample") : "nominal runs only";
  const all = ranked.length === 1
    ? `“${scenarioWords(ranked[0].name)}”` : `${ranked.length} scenarios`;
  if (alone.length === 1 && alone[0]) return tile(list, comparison.samples ? "good" : "doubt",
    "Best mode", alone[0], `${all}${preferredWords(ranked, alone[0])}; ${basis}`);
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
