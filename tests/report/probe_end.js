// Runs after the report's scripts: inspects the page as it opens, then opens and draws all of it.
// Leaves the results as JSON in the attribute data-probe of the page's frame.

/// Converts the drawn shape back to the units of the axes.
function drawnExtent(chart, name) {
  const index = chart.series.findIndex((s) => s.name === name);
  const box = chart.node.querySelector(`.series_${index} path`).getBBox();
  const at = (axis, pixel) => chart.view.scale(axis).invert(pixel);
  return {x: [at("x", box.x), at("x", box.x + box.width)], y: [at("y", box.y + box.height), at("y", box.y)]};
}

/// Elements that extend over the right edge, except inside boxes that scroll.
function overflowing() {
  const width = document.documentElement.clientWidth;
  return [...document.querySelectorAll("main *")].filter((node) => !node.closest(".scroll") && !node.ownerSVGElement && node.getBoundingClientRect().right > width + 1)
    .map((node) => `${node.tagName} ${node.className.baseVal ?? node.className}`).slice(0, 5);
}

/// Axis texts that extend over the edge of their chart.
function clipped() {
  return allCharts.filter((chart) => {
    const frame = chart.node.getBoundingClientRect();
    return [...chart.node.querySelectorAll("svg text")].some((text) => {
      const box = text.getBoundingClientRect();
      return box.width && (box.left < frame.left - 1 || box.right > frame.right + 1 || box.top < frame.top - 1 || box.bottom > frame.bottom + 1);
    });
  }).map((chart) => chart.title);
}

/// Relative luminance of a colour #rgb or #rrggbb, and the contrast of two (WCAG 2).
function luminance(colour) {
  const hex = colour.length === 4 ? [...colour.slice(1)].map((c) => c + c).join("") : colour.slice(1);
  const linear = [0, 2, 4].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255)
    .map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
  return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
}
function contrast(a, b) {
  const [high, low] = [luminance(a), luminance(b)].sort((x, y) => y - x);
  return (high + 0.05) / (low + 0.05);
}

/// The least contrast of texts and of lines on both backgrounds, in light and dark.
function contrasts() {
  const [light, dark] = [...document.styleSheets[0].cssRules].flatMap((rule) => (rule.selectorText === ":root" ? [rule.style]
    : rule.media && rule.cssRules[0].selectorText === ":root" ? [rule.cssRules[0].style] : []));
  const least = (names) => Math.min(...[light, dark].flatMap((style) => names.flatMap((name) => ["--paper", "--wash"].map((ground) =>
    contrast(style.getPropertyValue(name).trim(), style.getPropertyValue(ground).trim())))));
  return {text: least(["--ink", "--dim", "--warn", "--bad"]), line: least(["--differential", "--steering", "--combined", "--model"])};
}

/// Headings that nothing follows.
function orphans() {
  const isHeading = (node) => /^H[1-6]$/.test(node.tagName);
  return [...document.querySelectorAll("main h1, main h2, main h3, main h4")].filter((node) => {
    const next = node.parentNode.tagName === "SUMMARY" ? node.parentNode.nextElementSibling : node.nextElementSibling;
    return !next || isHeading(next) || !next.textContent.trim();
  }).map((node) => node.textContent);
}

/// The summary as it opens: what a user sees without scrolling.
function look_at_summary() {
  const summary = document.querySelector("#summary");
  const tiles = [...summary.querySelectorAll(".tiles li")];
  const lists = summary.querySelectorAll("ol");
  return {tiles: summary.querySelectorAll(".tiles li").length, bottom: summary.getBoundingClientRect().bottom,
    tones: tiles.map((one) => one.className), texts: tiles.map((one) => one.textContent),
    steps: [...lists[lists.length - 1].children].map((one) => one.textContent),
    sketches: summary.querySelectorAll("svg[role=img][aria-label]").length, charts: summary.querySelectorAll(".plot").length,
    symbols: [...summary.querySelectorAll("th abbr[title]")].map((one) => one.textContent)};
}

/// A run of the tuned gains in the page, to be compared with the command line's.
function look_at_live() {
  const {columns, metrics, constraints} = awmrLive.run({...awmrLive.tuned, mode: "combined"});
  const {t_s, psi_rad, u_mps, steering_rad, r_radps} = columns;
  probe.live = {metrics, constraints, columns: {t_s, psi_rad, u_mps, steering_rad, r_radps}};
  const slider = document.querySelector(".controls input");  // lambda
  slider.value = 700;
  slider.dispatchEvent(new Event("input"));
}

