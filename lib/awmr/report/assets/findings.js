// Findings: the three most important ones for the summary, and the section with all findings.

const whereOf = (f) => (f.file ? `${f.file}${f.line ? `:${f.line}` : ""}` : "");

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
