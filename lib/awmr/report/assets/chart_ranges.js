// Chart of ranges: one row per entry, with a bar from low to high, a mark at `middle` (median) and
// small marks for single values. The axis includes 0.

/// `rows`: [{label, low, high, middle, values: [], colour, dash, shape, note, absent}]; a row
/// without `middle` shows the text `absent`.
function ranges(parent, options) {
  const rows = options.rows.filter((r) => isNumber(r.middle) || r.absent);
  if (!rows.length) return;
  const numbers = [0, ...rows.flatMap((r) =>
    [r.low, r.high, r.middle, ...(r.values || [])])].filter(isNumber);
  const low = Math.min(...numbers), high = Math.max(...numbers);
  const room = 0.04 * (high - low || 1);
  framed(parent, {...options, rows, circles: [], series: [], specification: rangeSpecification,
    height: 44 + 22 * rows.length, extent: {x: [low - room, high + room], y: [0, 1]}});
}

function rangeSpecification(chart) {
  const row = {scale: "y", field: "label", band: 0.5};
  const colour = {field: "colour"};
  const tooltip = {signal: "datum.note"};
  const values = chart.rows.flatMap((r) => (r.values || []).map((x) =>
    ({label: r.label, x, colour: r.colour})));
  const words = chart.rows.map((r) =>
    `${r.label}: ${isNumber(r.middle) ? digits(r.middle) : r.absent}` +
    (isNumber(r.low) ? ` (${digits(r.low)} to ${digits(r.high)})` : ""));
  const mark = (type, data, update, more) =>
    ({type, clip: true, aria: false, ...(data && {from: {data}}), encode: {update}, ...more});
  const isThere = {signal: "isNumber(datum.middle) ? 1 : 0"};
  return {
    description: `${chart.title}. ${words.join("; ")}.`,
    autosize: {type: "fit", contains: "padding", resize: true}, padding: 4,
    width: 300, height: chart.height, config: style,
    signals: [{name: "view_x", value: chart.extent.x}],
    data: [{name: "rows", values: chart.rows}, {name: "values", values}],
    scales: [{name: "x", type: "linear", range: "width", domain: {signal: "view_x"}, zero: false},
      {name: "y", type: "band", range: "height", domain: chart.rows.map((r) => r.label)}],
    axes: [{scale: "x", orient: "bottom", grid: true, title: chart.x,
      tickCount: {signal: "ceil(width / 70)"}, labelOverlap: true, labelSeparation: 8},
    {scale: "y", orient: "left", labelFlush: false, domain: false, ticks: false, labelLimit: 190,
      labelPadding: 6}],
    marks: [
      mark("rule", null, {x: {scale: "x", value: 0}, y: {value: 0}, y2: {signal: "height"},
        stroke: {value: "var(--dim)"}}, {clip: false}),
      mark("symbol", "values", {x: {scale: "x", field: "x"}, y: row, shape: {value: "stroke"},
        angle: {value: 90}, size: {value: 90}, stroke: colour, opacity: {value: 0.28}}),
      mark("rule", "rows", {x: {scale: "x", field: "low"}, x2: {scale: "x", field: "high"}, y: row,
        stroke: colour, strokeWidth: {value: 3}, strokeDash: {field: "dash"},
        opacity: {signal: "isNumber(datum.low) ? 0.75 : 0"}, tooltip}),
      mark("symbol", "rows", {x: {scale: "x", field: "middle"}, y: row, size: {value: 70},
        shape: {signal: "datum.shape || 'circle'"}, fill: colour, stroke: {value: "var(--paper)"},
        opacity: isThere, tooltip}, {clip: false, aria: true, description: chart.title}),
      mark("text", "rows", {x: {scale: "x", value: 0, offset: 6}, y: row, baseline: {value: "middle"}, font: {value: font},
        text: {field: "absent"}, fill: {value: "var(--dim)"}, fontSize: {value: 11},
        opacity: {signal: "isNumber(datum.middle) ? 0 : 1"}}),
    ],
  };
}
