// The vehicle from above, to scale: wheel forces, steering angle delta and heading psi.

function vehicleSketch(parent, vehicle) {
  const steers = vehicle.drive !== "differential";
  const wheels = vehicle.drive === "front_wheel" ? "two driven wheels" : "four driven wheels";
  const words = `The vehicle from above: ${wheels} with forces F′L and F′R, heading psi` +
    (steers ? ", front wheels steered by delta" : ", without steering");
  const svg = drawIn(parent, "svg", {class: "sketch", viewBox: "0 0 400 250", role: "img",
    "aria-label": words});
  const arrow = drawIn(drawIn(svg, "defs", {}), "marker",
    {id: "tip", viewBox: "0 0 8 8", refX: 6, refY: 4,
    markerWidth: 4.5, markerHeight: 4.5, orient: "auto"});
  drawIn(arrow, "path", {d: "M0 0L8 4L0 8z", fill: "var(--ink)"});

  const {length_m: length, width_m: width, front_axle_m: axle, half_track_m: track} = vehicle;
  const scale = 215 / Math.max(length, 1.5 * width, 3 * track, 2.4 * axle);
  const psi = 24 * Math.PI / 180, delta = steers ? 18 * Math.PI / 180 : 0;
  const turned = (x, y, angle) => [x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) +
    y * Math.cos(angle)];
  /// From the body's axes, pixels forward and to the left, to the drawing.
  const place = (x, y) => turned(x, y, psi).map((v, i) => (i ? 136 - v : 160 + v));
  const path = (points, attributes, end = "") => drawIn(svg, "path", {d: `M${points.map((p) =>
    place(...p).map((v) => v.toFixed(1)).join(" ")).join("L")}${end}`, ...attributes});
  const box = (x, y, a, b, angle, classes) => path([[a, b], [-a, b], [-a, -b], [a, -b]].map((p) => {
    const [dx, dy] = turned(...p, angle);
    return [x + dx, y + dy];
  }), {class: classes}, "Z");
  const label = (point, text, meaning) => {
    const [x, y] = place(...point);
    const node = drawIn(svg, "text", {x: x.toFixed(1), y: (y + 5).toFixed(1),
      "text-anchor": "middle"}, text);
    drawIn(node, "title", {}, meaning);
  };
  const arc = (x, y, radius, from, to) => path(Array.from({length: 13}, (_, i) => {
    const [dx, dy] = turned(radius, 0, from + (to - from) * i / 12);
    return [x + dx, y + dy];
  }), {class: "rule", "stroke-dasharray": "none"});

  const a = scale * length / 2, b = scale * width / 2, l = scale * axle, d = scale * track;
  const size = Math.min(26, 0.42 * l + 6);
  const reach = Math.max(a, l + 1.9 * size) + 72;
  path([[-a - 12, 0], [reach, 0]], {class: "rule"});
  path([[0, 0], turned(reach, 0, -psi)], {class: "rule"});
  arc(0, 0, reach - 18, -psi, 0);
  label(turned(reach - 4, 0, -psi / 2), "ψ", "heading, counter-clockwise from the x axis");
  box(0, 0, a, b, 0, "body");
  for (const x of [l, -l]) path([[x, -d], [x, d]], {class: "axle"});
  for (const [x, y] of [[l, d], [l, -d], [-l, d], [-l, -d]]) {
    const isFront = x > 0, angle = isFront ? delta : 0;
    box(x, y, size, 7, angle, "wheel");
    if (!isFront && vehicle.drive === "front_wheel") continue;
    const force = (y > 0 ? 1.3 : 1.9) * size + 8;
    const at = (distance) => turned(distance, 0, angle).map((v, i) => v + (i ? y : x));
    path([at(0), at(force)], {class: "force", "marker-end": "url(#tip)"});
    if (isFront) label(at(force + 16), y > 0 ? "F′L" : "F′R", "force of a wheel over F_max");
  }
  if (steers) {
    const beyond = 1.3 * size + 56;
    path([[l, d], [l + beyond, d]], {class: "rule"});
    arc(l, d, beyond - 10, 0, delta);
    label([l + beyond, d + 13], "δ", "steering angle");
  }
  const [x, y] = place(0, 0);
  drawIn(svg, "circle", {cx: x, cy: y, r: 4, fill: "var(--ink)"});
  path([[0, 0], [l, 0]], {class: "size"});
  label([l / 2, 12], "l", "centre of gravity to front axle");
  path([[-l, 0], [-l, -d]], {class: "size"});
  label([-l + 12, -d / 2], "d", "half track");
  const sizes = `${digits(vehicle.mass_kg)} kg, ${digits(length)} m × ${digits(width)} m, l ` +
    `${digits(axle)} m, d ${digits(track)} m`;
  small(parent, sizes);
}
