// Charts: converts a short description of a chart to a specification for Vega, which draws SVG.
// Colours are CSS variables of the page, so that charts follow its light, dark and print styles.

const allCharts = [];

/// Margins around every plot, pixels; equal, so that the axes of stacked charts are aligned.
const margin = {left: 62, right: 14, top: 8, bottom: 40};

const font = "system-ui, sans-serif";
const style = {
  axis: {labelColor: "var(--dim)", titleColor: "var(--dim)", gridColor: "var(--line)",
    domainColor: "var(--line)", tickColor: "var(--line)", labelFont: font, titleFont: font,
    labelFontSize: 11, titleFontSize: 12, titleFontWeight: "normal", labelFlush: true},
  legend: {labelColor: "var(--ink)", labelFont: font, labelFontSize: 11, labelLimit: 260},
};

/// Shapes of points for Vega. The legend of the page draws the first two as well.
const shapePaths = {
  cross: "M11.5 0h3v3.5H18v3h-3.5V10h-3V6.5H8v-3h3.5z", diamond: "M13 0l5 5-5 5-5-5z",
  square: "M9 1h8v8h-8z", "triangle-up": "M13 0l5 9h-10z",
};

/// Vega marks of each kind of series.
const markOfKind = {
  band: (s, at, colour) => ({type: "area",
    update: {...at, y2: {scale: "y", field: "2"}, fill: colour, fillOpacity: {value: 0.18}}}),
  points: (s, at, colour) =>
    ({type: "symbol", aria: false, update: {...at, fill: s.fill ? {value: s.fill} : colour,
    size: {value: s.size || 55}, shape: {value: s.shape || "circle"},
    stroke: s.fill ? colour : {value: "var(--paper)"}, strokeWidth: {value: s.fill ? 1.5 : 1}}}),
  line: (s, at, colour) =>
    ({type: "line", update: {...at, stroke: colour, strokeWidth: {value: s.width || 2},
    strokeDash: {value: s.dash || []}, strokeJoin: {value: "round"},
    interpolate: {value: s.step ? "step-after" : "linear"},
      defined: {signal: "isValid(datum[1])"}}}),
  // Shades all values above limit and below -limit.
  shade: (s, at, colour) =>
    ({type: "rect", aria: false, update: {x: {value: 0}, x2: {signal: "width"},
    y: {signal: "scale('y', min(datum[1], domain_y[1]))"},
    y2: {signal: "scale('y', max(datum[0], domain_y[0]))"}, fill: colour}}),
};

/// Vega mark of one series, invisible while the signal `hidden` contains the series' index.
function markOf(series, index) {
  const at = {x: {scale: "x", field: "0"}, y: {scale: "y", field: "1"}};
  const {update, ...mark} = {aria: true, ...markOfKind[series.kind](series, at,
    {value: series.colour})};
  update.opacity = {signal: `indexof(hidden, ${index}) < 0 ? ${series.opacity || 1} : 0`};
  return {...mark, clip: true, name: `series_${index}`, from: {data: `data_${index}`},
    description: series.name, encode: {update}};
}
const valuesOf = (s) => (s.kind === "shade" ? [[s.limit, 1e12], [-1e12, -s.limit]] : s.points);

/// Value in the signal `hidden` that hides all circles (obstacles) of a chart.
const circlesKey = "circles";
/// Value of the Vega signal `hidden`: indices of the hidden series, and circlesKey if the
/// circles (obstacles) are hidden.
const hiddenOf = (chart) => [...chart.series.flatMap((s, i) => (s.hidden ? [i] : [])),
  ...(chart.circlesHidden ? [circlesKey] : [])];

/// Marks of the circles (obstacles) of a chart with equal axes, in the units of the axes.
function circleMarks(circles) {
  return circles.map((circle) => ({type: "arc", clip: true, interactive: false, aria: true,
    description: circle.name, encode: {update: {
      opacity: {signal: `indexof(hidden, '${circlesKey}') < 0 ? 1 : 0`},
      x: {scale: "x", value: circle.x}, y: {scale: "y", value: circle.y},
      startAngle: {value: 0}, endAngle: {value: 2 * Math.PI}, innerRadius: {value: 0},
      outerRadius: {signal: `abs(scale('x', ${circle.radius}) - scale('x', 0))`},
      fill: {value: obstacleLook.colour}, fillOpacity: {value: 0.25},
      stroke: {value: obstacleLook.colour}}}}));
}

