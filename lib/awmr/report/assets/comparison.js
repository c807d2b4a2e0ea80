// Comparison of yaw-control modes: distribution of each metric over the samples, significant
// differences, ranking.

/// "settling_time_s" as "settling time, s"
const metricWords = (name) => report.metric_words[name] || name;

/// Colour of a mode; several sets of gains give labels like "combined with NAME".
const colourOf = (label) => (modeStyle[label.split(" ")[0]] || {colour: "var(--dim)"}).colour;

function spreadCharts(parent, scenario, samples) {
  const names = distinct(Object.values(scenario.modes).flatMap((m) => Object.keys(m.metrics)));
  const grid = add(parent, "div", undefined, {class: "grid small"});
  for (const name of names) {
    const rows = Object.entries(scenario.modes).filter(([, m]) => m.metrics[name]).map(([mode, m]) => {
      const q = m.metrics[name];
      const middle = isNumber(q.q50) ? q.q50 : q.nominal;
      return {label: mode, low: q.q05, high: q.q95, middle, values: ((samples || {})[mode] || {})[name] || [], colour: colourOf(mode),
        note: `${mode}: ${digits(middle)}` + (isNumber(q.q05) ? `\n5 to 95 %: ${digits(q.q05)} to ${digits(q.q95)}` : "") + `\nnominal: ${digits(q.nominal)}`};
    });
    if (rows.some((r) => isNumber(r.middle) && r.middle !== 0)) ranges(grid, {title: metricWords(name), rows});
  }
}

/// Paired differences between two modes, in percent of the larger mean, with their intervals.
function differences(parent, scenario) {
  const list = scenario.paired_differences.filter((d) => d.ci95);
  if (!list.length) return;
  const box = folded(parent, "Differences between the modes, sample by sample");
  table(box, ["difference", "figure", "#mean", "95 % interval", "#p, corrected", "#what matters", ""], list.map((d) => [`${d.first} − ${d.second}`, metricWords(d.metric), digits(d.mean, 3), interval(d.ci95), digits(d.p_holm, 2), `± ${digits(d.margin, 2)}`, d.conclusion]));
  const meanOf = (mode, metric) => Math.abs(((scenario.modes[mode] || {metrics: {}}).metrics[metric] || {}).mean || 0);
  add(box, "p", "In the charts, what is grey is not told to matter: it is within the margin, or may be chance.", {class: "small"});
  const grid = add(box, "div", undefined, {class: "grid"});
  for (const [pair, of] of groupBy(list, (d) => `${d.first} less ${d.second}`)) {
    const rows = of.map((d) => [d, Math.max(meanOf(d.first, d.metric), meanOf(d.second, d.metric))]).filter(([, scale]) => scale > 0)
      .map(([d, scale]) => ({label: metricWords(d.metric), middle: 100 * d.mean / scale, low: 100 * d.ci95[0] / scale, high: 100 * d.ci95[1] / scale,
        colour: d.conclusion === "relevant" ? "var(--one)" : "var(--dim)", note: `${metricWords(d.metric)}\n${digits(d.mean)} (${interval(d.ci95)})\np ${digits(d.p_holm, 2)}`}));
    ranges(grid, {title: pair, x: "% of the larger mean", rows, zero: true});
  }
}

function ranking(parent, scenario) {
  if (!scenario.ranking.length) return;
  table(parent, ["#rank", "mode", "#score over the first's", "95 % interval", "#completed", "#first by weights", "#by samples"], scenario.ranking.map((r) => [r.rank,
    r.mode + (r.tied_with.length ? `, level with ${r.tied_with.join(", ")}` : ""), digits(r.score, 3), interval(r.behind_ci95), percent(r.completed_share), percent(r.first_by_weights),
    r.first_by_samples === null ? "" : percent(r.first_by_samples)]));
}

function breakEven(parent, entries) {
  if (!entries || !entries.length) return;
  add(parent, "h3", "How much scrub a lead stands");
  add(parent, "p", "Wheels that are turned by the sides' forces scrub. With this Coulomb yaw moment more than the model has, a lead is gone. Tyres that slide "
    + `sideways on a friction of 0.8 make ${digits(entries[0].sliding_m, 3)} m`
    + (entries[0].measured_m ? `; this vehicle's own turns by the sides met ${entries[0].measured_m.map((m) => digits(m, 3)).join(" to ")} m.`
      : "; a few turns by the sides' forces, wheels straight, tell this vehicle's own (awmr suggest)."));
  const decided = entries[0].lead ? ["lead"] : [];
  table(parent, ["scenario", "mode", "ahead of", "#until, m", ...decided], entries.map((e) => [e.scenario, e.mode, e.against,
    e.yaw_coulomb_m === null ? `beyond ${digits(e.most_m, 3)}` : digits(e.yaw_coulomb_m, 3),
    ...(e.lead ? [e.turns_to_decide ? `${e.lead}: about ${e.turns_to_decide} turns decide` : e.lead] : [])]));
}

/// Replaces metric names in a sentence by readable names without units.
const inWords = (sentence) => sentence.replace(/\b[a-z]+(?:_[a-z]+)+\b/g, (name) => metricWords(name).split(",")[0]);

function comparisonSection(data) {
  const {comparison} = data;
  if (!comparison) return;
  const box = section("The three yaw-control modes", comparison.samples
    ? `${plural(comparison.samples, "sample")} of the model's uncertainty, noise and disturbances; the same for every mode.` : "The model's own values, without spread.");
  const rate = comparison.options.heading_rate_limit;
  if (rate && rate !== "none") {
    add(box, "p", `Headings are led no faster than ${rate === "measured" ? "yaw resistance was measured" : `${rate} deg/s`}; the simulations above take them as the `
      + "scenarios do.");
  }
  if (comparison.overall && comparison.overall.length) {
    const names = distinct(comparison.overall.flatMap((o) => Object.keys(o.best_or_tied)));
    add(box, "h3", "In how many scenarios each mode is best or level with the best");
    table(box, ["figure", "#scenarios", ...names.map((n) => `#${n}`)], comparison.overall.map((o) => [metricWords(o.metric), o.scenarios, ...names.map((n) => o.best_or_tied[n] ?? "–")]),
      (k, i) => i > 1 && comparison.overall[k].best_or_tied[names[i - 2]] === Math.max(...Object.values(comparison.overall[k].best_or_tied)));
  }
  breakEven(box, comparison.break_even);
  comparison.scenarios.forEach((scenario, i) => {
    const details = add(box, "details");
    details.open = i === 0 && innerWidth > 640;
    add(details, "summary", scenario.name);
    add(details, "p", inWords(scenario.verdict));
    const inside = add(details, "div");
    ranking(inside, scenario);
    spreadCharts(inside, scenario, (data.samples || {})[scenario.name]);
    differences(inside, scenario);
  });
}
