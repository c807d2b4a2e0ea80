// Draws charts when they come near the visible area, and handles zoom and tooltips.

const onScreen = new IntersectionObserver((entries) => {
  for (const entry of entries) if (entry.isIntersecting) draw(entry.target.chart);
}, {rootMargin: "300px"});
const resized = new ResizeObserver((entries) => {
  // Resizes in the next frame: a change in this callback would call the callback again.
  requestAnimationFrame(() => entries.forEach(({target}) => fit(target.chart, target.clientWidth)));
});

function register(chart) {
  chart.node.chart = chart;
  allCharts.push(chart);
  onScreen.observe(chart.node);
}

/// Opens all sections and draws all charts. Returns the sections that were closed before.
function drawAll() {
  const closed = [...document.querySelectorAll("details:not([open])")];
  for (const details of closed) details.open = true;
  allCharts.forEach(draw);
  return closed;
}

/// Prepares the page for print: opens all sections, and sizes the charts for a column of A4, so
/// that their text stays readable.
const paperColumn = 318, paperHeight = 200;
let closedBefore = [];
addEventListener("beforeprint", () => {
  closedBefore = drawAll();
  for (const chart of allCharts) fit(chart, paperColumn, paperHeight);
});
addEventListener("afterprint", () => {
  for (const chart of allCharts) fit(chart, chart.node.clientWidth);
  for (const details of closedBefore) details.open = false;
});

function draw(chart) {
  if (chart.view) return;
  onScreen.unobserve(chart.node);
  const view = new vega.View(vega.parse(chart.specification(chart)),
    {renderer: "svg", hover: false, logLevel: vega.Error});
  chart.view = view;
  if (!chart.series.length) view.tooltip((handler, event, item, value) =>
    hint(chart, event, value));
  view.initialize(chart.node);
  fit(chart, chart.node.clientWidth || 480);
  chart.node.classList.add("drawn");
  resized.observe(chart.node);
  if (chart.series.length) listen(chart);
}

/// Sets the size of a chart. outer: width in pixels, with margins; most: largest height in pixels.
/// If both axes have the same scale, the height follows from the ranges of the axes, within limits.
function fit(chart, outer, most = Infinity) {
  if (!chart.view || outer < 50 || outer === chart.outer) return;
  chart.outer = outer;
  if (!chart.series.length) return chart.view.width(outer).run();  // Vega reserves space for names
  const width = outer - margin.left - margin.right;
  const {x, y} = chart.extent;
  const height = chart.equal ? Math.min(420, 1.2 * most,
    Math.max(130, width * (y[1] - y[0]) / (x[1] - x[0])))
      : Math.min(chart.height, most) - margin.top - margin.bottom;
  chart.view.width(width).height(height).run();
}

/// Position of the pointer in a plot: x, y in pixels from the upper left corner of the plot, and
/// `unit`, the same position in the units of the axes.
function place(chart, event) {
  const box = chart.node.getBoundingClientRect();
  const [left, top] = chart.view.origin();
  const pixel = {x: event.clientX - box.left - left, y: event.clientY - box.top - top};
  return {...pixel, unit: {x: chart.view.scale("x").invert(pixel.x),
    y: chart.view.scale("y").invert(pixel.y)}};
}

const linked = (chart) => (chart.group && !chart.equal
  ? chart.group.filter((c) => c.view && !c.equal) : [chart]);

function listen(chart) {
  const node = chart.node;
  let start = null, box = null;
  node.addEventListener("pointerdown", (event) => {
    if (event.pointerType !== "mouse" || event.button !== 0) return;
    start = {...place(chart, event), clientX: event.clientX, clientY: event.clientY};
    box = add(node, "div", undefined, {class: "selection"});
    node.setPointerCapture(event.pointerId);
    event.preventDefault();
  });
  node.addEventListener("pointermove", (event) => {
    if (start) return outline(box, node, start, event);
    point(chart, event);
  });
  node.addEventListener("pointerup", (event) => {
    if (!start) return;
    const from = start;
    const to = place(chart, event);
    box.remove();
    start = null;
    if (Math.abs(to.x - from.x) > 8 && Math.abs(to.y - from.y) > 8) zoom(chart, from.unit, to.unit);
  });
  node.addEventListener("pointerleave", () => leave(chart));
  node.addEventListener("dblclick", () => whole(chart));
  chart.reset.onclick = () => whole(chart);
}

function outline(box, node, start, event) {
  const frame = node.getBoundingClientRect();
  box.style.left = `${Math.min(start.clientX, event.clientX) - frame.left}px`;
  box.style.top = `${Math.min(start.clientY, event.clientY) - frame.top}px`;
  box.style.width = `${Math.abs(start.clientX - event.clientX)}px`;
  box.style.height = `${Math.abs(start.clientY - event.clientY)}px`;
}

const sorted = (a, b) => [Math.min(a, b), Math.max(a, b)];
function zoom(chart, from, to) {
  chart.view.signal("view_y", sorted(from.y, to.y));
  for (const other of linked(chart)) {
    other.view.signal("view_x", sorted(from.x, to.x)).run();
    other.reset.hidden = false;
  }
}
function whole(chart) {
  for (const other of linked(chart)) {
    other.view.signal("view_x", other.extent.x).signal("view_y", other.extent.y).run();
    other.reset.hidden = true;
  }
}

/// Shows a tooltip with the values of all series at the x of the pointer. In charts with the option
/// `byPoint` or with equal axes, the tooltip shows only the point nearest to the pointer.
function point(chart, event) {
  const at = place(chart, event);
  const shown = chart.series.filter((s) => !s.hidden && s.kind !== "band" && s.kind !== "shade");
  const nearest = (s) => s.points.reduce((best, p) => {
    const distance = chart.byPoint || chart.equal
      ? Math.hypot(chart.view.scale("x")(p[0]) - at.x, chart.view.scale("y")(p[1]) - at.y)
        : Math.abs(chart.view.scale("x")(p[0]) - at.x);
    return distance < best.distance ? {distance, p} : best;
  }, {distance: Infinity});
  let found = shown.map((s) => ({s, ...nearest(s)})).filter((f) => f.distance < 40);
  if (chart.byPoint || chart.equal) found = found.sort((a, b) => a.distance - b.distance).slice(0,
    1);
  if (!found.length) return leave(chart);
  const words = (f) => `${f.s.name}: ${digits(f.p[1])}` +
    (chart.byPoint || chart.equal ? ` at ${digits(f.p[0])}` : "") +
    (typeof f.p[2] === "string" ? `\n${f.p[2]}` : "");
  const head = chart.byPoint || chart.equal ? [] : [`${chart.x}: ${digits(found[0].p[0])}`];
  hint(chart, event, [...head, ...found.map(words)].join("\n"));
  if (chart.byPoint || chart.equal) return;
  for (const other of linked(chart)) other.view.signal("pointed", at.unit.x).run();
}

function leave(chart) {
  hint(chart, null, null);
  for (const other of linked(chart)) if (other.series.length) other.view.signal("pointed",
    null).run();
}

function hint(chart, event, text) {
  if (chart.hint) chart.hint.remove();
  chart.hint = null;
  if (!text) return;
  const frame = chart.node.getBoundingClientRect();
  chart.hint = add(chart.node, "div", text, {class: "hint", role: "status"});
  const x = event.clientX - frame.left, y = event.clientY - frame.top;
  const width = chart.hint.offsetWidth;
  const left = x + 14 + width > frame.width ? x - width - 14 : x + 14;
  chart.hint.style.left = `${Math.max(0, left)}px`;
  chart.hint.style.top = `${Math.max(0, y - 10)}px`;
}
