#include "awmr/identify/logs/checks/change_in_log.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "awmr/core/option_text.h"
#include "awmr/core/statistics/distributions.h"

namespace awmr {
namespace {

using Kind = FreeQuantity::Kind;

/// Fits of the rows before and after a time.
struct PartFits {
  double t_s = 0.0;  ///< the time
  FamilyFit before;
  FamilyFit after;

  bool usable() const { return before.fit.usable && after.fit.usable; }
};

/// True for a term by which the fit of a whole log describes the forces on the vehicle. Stribeck
/// friction and slopes stay in the fits of the parts, because no change of a parameter resembles
/// them.
bool is_of_forces(const FreeTerm& term) {
  const FreeQuantity& q = term.quantity;
  return (q.kind == Kind::kExtraForce && !q.is_stribeck_or_slope()) ||
         q.kind == Kind::kForceExponent || q.kind == Kind::kForceSaturation ||
         q.kind == Kind::kSaturationSharpness || q.kind == Kind::kSupplySag;
}

LogFitOptions options_of_parts(const FamilyFit& chosen) {
  LogFitOptions options = from_optimum(chosen.options, chosen);
  std::erase_if(options.terms, is_of_forces);
  options.noise.clear();
  options.bootstrap = 0;
  return options;
}

/// Fits the rows before and after `t_s` with the families of `chosen`.
PartFits fit_parts(const std::vector<DrivingLog>& log, const LogFitOptions& options,
                   const FamilyFit& chosen, double t_s) {
  const std::vector<double>& times_s = log.front().t_s;
  LogFitOptions before = options;
  before.only_s = Interval{times_s.front(), t_s - kChangeWidth_s};
  LogFitOptions after = options;
  after.only_s = Interval{t_s + kChangeWidth_s, times_s.back() + 1.0};
  return {t_s, fit_with(log, std::move(before), chosen.surge, chosen.yaw),
          fit_with(log, std::move(after), chosen.surge, chosen.yaw)};
}

/// Size of the errors of both parts (size_of_errors()), divided by their number. Infinite if a part
/// could not be fitted.
double error_size(const PartFits& parts) {
  if (!parts.usable()) return std::numeric_limits<double>::infinity();
  const auto [size, count] = size_of_errors({&parts.before.fit, &parts.after.fit});
  return size / count;
}

/// Searches the time at which the errors of both parts are smallest: on a grid, then halfway to its
/// neighbours, until the steps are at most kChangeWidth_s. Returns the fits of both parts. Empty if
/// no parts could be fitted, or if the limit of the work is reached.
std::optional<PartFits> fit_at_likeliest_time(const std::vector<DrivingLog>& log,
                                              const LogFitOptions& options,
                                              const FamilyFit& chosen) {
  constexpr int kGrid = 6;
  const double begin_s = log.front().t_s.front();
  double step_s = (log.front().t_s.back() - begin_s) / kGrid;
  std::optional<PartFits> best;
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](double t_s) {
    PartFits parts = fit_parts(log, options, chosen, t_s);
    const double size = error_size(parts);
    if (size < least) {
      least = size;
      best = std::move(parts);
    }
  };
  for (int k = 1; k < kGrid; ++k) consider(begin_s + k * step_s);
  while (best && step_s > kChangeWidth_s) {
    if (is_over(options)) return std::nullopt;
    step_s /= 2.0;
    const double middle_s = best->t_s;
    consider(middle_s - step_s);
    consider(middle_s + step_s);
  }
  return best;
}

/// Fits a part again with Coulomb friction and a power law of both axes, unless it has no model
/// error. Reason: a change of the vehicle can also have misled the choice of the families. The fit
/// stops early if its errors are far above the sensor noise.
FamilyFit with_rich_families(const std::vector<DrivingLog>& log, LogFitOptions power_law,
                             FamilyFit part) {
  constexpr double kWrong = 10.0;  // LogFit::relative_error of a model that is certainly wrong
  if (!part.fit.usable || !part.fit.has_model_error()) return part;
  power_law.only_s = part.options.only_s;
  power_law.bootstrap = 0;
  power_law.give_up_above = kWrong;
  const Family yaw = power_law.frees(ParameterId::kYawAlpha) ? Family::kCoulombPower : part.yaw;
  return fit_from(log, power_law, part, Family::kCoulombPower, yaw);
}

/// The quantities that differ significantly between the parts, the most significant first.
std::vector<ChangedQuantity> changed_quantities(const PartFits& parts) {
  constexpr double kChanged = 0.001;
  const LogFit& a = parts.before.fit;
  const LogFit& b = parts.after.fit;
  const double level = kChanged / static_cast<double>(a.quantities.size());
  std::vector<std::pair<double, ChangedQuantity>> found;
  for (std::size_t i = 0; i < a.quantities.size(); ++i) {
    const FreeQuantity& q = a.quantities[i];
    if (q.kind != Kind::kParameter || !a.refusal_reason[i].empty()) continue;
    const auto j = place_of(b.quantities, q.id);
    if (!j || !b.refusal_reason[*j].empty()) continue;
    const double z =
        std::abs(a.coordinates[i] - b.coordinates[*j]) / std::hypot(a.error_of(i), b.error_of(*j));
    if (!(2.0 * normal_tail(z) < level)) continue;
    found.push_back({z, {q.name(), q.value(a.coordinates[i]), q.value(b.coordinates[*j])}});
  }
  std::ranges::stable_sort(found, std::greater{}, [](const auto& one) { return one.first; });
  std::vector<ChangedQuantity> quantities;
  for (auto& [z, quantity] : found) quantities.push_back(std::move(quantity));
  return quantities;
}

}  // namespace

std::optional<ChangeInLog> find_change(const std::vector<DrivingLog>& logs,
                                       const LogFitOptions& power_law, const FamilyFit& chosen) {
  constexpr double kLongEnough_s = 20.0;
  if (logs.size() != 1 || !chosen.fit.usable || is_over(chosen.options)) return std::nullopt;
  const std::vector<double>& t_s = logs.front().t_s;
  if (t_s.back() - t_s.front() < kLongEnough_s) return std::nullopt;
  const LogFitOptions options = options_of_parts(chosen);
  auto parts = fit_at_likeliest_time(logs, options, chosen);
  if (!parts) return std::nullopt;
  for (FamilyFit* part : {&parts->before, &parts->after}) {
    *part = with_rich_families(logs, power_law, std::move(*part));
    if (!part->fit.usable || part->fit.has_model_error()) return std::nullopt;
  }
  ChangeInLog change{parts->t_s, changed_quantities(*parts)};
  return change.quantities.empty() ? std::nullopt : std::optional(std::move(change));
}

Finding change_finding(const ChangeInLog& change, const std::string& file) {
  constexpr std::size_t kMostNamed = 3;
  std::vector<std::string> values;
  for (const ChangedQuantity& one : change.quantities) {
    if (values.size() == kMostNamed) break;
    values.push_back(
        fmt::format("{} {:.4g} before and {:.4g} after", one.name, one.before, one.after));
  }
  return {file, 0, Severity::kWarning, "changed-in-log",
          fmt::format("the vehicle or its surroundings changed at about {:.0f} s: separate fits of "
                      "the rows before and after describe the log, a single one does not ({}). "
                      "Load, ground, battery or temperature changed, so the intervals are "
                      "withdrawn; identify both parts separately ({}, {})",
                      change.t_s, fmt::join(values, ", "), option_text("until S"),
                      option_text("from S"))};
}

}  // namespace awmr
