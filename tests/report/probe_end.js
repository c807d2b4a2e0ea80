// Runs after the report's scripts: inspects the page as it opens, then opens and draws all of it.
// Leaves the results as JSON in the attribute data-probe of the outermost page.

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
function look() {
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
  probe.foreign_elements = document.querySelectorAll("main img, main script, main iframe").length;
  probe.shows_hostile_name = document.querySelector("main").textContent.includes("<" + "/script><script>boom()");
}

addEventListener("load", () => {
  probe.opened_ms = performance.now();
  probe.first_height = document.documentElement.scrollHeight;
  probe.first_text = document.querySelector("main").innerText.slice(0, 400);
  probe.requests = performance.getEntriesByType("resource").map((entry) => entry.name);
  whenLive(() => {
    drawAll();
    if (window.awmrLive) look_at_live();
    requestAnimationFrame(() => setTimeout(() => {
      try {
        if (window.awmrLive) look_at_moved();
        look();
      } catch (error) {
        probe.errors.push(`probe: ${error.message}`);
      }
      top.document.documentElement.dataset.probe = JSON.stringify(probe);
    }, 300));
  });
});
