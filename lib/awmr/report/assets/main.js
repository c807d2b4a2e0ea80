// The report, from top to bottom. A part with invalid data shows an error; the others are not
// affected.
const report = JSON.parse(document.getElementById("data").textContent);
document.getElementById("report").textContent = "";
document.title = `${report.model.vehicle.name}: awmr report`;
for (const [title, part] of [["Summary", summarySection], ["Try other gains", liveSection],
  ["Identification", identificationSection], ["Tuning", tuningSection],
  ["Simulations", simulationSection], ["The three yaw-control modes", comparisonSection], ["The paper's claims", claimsSection],
  ["Firmware", firmwareSection], ["Provenance", provenanceSection]]) {
  try {
    part(report);
  } catch (error) {
    section(title, `This part cannot be shown, because a file in this directory is not as awmr writes it (${error.message}).`);
  }
}
