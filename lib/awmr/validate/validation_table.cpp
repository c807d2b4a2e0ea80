#include <fmt/format.h>

#include <algorithm>

#include "awmr/core/text.h"
#include "awmr/validate/validate.h"

namespace awmr {
namespace {

std::string verdict_of(const Claim& claim) {
  return claim.reproduced ? "reproduced" : "not reproduced";
}

std::string holds_in(const std::vector<ClaimCase>& cases) {
  const auto reproduced = std::count_if(cases.begin(), cases.end(),
                                        [](const ClaimCase& open) { return open.reproduced; });
  return fmt::format("{} of {}", reproduced, cases.size());
}

/// Text such as "holds in 4 of 24 (differential 24 of 24, ...); decided by allocation (4 of 12)".
/// Empty if the claim was not evaluated for the settings that the paper leaves open.
std::string over_open_cases(const Claim& claim) {
  if (claim.cases.empty()) return {};
  std::string modes;
  for (const ClaimInMode& one : claim.modes) {
    modes +=
        fmt::format("{}{} {}", modes.empty() ? "" : ", ", name_of(one.mode), holds_in(one.cases));
  }
  return fmt::format("holds in {}{}{}", holds_in(claim.cases),
                     modes.empty() ? "" : " (" + modes + ")",
                     claim.decided_by.empty() ? "" : "; decided by " + claim.decided_by);
}

/// Escapes '|', which would end a cell of a Markdown table.
std::string cell(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) {
    text.insert(at, 1, '\\');
  }
  return text;
}

/// Introduction of the Markdown table, with the command that made it as "{}".
constexpr std::string_view kMarkdownIntroduction =
    R"md(# The paper's claims, simulated

Made by `{}` with the model identified from
the paper's tables and the paper's gains. The scenarios of the runs are in
`configs/paper/scenarios`. The paper gives no numbers for words such as "fast" or "slightly", so the
criteria are this project's. The verdict is for the vehicle's own settings.

Forces and moments are divided by F_max, the largest force of one motor: the wheel force F', the
thrust tau_speed, the yaw moment tau_turn, the resistances g1 (surge) and g3 (yaw). The normalised
mass is m' = m/F_max. The steering angle is d_r.

The paper does not give four settings. The last column counts their combinations in which the claim
holds:

- `allocation` (from thrust and yaw moment to wheel forces and steering angle): exact, or
  approximated for small steering angles
- `wheel_force` (range of F'): [-1, 1], [0, 1] or [0, 0.5]
- `mass_factor` (factor on m' and the normalised yaw inertia I'z): 1, or so large that tyres with a
  friction of 0.8 can transmit the thrust tau_speed = 2
- `split` (combined mode, if the steering or the wheel forces reach a limit): the other one makes
  the rest of the yaw moment, or each makes at most half of it

"Decided by allocation (4 of 12)": there are 12 combinations of the other settings. In 4 of them,
the allocation alone changes the verdict.

| claim | verdict | found by simulation | criterion | reason | combinations of the settings above |
|---|---|---|---|---|---|
)md";

/// Number, verdict and statement of a claim, wrapped.
std::string claim_headline(const Claim& claim) {
  const std::string heading = fmt::format("{:<4} {:<15} ", claim.id, verdict_of(claim));
  return heading + paragraph(claim.statement, heading.size()).substr(heading.size());
}

std::string number_or_dash(const std::optional<double>& value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

std::string parameter_text(const char* name, double value, const std::optional<Estimate>& shown) {
  if (!shown)
    return fmt::format("  {:<28} {:>9.4g}  default (not determined by the logs)\n", name, value);
  return fmt::format("  {:<28} {:>9.4g}  {:.4g} to {:.4g}\n", name, value, shown->ci95->lo,
                     shown->ci95->hi);
}

std::string tyres_text(const TyreFit& fit) {
  std::string text = "tyres of the four-wheel plant, fitted to the logs\n";
  text += parameter_text("friction", fit.tyres.friction, fit.friction);
  text += parameter_text("cornering stiffness, 1/rad", fit.tyres.cornering_per_rad,
                         fit.cornering_per_rad);
  text += fmt::format("  {:<28} {:>9} {:>11}\n", "held-out RMS error", "model", "four-wheel");
  for (const HeldOutError& error : fit.held_out) {
    text += fmt::format("  {:<28} {:>9.4g} {:>11.4g}\n", error.channel, error.model_rms,
                        error.four_wheel_rms);
  }
  return text + fmt::format("  better on held-out windows: {}\n",
                            fit.better ? name_in(kPlantKindNames, *fit.better) : kUndecidedPlant);
}

}  // namespace

std::string claims_table(const std::vector<Claim>& claims) {
  std::string text;
  for (const Claim& claim : claims) {
    text += claim_headline(claim);
    text += paragraph("found: " + claim.figure, 5);
    text += paragraph("criterion: " + claim.tolerance, 5);
    text += paragraph("reason: " + claim.why, 5);
    if (const std::string open = over_open_cases(claim); !open.empty()) {
      text +=
          paragraph("all combinations of the settings that the paper does not give: " + open, 5);
    }
  }
  const auto reproduced = std::count_if(claims.begin(), claims.end(),
                                        [](const Claim& claim) { return claim.reproduced; });
  return text + fmt::format("{} of {} claims reproduced\n", reproduced, claims.size());
}

std::string claims_markdown(const std::vector<Claim>& claims, std::string_view made_by) {
  std::string text = fmt::format(kMarkdownIntroduction, made_by);
  for (const Claim& claim : claims) {
    text += fmt::format("| {}: {} | {} | {} | {} | {} | {} |\n", claim.id, cell(claim.statement),
                        verdict_of(claim), cell(claim.figure), cell(claim.tolerance),
                        cell(claim.why), over_open_cases(claim));
  }
  return text;
}

std::string logs_table(const Validation& validation) {
  std::string text;
  for (const LogValidation& log : validation.logs) {
    text += fmt::format("{}\n  {:<16} {:>9} {:>13} {:>13} {:>13}\n", log.file, "channel", "samples",
                        "one-step R2", "long R2", "long NRMSE");
    for (const ChannelValidation& c : log.channels) {
      text += fmt::format("  {:<16} {:>9} {:>13.4f} {:>13.4f} {:>13.4f}\n", c.channel, c.samples,
                          c.one_step.r2, c.long_horizon.r2, c.long_horizon.nrmse);
    }
  }
  if (validation.tyres) text += tyres_text(*validation.tyres);
  return text;
}

std::string validation_table(const Validation& validation) {
  std::string text = fmt::format("{:<10} {:>5} {:>10} {:>10} {:<6} {:>9}\n", "trial", "line",
                                 "measured", "predicted", "unit", "error");
  for (const TrialResidual& trial : validation.trials) {
    const std::optional<double> percent =
        trial.relative_error ? std::optional(100.0 * *trial.relative_error) : std::nullopt;
    text += fmt::format("{:<10} {:>5} {:>10.4g} {:>10} {:<6} {:>9}\n",
                        name_in(kTrialKindNames, trial.kind), trial.line, trial.measured,
                        number_or_dash(trial.predicted, "{:.4g}"), trial.unit,
                        number_or_dash(percent, "{:+.1f} %"));
  }
  text += logs_table(validation);
  text += paragraph(validation.verdict, 0);
  text += "\nclaims of the paper, simulated with this model\n";
  for (const Claim& claim : validation.claims) {
    text += claim_headline(claim);
    text += paragraph(claim.figure, 20);
  }
  return text;
}

}  // namespace awmr
