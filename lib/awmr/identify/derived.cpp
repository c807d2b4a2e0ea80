#include "awmr/identify/derived.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace awmr {
namespace {

constexpr double kGravity = 9.80665;           ///< m/s^2
constexpr double kFragileShare = 0.10;         ///< relative standard error of m' worth a warning
constexpr double kInertiaDisagreement = 0.10;  ///< relative difference of Iz worth a note

}  // namespace

MassFromStopTime mass_from_stop_time(const PowerLawFit& surge,
                                     const std::vector<StopTimeRow>& runs) {
  const double n = static_cast<double>(runs.size());
  const double one_minus_beta = 1.0 - surge.beta;
  double mean = 0.0;
  double mean_log_speed = 0.0;
  std::vector<double> values;
  for (const StopTimeRow& run : runs) {
    const double log_speed = std::log(run.initial_speed_mps);
    values.push_back(std::log(one_minus_beta) + surge.log_alpha + std::log(run.stop_time_s) -
                     one_minus_beta * log_speed);
    mean += values.back() / n;
    mean_log_speed += log_speed / n;
  }
  MassFromStopTime mass{mean, -1.0 / one_minus_beta + mean_log_speed, 0.0};
  if (runs.size() > 1) {
    double squares = 0.0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    mass.timing_variance = squares / (n - 1.0) / n;
  }
  return mass;
}

void check_mass(const PowerLawFit& surge, const TrialSet<StopTimeRow>& coastdown, double mass_kg,
                double mass_norm, std::optional<double> relative_std_error,
                std::vector<Finding>& findings) {
  for (const StopTimeRow& run : coastdown.rows) {
    // |u_dot| at motors-off: g1(u)/m'
    const double deceleration =
        std::exp(surge.log_alpha) * std::pow(run.initial_speed_mps, surge.beta) / mass_norm;
    if (deceleration <= kGravity) continue;
    findings.push_back(
        {coastdown.file, run.line, Severity::kWarning, "implausible-deceleration",
         fmt::format(
             "stopping from {:.3g} m/s in {:.3g} s means a first deceleration of {:.1f} m/s^2 "
             "({:.1f} g), more than a tyre gives, and F_max = {:.0f} N a motor; check the stop "
             "time, or record the coast-down curve",
             run.initial_speed_mps, run.stop_time_s, deceleration, deceleration / kGravity,
             mass_kg / mass_norm)});
  }
  if (coastdown.rows.size() == 1) {
    findings.push_back(
        {coastdown.file, coastdown.rows.front().line, Severity::kNote, "single-stop-time",
         "one stop time shows no scatter: the standard error of mass_norm holds the surge "
         "fit's share only, not the timing's; repeat the coast-down"});
  }
  if (relative_std_error && *relative_std_error > kFragileShare) {
    findings.push_back(
        {coastdown.file, 0, Severity::kWarning, "fragile-mass",
         fmt::format("the standard error of mass_norm is {:.0f} % of its value, because "
                     "m' from a stop time hangs on 1 - b1 = {:.3f}; record the whole "
                     "coast-down curve, or more surge runs at low speed",
                     100.0 * *relative_std_error, 1.0 - surge.beta)});
  }
}

void check_inertia(const Vehicle& vehicle, std::vector<Finding>& findings) {
  if (!vehicle.yaw_inertia_kgm2) return;
  Vehicle box = vehicle;
  box.yaw_inertia_kgm2.reset();
  const double expected = box.inertia_kgm2();
  const double given = *vehicle.yaw_inertia_kgm2;
  if (std::abs(given - expected) <= kInertiaDisagreement * std::max(given, expected)) return;
  findings.push_back(
      {"", 0, Severity::kNote, "inertia-mismatch",
       fmt::format("yaw_inertia_kgm2 is given as {:.4g}, the box formula gives {:.4g} "
                   "kg m^2; the given value is used",
                   given, expected)});
}

}  // namespace awmr
