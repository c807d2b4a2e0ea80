// Range chart: one row per entry, with a bar from low to high, a mark in the middle and small marks
// for single values.

/// `rows`: [{label, low, high, middle, values: [], colour, note}]; `zero`: a line at 0; `limit`:
/// values are clipped here.
function ranges(parent, options) {
  const chart = {...options, rows: options.rows.filter((r) => isNumber(r.middle)), circles: []};
  if (!chart.rows.length) return;
  const numbers = chart.rows.flatMap((r) => [r.low, r.high, r.middle, ...(r.values || [])]).filter(isNumber);
  if (chart.zero) numbers.push(0);
  const low = Math.min(...numbers), high = Math.max(...numbers), room = 0.04 * (high - low || Math.abs(high) || 1);
  chart.extent = {x: [low - room, high + room], y: [0, 1]};
  chart.height = 44 + 22 * chart.rows.length;
  chart.figure = add(parent, "figure");
  const caption = add(chart.figure, "figcaption");
  add(caption, "span", chart.title);
  chart.reset = add(caption, "button", "whole", {class: "reset", type: "button", hidden: ""});
  chart.node = add(chart.figure, "div", undefined, {class: "plot", style: `min-height: ${chart.height}px`});
  chart.series = [];
  chart.specification = rangeSpecification;
  register(chart);
  return chart;
}

function rangeSpecification(chart) {
  const row = {scale: "y", field: "label", band: 0.5};
  const colour = {field: "colour"};
  const text = {signal: "datum.note"};
  const values = chart.rows.flatMap((r) => (r.values || []).map((x) => ({label: r.label, x, colour: r.colour})));
  const words = chart.rows.map((r) => `${r.label}: ${digits(r.middle, 3)}` +
    (isNumber(r.low) ? ` (${digits(r.low, 3)} to ${digits(r.high, 3)})` : ""));
  return {
    description: `${chart.title}. ${words.join("; ")}.`, autosize: {type: "fit", contains: "padding", resize: true}, padding: 4,
    width: 300, height: chart.height, config: style,
    signals: [{name: "view_x", value: chart.extent.x}],
    data: [{name: "rows", values: chart.rows}, {name: "values", values}],
    scales: [{name: "x", type: "linear", range: "width", domain: {signal: "view_x"}, zero: false},
      {name: "y", type: "band", range: "height", domain: chart.rows.map((r) => r.label)}],
    axes: [{scale: "x", orient: "bottom", grid: true, title: chart.x, tickCount: {signal: "ceil(width / 70)"}, labelOverlap: true},
      {scale: "y", orient: "left", labelFlush: false, domain: false, ticks: false, labelLimit: 190, labelPadding: 6}],
    marks: [
      ...(chart.zero ? [{type: "rule", aria: false, encode: {update: {x: {scale: "x", value: 0}, y: {value: 0}, y2: {signal: "height"},
        stroke: {value: "var(--dim)"}}}}] : []),
      {type: "symbol", from: {data: "values"}, aria: false, clip: true, encode: {update: {x: {scale: "x", field: "x"}, y: row,
        shape: {value: "stroke"}, angle: {value: 90}, size: {value: 90}, stroke: colour, opacity: {value: 0.28}}}},
      {type: "rule", from: {data: "rows"}, aria: false, clip: true, encode: {update: {x: {scale: "x", field: "low"},
        x2: {scale: "x", field: "high"}, y: row, stroke: colour, strokeWidth: {value: 3}, strokeCap: {value: "round"},
        opacity: {signal: "isNumber(datum.low) ? 0.75 : 0"}, tooltip: text}}},
      {type: "symbol", from: {data: "rows"}, clip: true, description: chart.title, encode: {update: {x: {scale: "x", field: "middle"},
        y: row, size: {value: 70}, fill: colour, stroke: {value: "var(--paper)"}, tooltip: text}}},
    ],
  };
}
