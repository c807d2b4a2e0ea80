// Symbols of the control laws: their letters, and the meaning that the page shows on hover and
// focus.
const symbols = new Map(Object.entries({
  lambda: ["λ", "lambda, 1/s: slope of the sliding surface, on which the heading error decays with the time " +
    "constant T1 = 1/λ"],
  mu: ["μ", "mu, rad/s²: largest corrective yaw acceleration, with which the heading law drives " +
    "towards the sliding surface"],
  epsilon: ["ε", "epsilon, rad/s: half width of the boundary layer, in which the heading law is " +
    "linear and does not chatter"],
  mu_s: ["μₛ", "mu_s, m/s²: largest corrective acceleration of the speed law"],
  epsilon_s: ["εₛ", "epsilon_s, m/s: half width of the speed law's boundary layer"],
  T1: ["T1", "T1 = 1/λ: time constant of the heading error on the sliding surface"],
  T2: ["T2", "T2 = ε/(2 μ): time constant with which the sliding surface is reached; below T1"],
  delta: ["δ", "delta: steering angle of the front wheels, left positive"],
  psi: ["ψ", "psi: heading, counter-clockwise from the x axis"],
  zeta: ["ζ", "zeta: damping ratio"],
  tau_speed: ["τ_speed", "tau_speed: thrust of all wheels over F_max"],
  tau_turn: ["τ_turn", "tau_turn, m: yaw moment over F_max"],
  "F'": ["F′", "F': force of one wheel over F_max, the largest force of a motor"],
  "m'": ["m′", "m', s²/m: mass over F_max"],
  "I'z": ["I′z", "I'z, s² m: yaw inertia over F_max"],
}));
symbols.set("eps", symbols.get("epsilon"));

const symbolParts = (text) => text.replaceAll("<=", "≤").replaceAll(">=", "≥").replaceAll("^2", "²")
  .split(/([A-Za-z][A-Za-z0-9_']*)/);
const plainSymbols = (text) => symbolParts(text).map((part) =>
  (symbols.get(part) || [part])[0]).join("");

/// Symbols that occurred on the page so far. Only the first occurrence can get the focus.
const metSymbols = new Set();

/// Appends text to a node; known symbols become letters with their meaning as a tooltip.
function write(node, text) {
  for (const part of symbolParts(text)) {
    const symbol = symbols.get(part);
    if (!symbol) {
      node.append(part);
      continue;
    }
    const mark = add(node, "abbr", symbol[0], {title: symbol[1]});
    if (!metSymbols.has(part)) mark.tabIndex = 0;
    metSymbols.add(part);
  }
}

/// Returns a span with the text, in which known symbols are replaced as by write().
function symbolic(text) {
  const node = document.createElement("span");
  write(node, text);
  return node;
}
