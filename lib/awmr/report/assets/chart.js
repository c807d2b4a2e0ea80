// Charts: converts a short description to a specification for Vega, which draws it as SVG. Colours
// are the page's variables, so that a chart follows light, dark and print style automatically.

const allCharts = [];

/// Margins around every plot, pixels: the same for all, so that the axes of charts below each other
/// align.
const margin = {left: 62, right: 14, top: 8, bottom: 40};

const style = {
  axis: {labelColor: "var(--dim)", titleColor: "var(--dim)", gridColor: "var(--line)", domainColor: "var(--line)",
    tickColor: "var(--line)", labelFont: "system-ui, sans-serif", titleFont: "system-ui, sans-serif", labelFontSize: 11,
    titleFontSize: 12, titleFontWeight: "normal", labelFlush: true},
};

/// The mark of one series, visible unless the signal `hidden` contains its index.
function markOf(series, index) {
  const x = {scale: "x", field: "0"};
  const y = {scale: "y", field: "1"};
  const visible = {signal: `indexof(hidden, ${index}) < 0 ? ${series.opacity || 1} : 0`};
  const colour = {value: series.colour};
  const mark = {clip: true, name: `series_${index}`, from: {data: `data_${index}`}, aria: true,
    description: series.name, encode: {update: {x, y, opacity: visible}}};
  const draw = mark.encode.update;
  if (series.kind === "band") {
    mark.type = "area";
    Object.assign(draw, {y2: {scale: "y", field: "2"}, fill: colour, fillOpacity: {value: 0.18}});
  } else if (series.kind === "points") {
    Object.assign(mark, {type: "symbol", aria: false});
    Object.assign(draw, {fill: colour, size: {value: series.size || 55}, shape: {value: series.shape || "circle"},
      stroke: {value: "var(--paper)"}, strokeWidth: {value: 1}});
  } else {
    mark.type = "line";
    Object.assign(draw, {stroke: colour, strokeWidth: {value: series.width || 2}, strokeDash: {value: series.dash || []},
      strokeJoin: {value: "round"}, interpolate: {value: series.step ? "step-after" : "linear"}, defined: {signal: "isValid(datum[1])"}});
  }
  return mark;
}

/// Entry that represents all circles in a list of hidden series.
const circlesKey = "circles";
/// List of hidden elements of a chart.
const hiddenOf = (chart) => [...chart.series.flatMap((s, i) => (s.hidden ? [i] : [])), ...(chart.circlesHidden ? [circlesKey] : [])];

/// The circles of a chart with equal axes (obstacles), in its units.
function circleMarks(circles) {
  return circles.map((circle) => ({type: "arc", clip: true, description: circle.name, encode: {update: {
    x: {scale: "x", value: circle.x}, y: {scale: "y", value: circle.y}, startAngle: {value: 0}, endAngle: {value: 2 * Math.PI},
    opacity: {signal: `indexof(hidden, '${circlesKey}') < 0 ? 1 : 0`},
    outerRadius: {signal: `abs(scale('x', ${circle.radius}) - scale('x', 0))`}, fill: {value: "var(--bad)"},
    fillOpacity: {value: 0.25}, stroke: {value: "var(--bad)"}}}}));
}

/// `chart`: {title, x, y, series: [{name, kind: "line" | "points" | "band", points: [[x, y, ...]], colour, ...}], equal, circles}
function specification(chart) {
  // With equal axes, x and y have the same scale: the range is extended on the axis that has space
  // left.
  const domain = (axis, length) => (chart.equal
    ? `[mid_${axis} - unit * ${length} / 2, mid_${axis} + unit * ${length} / 2]` : `view_${axis}`);
  const signals = [
    {name: "view_x", value: chart.extent.x}, {name: "view_y", value: chart.extent.y},
    {name: "hidden", value: hiddenOf(chart)},
    {name: "pointed", value: null},
    {name: "mid_x", update: "(view_x[0] + view_x[1]) / 2"}, {name: "mid_y", update: "(view_y[0] + view_y[1]) / 2"},
    {name: "unit", update: "max((view_x[1] - view_x[0]) / width, (view_y[1] - view_y[0]) / height)"},
    {name: "domain_x", update: domain("x", "width")}, {name: "domain_y", update: domain("y", "height")},
  ];
  const scale = (name, range) => ({name, type: "linear", range, domain: {signal: `domain_${name}`}, zero: false, nice: false});
  const axis = (name, orient, title) => ({scale: name, orient, title, grid: true, tickCount: {signal: orient === "bottom"
    ? "ceil(width / 80)" : "ceil(height / 45)"}, labelOverlap: true, titlePadding: 4,
    ...(orient === "left" ? {minExtent: 40, maxExtent: 40, labelLimit: 46} : {})});
  const order = {band: 0, line: 1, points: 2};
  const marks = chart.series.map(markOf).map((mark, i) => [order[chart.series[i].kind], mark]);
  return {
    description: described(chart), autosize: "none", padding: margin,
    width: 300, height: chart.height, config: style, signals,
    data: chart.series.map((s, i) => ({name: `data_${i}`, values: s.points})),
    scales: [scale("x", "width"), scale("y", "height")],
    axes: [axis("x", "bottom", chart.x), axis("y", "left", chart.y)],
    marks: [...circleMarks(chart.circles || []), ...marks.sort((a, b) => a[0] - b[0]).map((entry) => entry[1]),
      {type: "rule", interactive: false, aria: false, encode: {update: {x: {scale: "x", signal: "pointed"}, y: {value: 0},
        y2: {signal: "height"}, stroke: {value: "var(--dim)"}, strokeDash: {value: [2, 2]},
        opacity: {signal: "isNumber(pointed) && inrange(pointed, domain_x) ? 1 : 0"}}}}],
  };
}

