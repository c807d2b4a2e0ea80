// Findings: the three most important ones for the summary, and the section with all findings.

const whereOf = (f) => (f.file ? `${f.file}${f.line ? `:${f.line}` : ""}` : "");

/// Findings after which the model must be identified again, or the gains tuned again, before the
/// vehicle is driven with them: the remedy of each code, as a warning or an error.
const remedies = {
  "not-identifiable": "record the trial that the finding names, and identify again",
  "too-few-rows": "record more runs, and identify again",
  "no-degrees-of-freedom": "record more runs, and identify again",
  "exponent-at-bound": "choose another resistance family, and identify again",
  "not-converged": "check the rows, and identify again",
  "power-law-inadequate": "identify again with the resistance family that the finding names",
  "family-by-coastdown": "identify again with the resistance family that the finding names",
  "turns-like-a-car": "identify the mass and the surge resistance from straight drives",
  "model-inadequate": "follow the finding, and identify again",
  "estimates-disagree": "repeat the trials that disagree, and identify again",
  "logs-disagree": "record under the conditions of use, and identify again",
  "changed-in-log": "identify the parts of the log separately",
  "held-out-misses": "identify a part of the log under one condition",
  "speed-controlled": "log the commands that reach the motors, and identify again",
  "no-interval": "follow the findings of identify, and identify again",
  "unsettled": "make one of the changes that the finding lists, and tune again",
  "unstable-gains": "tune again",
};

/// True for a warning whose remedy the model has already: a fit of logs uses another family than the
/// power law if that is inadequate.
function isResolved({code}, model) {
  const families = [model.surge, model.yaw].map((law) => (law || {}).family || "power");
  return code === "power-law-inadequate" && families.some((family) => family !== "power");
}

/// The findings that must be resolved before the vehicle is driven: every error, and the warnings
/// with a remedy above. The first of each code. A missing interval is listed only without a cause.
function blockingFindings({findings, model}) {
  const all = findings.filter((f) => f.severity === "error"
    || (f.severity === "warning" && remedies[f.code] && !isResolved(f, model)));
  const first = all.filter((f, i) => all.findIndex((other) => other.code === f.code) === i);
  const causes = first.filter((f) => f.code !== "no-interval");
  return causes.length ? causes : first;
}

/// Sentences with the remedies of the blocking findings. Findings with the same remedy share one.
function remedySteps(data) {
  const remedyOf = ({code}) => remedies[code] || `see its message and “awmr explain ${code}”`;
  return [...groupBy(blockingFindings(data), remedyOf)].map(([remedy, of]) =>
    `Before you drive, resolve ${of.map((f) => `“${f.code}”`).join(" and ")}: ${remedy}.`);
}

/// Adds the three findings with the largest effect on the results.
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

/// Section with all findings. Those with the largest effect on the results come first.
function findingsSection({findings}) {
  if (findings.length <= 3) return;
  const box = section("Findings",
    "Findings with the largest effect on the results come first. awmr explain CODE prints meaning and remedy.",
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
