// Builds the report from top to bottom. A section with invalid data shows an error in its place;
// the other sections are not affected.
const report = JSON.parse(document.getElementById("data").textContent);
document.getElementById("report").textContent = "";
document.title = `${report.model.vehicle.name}: awmr report`;
for (const [title, part] of [["Summary", summarySection], ["Findings", findingsSection],
  ["Try other gains", liveSection], ["Identification", identificationSection],
    ["Tuning", tuningSection],
  ["Simulations", simulationSection], ["Comparison of the yaw-control modes", comparisonSection],
  ["The paper's claims", claimsSection], ["Firmware", firmwareSection],
    ["Provenance", provenanceSection]]) {
  try {
    part(report);
  } catch (error) {
    section(title, `This part cannot be shown, because a file in this directory is not as awmr ` +
      `writes it (${error.message}).`);
  }
}

// Marks the entry of the table of contents whose section is at the top of the window.
const inView = new IntersectionObserver((entries) => {
  for (const {target, isIntersecting} of entries) target.isInView = isIntersecting;
  const sections = [...document.querySelectorAll("section")];
  const current = sections.find((one) => one.isInView);
  if (!current) return;
  for (const one of sections) one.link.removeAttribute("aria-current");
  current.link.setAttribute("aria-current", "true");
}, {rootMargin: "-20% 0px -70% 0px"});
for (const one of document.querySelectorAll("section")) inView.observe(one);
