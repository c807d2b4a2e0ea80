// The paper's claims, the firmware, and the inputs of all results.

function claimsSection(data) {
  const claims = ((data.validation || {}).claims || []).filter((c) => c.verdict);
  if (!data.paper_vehicle || !claims.length) return;
  const kept = claims.filter((c) => c.verdict === "reproduced").length;
  const box = section("The paper's claims", `${kept} of ${claims.length} reproduced with this model.`);
  table(box, ["claim", "what the paper says", "", "found", "what counts", "why"], claims.map((c) => [c.id, c.statement, c.verdict === "reproduced" ? "reproduced" : "not reproduced", c.figure, c.tolerance, c.why]));
}

function firmwareSection(data) {
  const {pil} = data;
  if (!pil) return;
  const box = section("Firmware", `“${pil.scenario}”, ${pil.mode}, ${plural(pil.samples, "step")} on the emulated ATmega2560.`);
  const rows = [["cycles per step, least, mean, most", `${pil.cycles.min}, ${digits(pil.cycles.mean)}, ${pil.cycles.max}`],
    ["cycles per step from hostile inputs, most", digits(pil.cycles_bound, 6)], ["share of the sample time", percent(pil.period_share)],
    ["flash, bytes", digits(pil.flash_bytes, 6)], ["RAM, bytes", digits(pil.ram_bytes, 6)], ["stack, bytes", digits(pil.stack_bytes, 6)]];
  table(box, ["what", "#figure"], rows.filter((r) => r[1] !== "–"));
  const compared = folded(box, "Largest differences from the computer's runs");
  table(compared, ["signal", "#in float", "#in double"], Object.keys(pil.difference).map((k) => [k, digits(pil.difference[k], 3), digits((pil.difference_double || {})[k], 3)]));
}

function provenanceSection(data) {
  const box = section("Provenance", "The same files, options and seeds make the same bytes again.");
  box.parentNode.open = false;
  for (const name of ["model", "gains", "validation", "comparison", "pil"]) {
    const document = data[name];
    if (!document || !document.inputs) continue;
    add(box, "h3", `${name}.json: awmr ${document.command}, version ${document.version}`);
    const options = Object.entries(document.options || {}).map(([key, value]) => `${key} ${value}`).join(", ");
    if (options) add(box, "p", options, {class: "small"});
    table(box, ["made from", "SHA-256"], document.inputs.map((input) => [input.name, input.sha256]));
  }
}
