// Section of the paper's claims. Each claim has a mark for its verdict, its statement, and small
// bar charts of its numbers by mode.

/// Reads the numbers of a claim by mode from the text that validate writes: "WHAT: differential
/// A, steering B, combined C UNIT; ...". Text of another form is shown as a sentence.
function multiplesOf(figure) {
  const pattern = /differential ([-\d.]+), steering ([-\d.]+), combined ([-\d.]+) ?([^\s;,]*)/g;
  let end = 0;
  return [...figure.matchAll(pattern)].map((match) => {
    const what = figure.slice(end, match.index).replace(/^[\s,;]+|[\s:]+$/g, "");
    end = match.index + match[0].length;
    return {what: [what, match[4]].filter(Boolean).join(", "),
      values: match.slice(1, 4).map(Number)};
  });
}

function multiple(parent, {what, values}) {
  const box = add(parent, "div", undefined, {class: "multiple"});
  if (what) add(box, "p", what);
  const most = Math.max(...values.map(Math.abs)) || 1;
  values.forEach((value, i) => {
    add(box, "span", modes[i]);
    const width = 100 * Math.abs(value) / most;
    add(add(box, "span"), "i", undefined,
      {style: `width: ${width}%; background: ${colourOf(modes[i])}`});
    add(box, "output", metricValue("", value));
  });
}

/// The paper leaves some settings open. Adds the number of combinations of these settings with
/// which the claim is reproduced.
function claimCases(parent, cases) {
  if (!cases || !cases.length) return;
  const kept = cases.filter((c) => c.verdict === "reproduced").length;
  small(parent, `Reproduced with ${kept} of ${plural(cases.length, "combination")} of the settings ` +
    `that the paper leaves open.`);
}

function claimCard(list, claim) {
  const item = add(list, "li");
  const head = add(item, "h3");
  mark(head, claim.verdict === "reproduced" ? "good" : "bad").setAttribute("aria-label",
    claim.verdict.replace("-", " "));
  add(head, "span", `${claim.id}. ${claim.statement}`);
  const multiples = multiplesOf(claim.figure);
  for (const one of multiples) multiple(item, one);
  if (!multiples.length) small(item, claim.figure);
  claimCases(item, claim.cases);
  const more = add(item, "details");
  add(more, "summary", "criterion and reason", {class: "small"});
  if (multiples.length) add(more, "p", `Found: ${claim.figure}.`, {class: "small found"});
  small(more, `Criterion: ${claim.tolerance}.`);
  small(more, `Reason: ${claim.why}.`);
}

function claimsSection(data) {
  const claims = ((data.validation || {}).claims || []).filter((c) => c.verdict);
  if (!data.paper_vehicle || !claims.length) return;
  const kept = claims.filter((c) => c.verdict === "reproduced").length;
  const box = section("The paper's claims",
    `${kept} of ${claims.length} reproduced with this model.`, "Claims");
  const list = add(box, "ul", undefined, {class: "claims"});
  for (const claim of claims) claimCard(list, claim);
}
