// Summary at the top of the page: results, gains, location of the header, next steps.

const isWarning = (f) => f.severity === "warning" || f.severity === "error";

function verdict(list, tone, head, text) {
  const item = add(list, "li", undefined, {class: tone});
  add(item, "b", head);
  add(item, "span", text);
}

/// Validation of the model on its own trials, or on logs.
function modelVerdict(list, data) {
  const v = data.validation;
  if (!v) return verdict(list, "doubt", "Model", "not held against its trials yet (awmr validate)");
  const fitted = data.model.inputs.map((input) => input.sha256);
  const ofFit = (v.inputs || []).filter((input) => fitted.includes(input.sha256)).map((input) => input.name);
  const unseen = (v.logs || []).filter((log) => !ofFit.includes(log.file) && !data.model.inputs.some((input) => input.name === log.file));
  const seen = unseen.length ? "" : " These are the data that it was fitted to, so this says that the fit is sound, not how " +
    "well another drive is predicted; a log that was not fitted would say that.";
  verdict(list, v.passed ? "good" : "bad", v.passed ? "The model predicts its data" : "The model does not predict its data", v.verdict + "." + seen);
}

/// Findings of all steps; the program lists those with the largest effect first.
function findingsVerdict(list, findings) {
  const warnings = findings.filter(isWarning);
  if (!warnings.length) return verdict(list, "good", "Findings", `no warnings, ${plural(findings.length, "note")}`);
  verdict(list, "doubt", `Findings: ${plural(warnings.length, "warning")}`, warnings.length > 3 ? "The first three change the numbers most." : "");
}

/// Shows the first three findings, and all of them in a collapsed part.
function findingsPart(parent, findings) {
  if (!findings.length) return;
  const where = (f) => (f.file ? `${f.file}${f.line ? `:${f.line}` : ""}` : "");
  add(parent, "h3", "Findings");
  const first = add(parent, "ol", undefined, {class: "findings"});
  for (const f of findings.slice(0, 3)) add(first, "li", `${f.severity}: ${where(f) ? `${where(f)}: ` : ""}${f.message} [${f.code}]`);
  if (findings.length <= 3) return;
  const box = folded(parent, `All ${findings.length} findings`);
  table(box, ["", "where", "what", "code"], findings.map((f) => [f.severity, where(f), f.message, f.code]));
}

function gainsVerdict(list, gains) {
  if (!gains) return verdict(list, "doubt", "Gains", "none yet (awmr tune)");
  const required = (gains.constraints || []).filter((c) => c.required);
  const broken = required.filter((c) => !(c.margin >= 0));
  const tightest = [...required].sort((a, b) => a.margin / Math.abs(a.limit) - b.margin / Math.abs(b.limit))[0];
  const met = broken.length ? `break ${broken.map((c) => `“${c.name}”`).join(", ")}`
    : `meet all ${plural(required.length, "constraint")}` + (tightest ? `; the tightest is “${tightest.name}”` : "");
  const better = gains.objective ? ` They score ${digits(gains.objective.value, 3)} against ${digits((gains.baseline || {}).objective ?? 1, 3)} of ` +
    `${baselineWords(gains)}; less is better.` : "";
  const held = gains.objective && gains.objective.held_out ? ` On manoeuvres that were not tuned on: ${digits(gains.objective.held_out.value, 3)}.` : "";
  const goals = (gains.goals || []).filter((goal) => goal.gains === "robust");
  const unmet = goals.filter((goal) => goal.verdict !== "met");
  const reached = goals.length ? ` Of ${plural(goals.length, "goal")} on fresh draws ${goals.length - unmet.length} met` +
    `${unmet.length ? `, ${unmet.filter((goal) => goal.verdict === "missed").length} missed` : ""}.` : "";
  verdict(list, broken.length ? "bad" : unmet.length ? "doubt" : "good", "Gains", `The tuned gains ${met}.${better}${held}${reached}`);
}

function comparisonVerdict(list, comparison) {
  if (!comparison) return;
  const wins = groupBy(comparison.scenarios.filter((s) => s.ranking.length), (s) => s.ranking.filter((r) => r.rank === 1).map((r) => r.mode).join(" and "));
  const words = [...wins].map(([mode, where]) => `${mode} ${mode.includes(" and ") ? "tie" : "is best"} in ${where.map((s) => `“${s.name}”`).join(", ")}`);
  verdict(list, comparison.samples ? "good" : "doubt", "Yaw-control modes", words.join("; ") + ". " + (comparison.samples
    ? `Over ${plural(comparison.samples, "sample")} of the uncertain model.` : "From the nominal run alone, which shows no spread; compare with samples to see it."));
}

