"use strict";
// Elements common to all sections. Text from the data is inserted only as text nodes and
// attributes, never as HTML.

function add(parent, tag, content, attributes) {
  const node = document.createElement(tag);
  if (content !== undefined && content !== null) node.append(content);
  for (const [name, value] of Object.entries(attributes || {})) node.setAttribute(name, value);
  parent.appendChild(node);
  return node;
}

/// Adds a paragraph in small print.
const small = (parent, text) => add(parent, "p", text, {class: "small"});

/// Adds an SVG element.
function drawIn(parent, tag, attributes, text) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  if (text !== undefined) node.textContent = text;
  parent.appendChild(node);
  return node;
}

const isNumber = (x) => typeof x === "number" && Number.isFinite(x);
/// Text of a number with n significant digits, but at least with all digits before the decimal
/// point. A dash for a missing value.
function digits(x, n = 3) {
  if (!isNumber(x)) return "–";
  const size = Math.abs(x);
  if (size !== 0 && (size < 1e-4 || size >= 1e7)) return x.toExponential(n - 1);
  return size >= 10 ** (n - 1) ? String(Math.round(x)) : Number(x.toPrecision(n)).toString();
}
const interval = (pair) => (pair ? `${digits(pair[0])} to ${digits(pair[1])}` : "–");
const percent = (x) => (isNumber(x) ? `${digits(100 * x, 2)} %` : "–");
const plural = (n, word) => `${n} ${word}${n === 1 ? "" : "s"}`;
/// Number of decimals with which a standard error has two significant digits, at most 8.
const decimalsOf = (error) => Math.max(0, Math.min(8, 1 - Math.floor(Math.log10(error))));

/// Texts for metrics that a run lacks: it did not settle, or did not reach the end of its route.
const absentWords = {settling_time_s: "never settled", finish_time_s: "not finished"};
/// Text of a metric's value, with at most three decimals.
function metricValue(name, x) {
  if (!isNumber(x)) return absentWords[name] || "–";
  return x !== 0 && Math.abs(x) < 5e-4 ? "< 0.001"
    : Number(Number(digits(x)).toFixed(3)).toString();
}

/// "settling_time_s" as "settling time, s"
const metricWords = (name) => report.metric_words[name] || name.replaceAll("_", " ");

/// Readable name of a scenario. Names of tuning scenarios contain the headings, and "led" if the
/// rate of the heading command is limited: heading_30_-30_led.
function scenarioWords(name) {
  const own = (report.scenarios[name] || {}).name;
  const parts = /^heading((?:_-?\d+(?:\.\d+)?)+)(_[a-z_]+)?$/.exec(name);
  if (own || !parts) return own || name.replaceAll("_", " ");
  const headings = parts[1].slice(1).split("_").map((h) => h.replace("-", "−"));
  return `headings ${headings.join(" then ")} deg${parts[2] ? ", rate-limited" : ""}`;
}

/// Sections are open at first, except on narrow screens.
const isWide = innerWidth > 640;

/// Adds an entry to the table of contents. A click opens the section if it is closed.
function contentsEntry(root, title) {
  root.id = title.toLowerCase().replace(/[^a-z]+/g, "-");
  const link = add(add(document.getElementById("contents"), "li"), "a", title,
    {href: `#${root.id}`});
  link.onclick = () => {
    const details = root.querySelector("details");
    if (details && details.parentNode === root) details.open = true;
  };
  root.link = link;
  root.setAttribute("aria-label", title);
}

/// Adds a collapsible section of the report. Returns the container of its content.
function section(title, lead, short = title, open = isWide) {
  const root = add(document.getElementById("report"), "section");
  contentsEntry(root, short);
  const details = add(root, "details");
  details.open = open;
  add(add(details, "summary"), "h2", title);
  if (lead) add(details, "p", lead, {class: "lead"});
  return add(details, "div");
}

