"use strict";
// Elements common to all sections. Text from the data is inserted only as text nodes and
// attributes, never as HTML.

function add(parent, tag, text, attributes) {
  const node = document.createElement(tag);
  if (text !== undefined) node.textContent = text;
  for (const [name, value] of Object.entries(attributes || {})) node.setAttribute(name, value);
  parent.appendChild(node);
  return node;
}

const isNumber = (x) => typeof x === "number" && Number.isFinite(x);
/// Four significant digits, with trailing zeros where they show precision; a dash for missing
/// values.
function digits(x, n = 4) {
  if (!isNumber(x)) return "–";
  return x !== 0 && (Math.abs(x) < 1e-4 || Math.abs(x) >= 1e7) ? x.toExponential(n - 1) : Number(x.toPrecision(n)).toString();
}
const interval = (pair) => (pair ? `${digits(pair[0])} to ${digits(pair[1])}` : "–");
const percent = (x) => (isNumber(x) ? `${digits(100 * x, 3)} %` : "–");
const plural = (n, word) => `${n} ${word}${n === 1 ? "" : "s"}`;

/// Adds a collapsible section of the report; on a narrow screen it is closed at first. Returns the
/// container of its content.
function section(title, lead) {
  const details = add(add(document.getElementById("report"), "section"), "details");
  details.open = innerWidth > 640;
  add(details, "summary", title);
  if (lead) add(details, "p", lead, {class: "lead"});
  return add(details, "div");
}

/// A part that is closed at first.
function folded(parent, title) {
  const details = add(parent, "details");
  add(details, "summary", title);
  return add(details, "div");
}

/// `head`: a name for each column, with a leading "#" for columns of numbers. `rows`: arrays of
/// text. `best(row, column)`: whether to emphasise a cell.
function table(parent, head, rows, best) {
  const numeric = head.map((name) => name.startsWith("#"));
  const names = head.map((name) => name.replace(/^#/, ""));
  const node = add(add(parent, "div", undefined, {class: "scroll"}), "table", undefined, {class: "cards"});
  const header = add(add(node, "thead"), "tr");
  names.forEach((name, i) => add(header, "th", name, {scope: "col", class: numeric[i] ? "n" : ""}));
  const body = add(node, "tbody");
  rows.forEach((row, k) => {
    const line = add(body, "tr");
    row.forEach((cell, i) => {
      const marks = [numeric[i] ? "n" : "", best && best(k, i) ? "best" : "", String(cell).length > 60 ? "wide" : ""];
      const td = add(line, "td", undefined, {class: marks.join(" ").trim(), "data-column": names[i]});
      add(td, "span", cell);
      if (cell === "–" || cell === "" || cell === undefined) td.setAttribute("data-empty", "");
    });
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

/// Yaw-control modes in order, each with its colour, width and dashes: thick lines below thin ones,
/// so that coinciding lines are all visible.
const modes = ["differential", "steering", "combined"];
const modeStyle = {
  differential: {colour: "var(--one)", width: 4.5, dash: [], opacity: 0.55},
  steering: {colour: "var(--two)", width: 2.2, dash: [8, 4]},
  combined: {colour: "var(--three)", width: 1.4, dash: []},
};