/// Text that the button copies after the slider was moved, and the resulting run in the page.
function look_at_moved() {
  const gains = JSON.parse(document.querySelector(".live pre").textContent);
  const {heading, speed} = gains;
  const run = awmrLive.run({...awmrLive.tuned, ...heading, speed_mu: speed.mu, speed_epsilon: speed.epsilon, mode: "combined"});
  probe.moved = {gains, columns: {psi_rad: run.columns.psi_rad}};
}

/// Calls `then` when the live part has loaded or failed to load. It is unpacked in another thread,
/// for which the browser's virtual time does not wait: each poll takes some real milliseconds.
function whenLive(then, looks = 100) {
  const expected = document.getElementById("wasm").textContent && report.live;
  if (!expected || window.awmrLive || looks === 0) return then();
  for (let i = 0, x = 0; i < 1e7; ++i) x += Math.sqrt(i);
  setTimeout(() => whenLive(then, looks - 1), 20);
}

/// Inspects the page after everything is opened and drawn.
async function look() {
  probe.width = document.documentElement.clientWidth;
  probe.scroll_width = document.documentElement.scrollWidth;
  probe.overflowing = overflowing();
  probe.clipped = clipped();
  probe.wide_tables = [...document.querySelectorAll(".scroll")].filter((box) => box.scrollWidth > box.clientWidth + 1).map((box) => box.textContent.slice(0, 80));
  probe.charts = allCharts.length;
  probe.drawn = document.querySelectorAll(".plot svg").length;
  probe.unlabelled = [...document.querySelectorAll(".plot svg")].filter((svg) => !svg.getAttribute("aria-label") && !svg.querySelector("[aria-label]")).length;
  probe.paths = allCharts.filter((chart) => chart.equal).map((chart) => ({...drawnExtent(chart, chart.series[0].name), name: chart.series[0].name,
    waypoints: (chart.series.find((s) => s.kind === "points") || {points: []}).points.length,
    pixels_per_metre: ["x", "y"].map((axis) => Math.abs(chart.view.scale(axis)(1) - chart.view.scale(axis)(0)))}));
  probe.contrasts = contrasts();
  probe.orphans = orphans();
  probe.contents = [...document.querySelectorAll("nav a")].map((link) => Boolean(document.querySelector(link.getAttribute("href"))));
  probe.sections = document.querySelectorAll("main > section").length;
  const ranged = allCharts.filter((chart) => !chart.series.length);
  probe.truncated = ranged.filter(({extent}) => extent.x[0] > 0 || extent.x[1] < 0).map((chart) => chart.title);
  probe.shaded = allCharts.filter((chart) => chart.series.some((s) => s.kind === "shade")).map((chart) => chart.title);
  probe.never_settled = allCharts.flatMap((chart) => chart.rows || []).filter((row) => !isNumber(row.middle)).map((row) => row.absent);
  probe.bars = document.querySelectorAll("svg.bar").length;
  probe.unresolved = allCharts.filter((chart) => JSON.stringify(exported(chart)).includes("var(")).map((chart) => chart.title);
  probe.saved = await Promise.all([allCharts[0], ranged[0]].filter(Boolean).map((chart) => imageOf(chart, "png").then((url) => url.slice(0, 22))));
  probe.foreign_elements = document.querySelectorAll("main img, main script, main iframe").length;
  probe.shows_hostile_name = document.querySelector("main").textContent.includes("<" + "/script><script>boom()");
}

addEventListener("load", () => {
  probe.opened_ms = performance.now();
  probe.first_height = document.documentElement.scrollHeight;
  probe.summary = look_at_summary();
  probe.first_text = document.querySelector("main").innerText.slice(0, 400);
  probe.requests = performance.getEntriesByType("resource").map((entry) => entry.name);
  whenLive(() => {
    drawAll();
    if (window.awmrLive) look_at_live();
    requestAnimationFrame(() => setTimeout(async () => {
      try {
        if (window.awmrLive) look_at_moved();
        await look();
      } catch (error) {
        probe.errors.push(`probe: ${error.message}`);
      }
      frameElement.dataset.probe = JSON.stringify(probe);
    }, 300));
  });
});
