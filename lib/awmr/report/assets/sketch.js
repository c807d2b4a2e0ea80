// Sketch of the vehicle from above, to scale: wheel forces, steering angle delta and heading psi.

const sketchHeading = 24 * Math.PI / 180, sketchSteering = 18 * Math.PI / 180;  // psi, delta

const turned = ([x, y], angle) =>
  [x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) + y * Math.cos(angle)];
const sum = ([x, y], [dx, dy]) => [x + dx, y + dy];

/// Returns functions that draw in coordinates of the vehicle: pixels forward and to the left of the
/// centre of gravity.
function sketchPen(svg) {
  const place = (point) => {
    const [x, y] = turned(point, sketchHeading);
    return [160 + x, 136 - y];
  };
  const path = (points, attributes, end = "") => {
    const corners = points.map((point) => place(point).map((v) => v.toFixed(1)).join(" "));
    drawIn(svg, "path", {d: `M${corners.join("L")}${end}`, ...attributes});
  };
  const box = (centre, [a, b], angle, classes) =>
    path([[a, b], [-a, b], [-a, -b], [a, -b]].map((corner) => sum(centre, turned(corner, angle))),
      {class: classes}, "Z");
  const arc = (centre, radius, from, to) =>
    path(Array.from({length: 13}, (_, i) =>
      sum(centre, turned([radius, 0], from + (to - from) * i / 12))), {class: "rule"});
  const label = (point, text, meaning) => {
    const [x, y] = place(point);
    const node = drawIn(svg, "text",
      {x: x.toFixed(1), y: (y + 5).toFixed(1), "text-anchor": "middle"}, text);
    drawIn(node, "title", {}, meaning);
  };
  return {place, path, box, arc, label};
}

/// Draws a wheel and its force. The wheels on the right have larger forces, because the sketch
/// shows a left turn.
function sketchWheel({path, box, label}, wheel, {size, angle, isDriven, isNamed}) {
  box(wheel, [size, 7], angle, "wheel");
  if (!isDriven) return;
  const isLeft = wheel[1] > 0, force = (isLeft ? 1.3 : 1.9) * size + 8;
  const at = (distance) => sum(wheel, turned([distance, 0], angle));
  path([wheel, at(force)], {class: "force", "marker-end": "url(#tip)"});
  if (isNamed) label(at(force + 16), isLeft ? "F′L" : "F′R", "force of a wheel over F_max");
}

function sketchFrame(parent, vehicle) {
  const wheels = vehicle.drive === "front_wheel" ? "two driven wheels" : "four driven wheels";
  const steering = isSteered(vehicle) ? "front wheels steered by delta" : "without steering";
  const svg = drawIn(parent, "svg", {class: "sketch", viewBox: "0 0 400 250", role: "img",
    "aria-label": `The vehicle from above: ${wheels}, heading psi, ${steering}`});
  const tip = drawIn(drawIn(svg, "defs", {}), "marker", {id: "tip", viewBox: "0 0 8 8", refX: 6,
    refY: 4, markerWidth: 4.5, markerHeight: 4.5, orient: "auto"});
  drawIn(tip, "path", {d: "M0 0L8 4L0 8z", fill: "var(--ink)"});
  return svg;
}

function vehicleSketch(parent, vehicle) {
  const {length_m: length, width_m: width, front_axle_m: axle, half_track_m: track} = vehicle;
  const scale = 215 / Math.max(length, 1.5 * width, 3 * track, 2.4 * axle);
  const [a, b, l, d] = [length / 2, width / 2, axle, track].map((x) => scale * x);
  const size = Math.min(26, 0.42 * l + 6);
  const svg = sketchFrame(parent, vehicle);
  const pen = sketchPen(svg), {place, path, box, arc, label} = pen;

  const reach = Math.max(a, l + 1.9 * size) + 72;
  path([[-a - 12, 0], [reach, 0]], {class: "rule"});
  path([[0, 0], turned([reach, 0], -sketchHeading)], {class: "rule"});
  arc([0, 0], reach - 18, -sketchHeading, 0);
  label(turned([reach - 4, 0], -sketchHeading / 2), "ψ", "heading, counter-clockwise from the x axis");

  box([0, 0], [a, b], 0, "body");
  const delta = isSteered(vehicle) ? sketchSteering : 0;
  for (const x of [l, -l]) {
    path([[x, -d], [x, d]], {class: "axle"});
    for (const y of [d, -d]) {
      sketchWheel(pen, [x, y], {size, angle: x > 0 ? delta : 0, isNamed: x > 0,
        isDriven: x > 0 || vehicle.drive !== "front_wheel"});
    }
  }
  if (delta) {
    const beyond = 1.3 * size + 56;
    path([[l, d], [l + beyond, d]], {class: "rule"});
    arc([l, d], beyond - 10, 0, delta);
    label([l + beyond, d + 13], "δ", "steering angle");
  }

  const [x, y] = place([0, 0]);
  drawIn(svg, "circle", {cx: x, cy: y, r: 4, fill: "var(--ink)"});
  path([[0, 0], [l, 0]], {class: "size"});
  label([l / 2, 12], "l", "centre of gravity to front axle");
  path([[-l, 0], [-l, -d]], {class: "size"});
  label([-l + 12, -d / 2], "d", "half track");
  small(parent, `${digits(vehicle.mass_kg)} kg, ${digits(length)} m × ${digits(width)} m, ` +
    `l ${digits(axle)} m, d ${digits(track)} m`);
}