/// Mark of the vertical line at the pointer.
const pointedRule = {type: "rule", interactive: false, aria: false, encode: {update: {
  x: {scale: "x", signal: "pointed"}, y: {value: 0}, y2: {signal: "height"},
  stroke: {value: "var(--dim)"}, strokeDash: {value: [2, 2]},
  opacity: {signal: "isNumber(pointed) && inrange(pointed, domain_x) ? 1 : 0"}}}};

/// Vega specification of a chart: {title, x, y, series: [{name, kind: "line" | "points" | "band" |
/// "shade", points: [[x, y, ...]], colour, ...}], equal, circles}. x, y: titles of the axes; equal:
/// both axes have the same scale; circles: obstacles.
function specification(chart) {
  // With equal axes, x and y have the same scale, so the axis with more pixels gets a longer range.
  const domain = (axis, length) => (chart.equal
    ? `[mid_${axis} - unit * ${length} / 2, mid_${axis} + unit * ${length} / 2]` : `view_${axis}`);
  const signals = [
    {name: "view_x", value: chart.extent.x}, {name: "view_y", value: chart.extent.y},
    {name: "hidden", value: hiddenOf(chart)},
    {name: "pointed", value: null},
    {name: "mid_x", update: "(view_x[0] + view_x[1]) / 2"},
    {name: "mid_y", update: "(view_y[0] + view_y[1]) / 2"},
    {name: "unit", update: "max((view_x[1] - view_x[0]) / width, (view_y[1] - view_y[0]) / height)"},
    {name: "domain_x", update: domain("x", "width")},
      {name: "domain_y", update: domain("y", "height")},
  ];
  const scale = (name, range) => (
    {name, type: "linear", range, domain: {signal: `domain_${name}`}, zero: false, nice: false});
  const axis = (name, orient, title) => ({scale: name, orient, title, grid: true,
    tickCount: {signal: orient === "bottom" ? "ceil(width / 80)" : "ceil(height / 45)"},
    labelOverlap: true, titlePadding: 4,
    ...(orient === "left" ? {minExtent: 40, maxExtent: 40, labelLimit: 46} : {})});
  const order = {shade: 0, band: 1, line: 2, points: 3};
  const marks = chart.series.map(markOf).map((mark, i) => [order[chart.series[i].kind], mark]);
  return {
    description: described(chart), autosize: "none", padding: margin,
    width: 300, height: chart.height, config: style, signals,
    data: chart.series.map((s, i) => ({name: `data_${i}`, values: valuesOf(s)})),
    scales: [scale("x", "width"), scale("y", "height")],
    axes: [axis("x", "bottom", chart.x), axis("y", "left", chart.y)],
    marks: [...circleMarks(chart.circles || []),
      ...marks.sort((a, b) => a[0] - b[0]).map((entry) => entry[1]), pointedRule],
  };
}

/// Ranges of both axes that include the visible series and circles, with a small margin. `zero`
/// names the axes that include 0, `least` is the smallest length of the y range.
function extentOf({series, circles, zero = "", least = 0}) {
  const range = (values, room, most) => {
    let low = Infinity, high = -Infinity;
    for (const v of values) {
      if (!isNumber(v)) continue;
      if (v < low) low = v;
      if (v > high) high = v;
    }
    if (low > high) return [0, 1];
    const span = high - low || Math.max(1e-3, Math.abs(high) * 0.1);
    const more = Math.max(room * span, (most - span) / 2);
    return [low - more, high + more];
  };
  const around = (circles || []).flatMap((c) =>
    [[c.x - c.radius, c.y - c.radius], [c.x + c.radius, c.y + c.radius]]);
  const points = series.flatMap((s) => s.points);
  const origin = (axis) => (zero.includes(axis) ? [0] : []);
  return {
    x: range([...points.map((p) => p[0]), ...around.map((p) => p[0]), ...origin("x")], 0.02, 0),
    y: range([...points.flatMap((p) => (isNumber(p[2]) ? [p[1], p[2]] : [p[1]])),
      ...around.map((p) => p[1]), ...origin("y")], 0.06, least),
  };
}

