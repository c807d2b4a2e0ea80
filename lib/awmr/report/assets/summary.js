// Summary, on one screen and one printed page: four tiles, the vehicle, its heading response, the
// gains, the first findings and the next steps.

function gainsTable(parent, gains) {
  const row = (name, set, objective) => [name, digits(set.heading.lambda), digits(set.heading.mu),
    digits(set.heading.epsilon), digits(set.speed.mu), digits(set.speed.epsilon),
      digits(1 / set.heading.lambda),
    digits(set.heading.epsilon / (2 * set.heading.mu)), digits(objective)];
  const {objective, robust, baseline} = gains;
  const own = Object.entries(gains.modes || {});
  const rows = own.map(([mode, set]) => row(`tuned, ${mode}`, set, (set.objective || {}).value));
  rows.push(row((objective ? "tuned" : "given") + (own.length ? ", combined" : ""), gains,
    (objective || {}).value));
  if (robust && robust.nominal) rows.push(row("nominal (tuned without noise)", robust.nominal));
  if (baseline && baseline.heading) rows.push(row(baselineWords(gains), baseline,
    baseline.objective));
  const head = ["gains", "#lambda, 1/s", "#mu, rad/s²", "#epsilon, rad/s", "#mu_s, m/s²",
    "#epsilon_s, m/s", "#T1, s", "#T2, s"];
  const shown = rows.some((r) => r[8] !== "–") ? [...head, "#objective"] : head;
  table(parent, shown, rows.map((r) => r.slice(0, shown.length)), (k, i) => k <= own.length
    && i > 0 && i < 6);
  write(add(parent, "p", undefined, {class: "small"}),
    "lambda: slope of the sliding surface, T1 = 1/lambda. mu: largest corrective acceleration. " +
    "epsilon: half width of the boundary layer, T2 = epsilon/(2 mu). mu_s, epsilon_s: the same for " +
    "the speed law.");
  for (const [mode, {observer}] of own.length ? [...own, ["combined", gains]] : [["", gains]]) {
    if (!observer) continue;
    small(parent, `${mode ? `In ${mode} mode, with` : "With"} a disturbance observer of ` +
      `${digits(observer.bandwidth_radps)} rad/s, which compensates up to ` +
      `${digits(observer.yaw_max_m)} m and ${digits(observer.surge_max)} of F_max. It works in ` +
      `the firmware, too.`);
  }
}

/// The next steps for the user: first the remedies of blocking findings, then the most useful.
function nextSteps(data) {
  const {model, gains, validation, suggest} = data;
  const steps = remedySteps(data);
  if (data.header) steps.push("Include awmr_params.h (next to this page) in your sketch, or use " +
    "the sketches with the controller that awmr emit writes.");
  if (!gains) steps.push("Tune gains: awmr tune.");
  if (!data.pil && gains) steps.push("Run the firmware on the emulated chip before it runs on the " +
    "vehicle: awmr pil. Write its result to pil.json next to this page.");
  const first = ((suggest || {}).trials || [])[0];
  steps.push(first ? `Record this trial next, as it reduces the uncertainty most: ${first.words}.`
    : "Find out which trial to record next: awmr suggest.");
  if (model.findings.some(isWarning)) steps.push("Compare the trial rows that have a warning with " +
    "your notes.");
  if (!(validation && (validation.logs || []).length)) {
    steps.push("Record a drive that was not fitted, and compare the model with it: awmr validate " +
      "--log.");
  }
  return steps;
}

/// Chart of the heading in every mode with the tuned gains, in the first scenario with heading
/// steps, else in the first scenario. If there are no simulated runs, the chart shows the trials,
/// or a validated log.
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
