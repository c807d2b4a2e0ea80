// Section of the firmware (result of awmr pil), and section of the provenance: inputs, options and
// versions of all results.

function firmwareSection(data) {
  const {pil} = data;
  if (!pil) return;
  const box = section("Firmware",
    `“${scenarioWords(pil.scenario)}”, ${pil.mode}, ${plural(pil.samples, "step")} on the ` +
    `emulated ATmega2560.`);
  const line = add(box, "p");
  mark(line, pil.verdict === "passed" ? "good" : "bad");
  line.append(` ${pil.verdict}: the heading differs by at most ` +
    `${digits(pil.difference_double.heading_deg, 2)} deg from the computer's run.`);
  const rows = [["cycles per step: minimum, mean, maximum",
    `${pil.cycles.min}, ${digits(pil.cycles.mean)}, ${pil.cycles.max}`],
    ["cycles per step with hostile inputs, maximum", digits(pil.cycles_bound, 6)],
      ["share of the sample time", percent(pil.period_share)],
    ["flash, bytes", digits(pil.flash_bytes, 6)], ["RAM, bytes", digits(pil.ram_bytes, 6)],
      ["stack, bytes", digits(pil.stack_bytes, 6)]];
  table(box, ["quantity", "#value"], rows.filter((r) => r[1] !== "–"));
  const compared = folded(box, "Largest differences from the computer's runs");
  table(compared, ["signal", "#in float", "#in double"],
    Object.keys(pil.difference).map((k) => [k, digits(pil.difference[k], 3),
      digits((pil.difference_double || {})[k], 3)]));
}

function provenanceSection(data) {
  const box = section("Provenance", "The same files, options and seeds give the same results, byte for byte.");
  box.parentNode.open = false;
  for (const name of ["model", "gains", "validation", "comparison", "pil"]) {
    const document = data[name];
    if (!document || !document.inputs) continue;
    add(box, "h3", `${name}.json: awmr ${document.command}, version ${document.version}`);
    const options = Object.entries(document.options || {}).map(([key, value]) =>
      `${key} ${value}`).join(", ");
    if (options) small(box, options);
    table(box, ["made from", "SHA-256"], document.inputs.map((input) =>
      [input.name, input.sha256]));
  }
}
