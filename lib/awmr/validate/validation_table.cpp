#include <fmt/format.h>

#include <algorithm>

#include "awmr/core/text.h"
#include "awmr/validate/text.h"
#include "awmr/validate/validate.h"

namespace awmr {
namespace {

constexpr std::size_t kWidth = 100;

std::string number_or_dash(const std::optional<double>& value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

}  // namespace

std::string wrapped(const std::string& text, std::size_t indent) {
  return std::string(indent, ' ') + wrapped(text, indent, kWidth) + '\n';
}

namespace {

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
  text += wrapped(validation.verdict, 0);
  text += "\nclaims of the paper, simulated with this model\n";
  for (const Claim& claim : validation.claims) {
    text += claim_headline(claim);
    text += wrapped(claim.figure, 20);
  }
  return text;
}

}  // namespace awmr