/// Text that describes a chart for screen readers: its axes, and the range of each series.
function described(chart) {
  const of = (s) => {
    if (s.kind === "shade") return s.name;
    const values = s.points.map((p) => p[1]).filter(isNumber);
    return values.length ? `${s.name}: ${plural(values.length, "point")} from ` +
      `${digits(Math.min(...values))} to ${digits(Math.max(...values))}` : `${s.name}: empty`;
  };
  const shown = chart.series.filter((s) => !s.hidden);
  return `${chart.title}, ${chart.y} over ${chart.x}. ${shown.map(of).join("; ")}.`;
}

/// Adds the frame of a chart to the page: a caption with buttons, and the box of the chart.
function framed(parent, chart) {
  chart.figure = add(parent, "figure");
  const caption = add(chart.figure, "figcaption");
  add(caption, "span", chart.title);
  const button = (text, label, classes) => add(caption, "button", text,
    {class: classes, type: "button", "aria-label": `${label} ${chart.title}`});
  chart.reset = button("whole", "show all of", "reset");
  chart.reset.hidden = true;
  for (const kind of ["svg", "png"]) {
    button(kind.toUpperCase(), `save as ${kind.toUpperCase()}:`, "save").onclick = () =>
      save(chart, kind);
  }
  if (chart.series.length > 1 && chart.legend !== false) legend(chart.figure, chart.series,
    [chart]);
  chart.node = add(chart.figure, "div", undefined,
    {class: "plot", style: `min-height: ${chart.height}px`});
  register(chart);
  return chart;
}

/// Adds a chart to `parent`. The chart is drawn when it comes near the visible area, or before
/// printing. Charts of the same `group` share the x range, the cursor and the hidden series. With
/// `legend` false, the chart has no legend of its own, because the group has one.
function plot(parent, options) {
  const series = options.series.filter((s) => s.kind === "shade" || s.points.length);
  if (!series.some((s) => s.kind !== "shade")) return undefined;
  const chart = {height: 260, circles: [], specification, ...options,
    series: series.map((s) => ({points: [], ...s}))};
  chart.extent = extentOf(chart);
  if (chart.group) chart.group.push(chart);
  return framed(parent, chart);
}

/// Adds buttons, one for each of these series, that show and hide the series in all of `charts`.
function legend(parent, entries, charts) {
  const box = add(parent, "div", undefined, {class: "legend", role: "group",
    "aria-label": "series"});
  for (const entry of entries) {
    const button = add(box, "button", undefined,
      {type: "button", "aria-pressed": String(!entry.hidden)});
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

/// Small drawing of the line and the mark of a series, for the legend.
function sample(entry) {
  const {kind, colour, opacity, width, dash, shape, fill} = entry;
  const svg = drawIn(document.createElement("span"), "svg",
    {viewBox: "0 0 26 10", "aria-hidden": "true"});
  const inked = {fill: fill || colour, ...(fill && {stroke: colour, "stroke-width": 1.5})};
  const block = {x: 0, y: 0, width: 26, height: 10, fill: colour};
  const [tag, drawn] = {
    circle: ["circle", {cx: 13, cy: 5, r: 4.5, fill: colour, "fill-opacity": 0.25, stroke: colour}],
    points: shapePaths[shape] ? ["path", {d: shapePaths[shape], ...inked}]
      : ["circle", {cx: 13, cy: 5, r: 4, ...inked}],
    band: ["rect", {...block, "fill-opacity": 0.25}],
    shade: ["rect", block],
    line: ["line", {x1: 0, y1: 5, x2: 26, y2: 5, stroke: colour, "stroke-opacity": opacity || 1,
      "stroke-width": width || 2, "stroke-dasharray": (dash || []).join(" ")}],
  }[kind];
  drawIn(svg, tag, drawn);
  return svg;
}
