// Section that compares the yaw-control modes: distribution of each metric over the samples,
// differences, ranking.

/// Charts of the distribution of each metric by mode. Metrics that no run has are left out.
/// Exception: a missing settling time in scenarios with heading steps is shown, because it means
/// that no run settled.
function spreadCharts(parent, scenario, samples, count) {
  const byMode = Object.entries(scenario.modes);
  const names = distinct(byMode.flatMap(([, m]) => Object.keys(m.metrics)));
  const middle = (m, name) => {
    const {q50, nominal} = m.metrics[name] || {};
    return [q50, nominal].find(isNumber);
  };
  const hasSteps = byMode.some(([, m]) => isNumber(middle(m, "overshoot_deg")));
  const grid = add(parent, "div", undefined, {class: "grid thirds"});
  for (const name of names) {
    const isShown = byMode.some(([, m]) => middle(m, name))
      || (name === "settling_time_s" && hasSteps);
    if (!isShown) continue;
    ranges(grid, {title: metricWords(name), rows: byMode.map(([mode, m]) => {
      const q = m.metrics[name] || {};
      const some = count && q.count < count && isNumber(middle(m, name))
        ? ` (${q.count} of ${count})` : "";
      const share = isNumber(q.q05) ? `\n5 to 95 %: ${digits(q.q05)} to ${digits(q.q95)}` : "";
      const label = mode + some;
      return {label, low: q.q05, high: q.q95, middle: middle(m, name), colour: colourOf(mode),
        values: ((samples || {})[mode] || {})[name] || [], absent: absentWords[name],
        note: `${label}: ${digits(middle(m, name))}${share}\nnominal: ${digits(q.nominal)}`};
    })});
  }
}

/// Chart of the paired differences between two modes, in percent of the larger mean, with
/// intervals.
function differences(parent, scenario) {
  const list = scenario.paired_differences.filter((d) => d.ci95);
  if (!list.length) return;
  const box = folded(parent, "Differences between the modes, sample by sample");
  table(box, ["difference", "metric", "#mean", "95 % interval", "#p, corrected", "#margin",
    "conclusion"], list.map((d) => [
    `${d.first} − ${d.second}`, metricWords(d.metric), digits(d.mean), interval(d.ci95),
      digits(d.p_holm, 2), `± ${digits(d.margin, 2)}`, d.conclusion]));
  const meanOf = (mode, metric) =>
    Math.abs(((scenario.modes[mode] || {metrics: {}}).metrics[metric] || {}).mean || 0);
  small(box, "Grey differences are smaller than the relevance margin, or can be due to chance.");
  const grid = add(box, "div", undefined, {class: "grid"});
  for (const [pair, of] of groupBy(list, (d) => `${d.first} − ${d.second}`)) {
    const rows = of.map((d) => [d,
      Math.max(meanOf(d.first, d.metric), meanOf(d.second, d.metric))]).filter(([, scale]) =>
        scale > 0)
      .map(([d, scale]) =>
        ({label: metricWords(d.metric), middle: 100 * d.mean / scale, low: 100 * d.ci95[0] / scale,
          high: 100 * d.ci95[1] / scale,
        colour: d.conclusion === "relevant" ? "var(--ink)" : "var(--dim)",
          note: `${metricWords(d.metric)}\n${digits(d.mean)} (${interval(d.ci95)})\np ` +
            `${digits(d.p_holm, 2)}`}));
    ranges(grid, {title: pair, x: "% of the larger mean", rows});
  }
}

function ranking(parent, scenario) {
  if (!scenario.ranking.length) return;
  table(parent, ["#rank", "mode", "#score relative to the first", "95 % interval", "#completed",
    "#first, share of weightings", "#first, share of samples"],
    scenario.ranking.map((r) => [r.rank,
      modeCell(r.mode, r.tied_with.length ? `, tied with ${r.tied_with.join(", ")}` : ""),
        digits(r.score), interval(r.behind_ci95),
      percent(r.completed_share), percent(r.first_by_weights), r.first_by_samples === null ? ""
        : percent(r.first_by_samples)]));
}

function breakEven(parent, entries) {
  if (!entries || !entries.length) return;
  const {sliding_m: sliding, measured_m: measured, lead} = entries[0];
  add(parent, "h3", "Scrub at which a mode is no longer ahead");
  add(parent, "p", "In differential turns the tyres are dragged sideways (scrub). This causes a yaw moment against " +
    "the turn, the same at every yaw rate. If the moment is at least the value in the table, the mode is no longer "
    + `ahead. Tyres that slide sideways with a friction of 0.8 cause ${digits(sliding)} m. `
    + (measured ? `Measured in differential turns of this vehicle: ` +
      `${measured.map((m) => digits(m)).join(" to ")} m.`
      : "To measure the scrub of this vehicle, record differential turns (awmr suggest)."));
  table(parent, ["scenario", "mode", "ahead of", "#until, m", ...(lead ? ["lead"] : [])],
    entries.map((e) => [scenarioWords(e.scenario), modeCell(e.mode), modeCell(e.against),
    e.yaw_coulomb_m === null ? `beyond ${digits(e.most_m)}` : digits(e.yaw_coulomb_m),
    ...(e.lead ? [e.turns_to_decide ? `${e.lead}: about ${e.turns_to_decide} turns decide`
      : e.lead] : [])]));
}

/// Replaces names like settling_time_s in a sentence by readable names without units.
const inWords = (sentence) => sentence.replace(/\b[a-z]+(?:_[a-z]+)+\b/g, (name) =>
  metricWords(name).split(",")[0]);

function overallTable(parent, overall) {
  if (!overall || !overall.length) return;
  const names = distinct(overall.flatMap((o) => Object.keys(o.best_or_tied)));
  add(parent, "h3", "Number of scenarios in which each mode is best or tied with the best");
  table(parent, ["metric", "#scenarios", ...names.map((n) => `#${n}`)],
    overall.map((o) => [metricWords(o.metric), o.scenarios,
      ...names.map((n) => o.best_or_tied[n] ?? "–")]), (k, i) => {
      const counts = overall[k].best_or_tied;
      return i > 1 && counts[names[i - 2]] === Math.max(...Object.values(counts));
    });
}

function comparisonSection(data) {
  const {comparison} = data;
  if (!comparison) return;
  const box = section("Comparison of the yaw-control modes", comparison.samples
    ? `${plural(comparison.samples, "sample")} of the model's uncertainty, noise and ` +
      `disturbances; the same for every mode.`
    : "Nominal model only, without uncertainty.", "Modes");
  const rate = comparison.options.heading_rate_limit;
  if (rate && rate !== "none") {
    add(box, "p", "Heading commands are rate-limited " +
      (rate === "measured" ? "to the highest yaw rate at which yaw resistance was measured"
        : `to ${rate} deg/s`) +
      ". The simulations above follow the scenarios without this limit.");
  }
  overallTable(box, comparison.overall);
  breakEven(box, comparison.break_even);
  comparison.scenarios.forEach((scenario, i) => {
    const inside = folded(box, scenarioWords(scenario.name), i === 0 && isWide);
    const verdict = inWords(scenario.verdict);
    add(inside, "p", verdict[0].toUpperCase() + verdict.slice(1));
    ranking(inside, scenario);
    spreadCharts(inside, scenario, (data.samples || {})[scenario.name], comparison.samples);
    differences(inside, scenario);
  });
}