/// Adds a collapsible part that is closed at first.
function folded(parent, title, open = false) {
  const details = add(parent, "details");
  details.open = open;
  add(add(details, "summary"), "h3", title);
  return add(details, "div");
}

/// Adds a round mark with a text for screen readers. tone: "good", "doubt" or "bad".
function mark(parent, tone) {
  const [sign, words] = {good: ["✓", "good"], doubt: ["!", "attention"], bad: ["✗", "bad"]}[tone];
  return add(parent, "span", sign, {class: `mark ${tone}`, role: "img", "aria-label": words});
}

const lengthOf = (cell) => (cell instanceof Node ? cell.textContent : String(cell)).length;
const isEmptyCell = (cell) => cell === "–" || cell === "" || cell === undefined;

/// Adds a table. `head`: the names of the columns; a leading "#" marks a column of numbers. `rows`:
/// arrays of text or nodes. `best(row, column)`: true if the cell is emphasised. Empty columns are
/// left out.
function table(parent, head, rows, best) {
  const columns = head.map((name, i) =>
    ({i, name: name.replace(/^#/, ""), numeric: name.startsWith("#")}))
    .filter(({i}) => i === 0 || rows.some((row) => !isEmptyCell(row[i])));
  const box = add(parent, "div", undefined, {class: "scroll"});
  const node = add(box, "table", undefined, {class: "cards"});
  const header = add(add(node, "thead"), "tr");
  for (const {name, numeric} of columns) {
    write(add(header, "th", undefined, {scope: "col", class: numeric ? "n" : ""}), name);
  }
  const body = add(node, "tbody");
  rows.forEach((row, k) => {
    const line = add(body, "tr");
    for (const {i, name, numeric} of columns) {
      const classes = [numeric && "n", best && best(k, i) && "best", lengthOf(row[i]) > 60
        && "wide"];
      const td = add(line, "td", undefined, {class: classes.filter(Boolean).join(" "),
        "data-column": plainSymbols(name)});
      add(td, "span", row[i]);
      if (isEmptyCell(row[i])) td.setAttribute("data-empty", "");
    }
  });
  return node;
}

/// The distinct values of a list, in order.
const distinct = (list) => [...new Set(list)];

function groupBy(list, key) {
  const groups = new Map();
  for (const item of list) groups.set(key(item), [...(groups.get(key(item)) || []), item]);
  return groups;
}

/// Yaw-control modes in their order, each with its hue and line width. Thick lines are drawn first,
/// so that coinciding lines are all visible.
const modes = ["differential", "steering", "combined"];
const isSteered = (vehicle) => vehicle.drive !== "differential";
const modeStyle = {
  differential: {colour: "var(--differential)", width: 4.5, opacity: 0.55},
  steering: {colour: "var(--steering)", width: 2.2},
  combined: {colour: "var(--combined)", width: 1.4},
};
/// Colour of a mode. The label can also be "combined with NAME", if there are several sets of
/// gains.
const colourOf = (label) => (modeStyle[label.split(/[ ,]/)[0]] || {colour: "var(--dim)"}).colour;

/// Line and mark of each set of gains, which are the same for every mode.
const gainsOrder = ["robust", "nominal", "baseline", "paper"];
const gainsStyle = {
  robust: {dash: [], shape: "circle"}, tuned: {dash: [], shape: "circle"},
  nominal: {dash: [9, 3, 2, 3], shape: "diamond"}, baseline: {dash: [7, 4], shape: "square"},
  paper: {dash: [2, 3], shape: "triangle-up"}, lqi: {dash: [12, 4], shape: "cross"},
};

/// Adds a sample of the colour of a mode, then its name.
function modeCell(mode, more = "") {
  const node = document.createElement("span");
  const name = add(node, "span", undefined, {class: "state"});
  add(name, "span", undefined, {class: "swatch", style: `background: ${colourOf(mode)}`});
  name.append(mode);
  node.append(more);
  return node;
}
