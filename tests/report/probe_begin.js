// Before the report's own scripts: counts what a console would show.
const probe = {errors: [], booms: 0};
/// What hostile names would call.
function boom() {
  ++probe.booms;
}
addEventListener("error", (event) => probe.errors.push(event.message));
addEventListener("unhandledrejection", (event) => probe.errors.push(String(event.reason)));
for (const level of ["error", "warn"]) console[level] = (...words) => probe.errors.push(words.join(" "));
