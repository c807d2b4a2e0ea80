// Saves a chart as SVG or PNG with its legend, in the colours of the printed page.

/// Vega specification of a chart in its present state (zoom, hidden series), with a title and a
/// legend. Colours replace the style variables of the page.
function exported(chart) {
  const spec = chart.specification(chart);
  for (const signal of spec.signals) {
    if (chart.view && !signal.update) signal.value = chart.view.signal(signal.name);
    if (signal.name === "pointed") signal.value = null;
  }
  if (chart.series.length) {
    spec.width = chart.view ? chart.view.width() : 480;
    spec.height = chart.view ? chart.view.height() : chart.height;
    spec.autosize = {type: "pad"};
  } else {
    spec.width = chart.outer || 420;  // a chart of ranges: its width with the row labels
  }
  spec.padding = 10;
  spec.title = {text: chart.title, anchor: "start", color: "var(--ink)", font, fontSize: 13};
  const shown = chart.series.filter((s) => !s.hidden);
  if (shown.length > 1) Object.assign(spec, exportedLegend(spec, shown));
  const text = JSON.stringify(spec).replace(/var\((--[a-z]+)\)/g, (_, name) =>
    lightColour(chart, name));
  return JSON.parse(text);
}

/// Scales and the legend of the visible series.
function exportedLegend(spec, shown) {
  const domain = shown.map((s) => s.name);
  const scale = (name, range) => ({name, type: "ordinal", domain, range});
  const symbolOf = {band: "square", shade: "square", line: "stroke", points: "circle"};
  return {
    scales: [...spec.scales, scale("colour", shown.map((s) => s.colour)),
      scale("dash", shown.map((s) => s.dash || [])),
      scale("shape", shown.map((s) => s.shape || symbolOf[s.kind])),
      scale("fill", shown.map((s) => (s.kind === "line" ? "transparent" : s.fill || s.colour)))],
    legends: [{stroke: "colour", strokeDash: "dash", shape: "shape", fill: "fill", orient: "bottom",
      columns: {signal: "max(1, floor(width / 150))"}, direction: "horizontal",
        symbolStrokeWidth: 2}],
  };
}

/// Value of a colour variable in the light style, for paper: from the first rule of the style sheet
/// (the rule for dark screens comes later), or from an element that contains the chart.
function lightColour(chart, name) {
  const own = document.styleSheets[0].cssRules[0].style.getPropertyValue(name).trim();
  if (own) return own;
  const around = chart.figure.closest(`[style*="${name}"]`);
  const outer = around && around.style.getPropertyValue(name).replace(/var\((.*)\)/, "$1").trim();
  return outer ? lightColour(chart, outer) : "#888";
}

/// Image of a chart as a URL; kind: "svg" or "png".
function imageOf(chart, kind) {
  const view = new vega.View(vega.parse(exported(chart)), {renderer: "none", background: "#fff"});
  return view.runAsync().then(() => view.toImageURL(kind, kind === "png" ? 3 : 1));
}

async function save(chart, kind) {
  const link = document.createElement("a");
  link.href = await imageOf(chart, kind);
  link.download = `${chart.title.replace(/[^A-Za-z0-9]+/g, "_").toLowerCase()}.${kind}`;
  link.click();
}