/// Range of both axes over the visible series, with a small margin.
function extentOf(series, circles) {
  const range = (values, room) => {
    let low = Infinity, high = -Infinity;
    for (const v of values) {
      if (!isNumber(v)) continue;
      if (v < low) low = v;
      if (v > high) high = v;
    }
    if (low > high) return [0, 1];
    const span = high - low || Math.max(1e-3, Math.abs(high) * 0.1);
    return [low - room * span, high + room * span];
  };
  const around = (circles || []).flatMap((c) => [[c.x - c.radius, c.y - c.radius], [c.x + c.radius, c.y + c.radius]]);
  const points = series.flatMap((s) => s.points);
  return {
    x: range([...points, ...around].map((p) => p[0]), 0.02),
    y: range([...points, ...around].flatMap((p, i) => (i < points.length && isNumber(p[2]) ? [p[1], p[2]] : [p[1]])), 0.06),
  };
}

/// Description of a chart for screen readers: its axes, and start, end and range of each series.
function described(chart) {
  const of = (s) => {
    const values = s.points.map((p) => p[1]).filter(isNumber);
    return values.length ? `${s.name}: ${plural(values.length, "point")} from ${digits(Math.min(...values), 3)} to ` +
      `${digits(Math.max(...values), 3)}` : `${s.name}: empty`;
  };
  return `${chart.title}, ${chart.y} over ${chart.x}. ${chart.series.filter((s) => !s.hidden).map(of).join("; ")}.`;
}

/// Adds a chart to `parent`. It is drawn when it is near the visible area, or before printing.
/// Charts of one `group` share the x range, the cursor and the hidden series. With `legend` false,
/// the group's own legend is used.
function plot(parent, options) {
  const chart = {height: 260, circles: [], ...options, series: options.series.filter((s) => s.points.length)};
  if (!chart.series.length) return;
  chart.extent = extentOf(chart.series, chart.circles);
  chart.figure = add(parent, "figure");
  const caption = add(chart.figure, "figcaption");
  add(caption, "span", chart.title);
  chart.reset = add(caption, "button", "whole", {class: "reset", type: "button", hidden: "", "aria-label": `show all of ${chart.title}`});
  if (chart.legend !== false && chart.series.length > 1) legend(chart.figure, chart.series, [chart]);
  chart.node = add(chart.figure, "div", undefined, {class: "plot", style: `min-height: ${chart.height}px`});
  chart.specification = specification;
  register(chart);
  if (chart.group) chart.group.push(chart);
  return chart;
}

/// Adds buttons that show and hide the series of these names in all of `charts`.
function legend(parent, entries, charts) {
  const box = add(parent, "div", undefined, {class: "legend", role: "group", "aria-label": "what is drawn"});
  for (const entry of entries) {
    const button = add(box, "button", undefined, {type: "button", "aria-pressed": String(!entry.hidden)});
    button.appendChild(sample(entry));
    add(button, "span", entry.name);
    button.onclick = () => {
      const shown = button.getAttribute("aria-pressed") !== "true";
      button.setAttribute("aria-pressed", String(shown));
      for (const chart of charts) {
        for (const s of chart.series) if (s.name === entry.name) s.hidden = !shown;
        if (entry.kind === "circle") chart.circlesHidden = !shown;
        if (chart.view) chart.view.signal("hidden", hiddenOf(chart)).run();
      }
    };
  }
}

/// Sample of a series for the legend.
function sample(entry) {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 26 10");
  svg.setAttribute("aria-hidden", "true");
  const elements = {points: "circle", circle: "circle", band: "rect", line: "line"};
  const outline = {cross: "M11.5 0h3v3.5H18v3h-3.5V10h-3V6.5H8v-3h3.5z", diamond: "M13 0l5 5-5 5-5-5z"}[entry.shape];
  const shape = document.createElementNS(svg.namespaceURI, outline ? "path" : elements[entry.kind]);
  const drawn = entry.kind === "circle" ? {cx: 13, cy: 5, r: 4.5, fill: entry.colour, "fill-opacity": 0.25, stroke: entry.colour}
    : outline ? {d: outline, fill: entry.colour}
    : entry.kind === "points" ? {cx: 13, cy: 5, r: 4, fill: entry.colour}
    : entry.kind === "band" ? {x: 0, y: 0, width: 26, height: 10, fill: entry.colour, "fill-opacity": 0.25}
    : {x1: 0, y1: 5, x2: 26, y2: 5, stroke: entry.colour, "stroke-opacity": entry.opacity || 1, "stroke-width": entry.width || 2, "stroke-dasharray": (entry.dash || []).join(" ")};
  for (const [name, value] of Object.entries(drawn)) shape.setAttribute(name, value);
  svg.appendChild(shape);
  return svg;
}
