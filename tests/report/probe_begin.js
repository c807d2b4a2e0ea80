// Runs before the report's own scripts: counts the messages of the console.
const probe = {errors: [], booms: 0};
/// Called by hostile names if they are executed.
function boom() {
  ++probe.booms;
}
addEventListener("error", (event) => probe.errors.push(event.message));
addEventListener("unhandledrejection", (event) => probe.errors.push(String(event.reason)));
for (const level of ["error", "warn"]) console[level] = (...words) => probe.errors.push(words.join(" "));