function firmwareVerdict(list, pil) {
  if (!pil) return;
  verdict(list, pil.verdict === "passed" ? "good" : "bad", "Firmware", `${pil.cycles.max} cycles a step at most in “${pil.scenario}” ` +
    `(${percent(pil.period_share)} of the sample time), ${pil.flash_bytes} bytes of flash, ${pil.ram_bytes} of RAM; ` +
    `heading within ${digits(pil.difference_double.heading_deg, 2)} deg of the computer's run.`);
}

function gainsTable(parent, gains) {
  const row = (name, set, objective) => [name, digits(set.heading.lambda), digits(set.heading.mu), digits(set.heading.epsilon),
    digits(set.speed.mu), digits(set.speed.epsilon), digits(1 / set.heading.lambda), digits(set.heading.epsilon / (2 * set.heading.mu)), digits(objective)];
  const rows = [row("tuned", gains, (gains.objective || {}).value)];
  if (gains.robust && gains.robust.nominal) rows.push(row("tuned without noise (nominal)", gains.robust.nominal));
  if (gains.baseline && gains.baseline.heading) rows.push(row(baselineWords(gains), gains.baseline, gains.baseline.objective));
  table(parent, ["gains", "#lambda, 1/s", "#mu", "#epsilon", "#mu_s", "#epsilon_s", "#T1, s", "#T2, s", "#objective"], rows,
    (k, i) => k === 0 && i > 0 && i < 6);
  const {observer} = gains;
  if (observer) {
    add(parent, "p", `With a disturbance observer of ${digits(observer.bandwidth_radps)} rad/s, which takes off up to ${digits(observer.yaw_max_m)} m ` +
      `and ${digits(observer.surge_max)} of F_max. It works in the firmware, too.`);
  }
}

/// Next steps, most useful first.
function nextSteps(data) {
  const steps = [];
  if (data.model.findings.some((f) => f.severity === "error" || f.code === "not-identifiable")) {
    steps.push("Record the trial that the finding “not-identifiable” names: the model is incomplete.");
  }
  if (data.header) steps.push("Put awmr_params.h, which lies beside this page, into your sketch; awmr emit writes the controller around it.");
  if (!data.gains) steps.push("Tune gains: awmr tune.");
  if (!data.pil && data.gains) steps.push("Try the firmware on the emulated chip before it drives: awmr pil, with its result as pil.json beside this page.");
  const first = ((data.suggest || {}).trials || [])[0];
  steps.push(first ? `Record next, for the largest gain in certainty: ${first.words}.` : "Ask which trial to record next, and what it would buy: awmr suggest.");
  if (data.model.findings.some(isWarning)) steps.push("Check the rows with a warning against your notes before you trust the last digits.");
  if (!(data.validation && data.validation.logs && data.validation.logs.length)) {
    steps.push("Drive a log that the model has not seen, and hold the model against it: awmr validate.");
  }
  return steps;
}

function summarySection(data) {
  const {model} = data;
  const root = document.getElementById("report");
  add(root, "h1", model.vehicle.name);
  add(root, "p", `Identified, tuned and tried in simulation by awmr ${model.version}: ` +
    `${plural(model.trials.length, "trial row")}, ${plural(model.inputs.length, "input file")}.`, {class: "lead"});
  const list = add(root, "ul", undefined, {class: "verdicts"});
  modelVerdict(list, data);
  gainsVerdict(list, data.gains);
  comparisonVerdict(list, data.comparison);
  firmwareVerdict(list, data.pil);
  findingsVerdict(list, data.findings);
  findingsPart(root, data.findings);
  if (data.gains) {
    add(root, "h3", "Gains");
    gainsTable(root, data.gains);
    if (data.header) {
      add(root, "p", "They are in awmr_params.h, beside this page:");
      add(root, "pre", '#include "awmr_params.h"');
    }
  }
  add(root, "h3", "What to do next");
  const steps = add(root, "ol", undefined, {class: "next"});
  for (const step of nextSteps(data)) add(steps, "li", step);
}
