#include "awmr/identify/coastdown/derived.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "awmr/core/gravity.h"
#include "awmr/core/tyre_friction.h"
#include "awmr/model/steady.h"

namespace awmr {
namespace {

/// Relative standard error of m' above which `fragile-mass` is reported: m' and F_max = m/m' are
/// then uncertain by more than about 20 % (two standard errors).
constexpr double kFragileShare = 0.10;
/// Relative difference of Iz from the box formula above which `inertia-mismatch` is reported.
constexpr double kInertiaDisagreement = 0.10;

/// Logarithm of the stop time of a vehicle with the mass m' = 1; empty if it never stops.
std::optional<double> log_unit_stop_time(const Resistance<double>& law, double speed_mps) {
  const auto stop_s = stop_time_s(law, 1.0, speed_mps);
  if (!stop_s) return std::nullopt;
  return std::log(*stop_s);
}

/// Returns the derivative of ln m' with respect to one coordinate of the surge law (such as ln a1
/// or b1), computed by a central difference. The stop time is kept constant. 0 if the vehicle would
/// not stop.
double derivative(const SteadyFit& surge, TransformedParameter c, double speed_mps) {
  if (c == TransformedParameter::kDeadZone) return 0.0;  // the motors are off
  const double h = 1e-6 * std::max(1e-3, std::abs(surge[c]));
  SteadyFit above = surge;
  SteadyFit below = surge;
  above[c] += h;
  below[c] -= h;
  const auto high = log_unit_stop_time(above.law(), speed_mps);
  const auto low = log_unit_stop_time(below.law(), speed_mps);
  return high && low ? -(*high - *low) / (2.0 * h) : 0.0;
}

/// Returns the same derivative of ln m' as derivative(), but for a power law in closed form:
///   with respect to ln a1:   1
///   with respect to b1:      ln u_max - 1/(1 - b1),   u_max = speed_mps: initial speed
double by_coordinate(const SteadyFit& surge, TransformedParameter c, double speed_mps) {
  const Resistance<double> law = surge.law();
  if (law.coulomb > 0.0 || law.quadratic > 0.0) return derivative(surge, c, speed_mps);
  if (c == TransformedParameter::kLogAlpha) return 1.0;
  if (c == TransformedParameter::kBeta) return -1.0 / (1.0 - law.beta) + std::log(speed_mps);
  return 0.0;
}

}  // namespace

std::optional<MassFromStopTime> mass_from_stop_time(const SteadyFit& surge,
                                                    const std::vector<StopTimeRow>& runs) {
  const double n = static_cast<double>(runs.size());
  MassFromStopTime mass{0.0, Eigen::VectorXd::Zero(rows_of(surge.free)), 0.0};
  std::vector<double> values;
  for (const StopTimeRow& run : runs) {
    const auto log_unit = log_unit_stop_time(surge.law(), run.initial_speed_mps);
    if (!log_unit) return std::nullopt;
    values.push_back(std::log(run.stop_time_s) - *log_unit);
    mass.log_mass_norm += values.back() / n;
    for (std::size_t i = 0; i < surge.free.size(); ++i) {
      mass.by_surge(eigen_index(i)) +=
          by_coordinate(surge, surge.free[i], run.initial_speed_mps) / n;
    }
  }
  if (runs.size() == 1) {
    const double relative = runs.front().timing_std_s / runs.front().stop_time_s;
    mass.timing_variance = relative * relative;
    return mass;
  }
  double squares = 0.0;
  for (const double value : values) {
    squares += (value - mass.log_mass_norm) * (value - mass.log_mass_norm);
  }
  mass.timing_variance = squares / (n - 1.0) / n;
  return mass;
}

void check_mass(const Resistance<double>& surge, const TrialSet<StopTimeRow>& coastdown,
                double mass_kg, double mass_norm, std::optional<double> relative_std_error,
                std::vector<Finding>& findings) {
  for (const StopTimeRow& run : coastdown.rows) {
    // Initial deceleration |u_dot| = g1(u)/m'
    const double deceleration = surge.at(run.initial_speed_mps) / mass_norm;
    if (!is_implausible(surge, run.initial_speed_mps, mass_norm)) continue;
    findings.push_back(
        {coastdown.file, run.line, Severity::kWarning, "implausible-deceleration",
         fmt::format(
             "stopping from {:.3g} m/s in {:.3g} s means an initial deceleration of {:.1f} "
             "m/s^2 ({:.1f} g), more than a tyre can give. F_max (largest force of one motor) "
             "would be {:.0f} N. With a tyre friction of {:g}, mass_norm is at least {:.3g}. "
             "In a quarter of their random vehicles, compare and validate raise mass_norm to "
             "this value; tune does so only by mass_factors of tune.json. Check the stop time, "
             "or record the coast-down curve",
             run.initial_speed_mps, run.stop_time_s, deceleration, deceleration / kGravity_mps2,
             mass_kg / mass_norm, kTyreFriction, mass_norm_by_grip(surge, run.initial_speed_mps))});
  }
  if (coastdown.rows.size() == 1) {
    findings.push_back(
        {coastdown.file, coastdown.rows.front().line, Severity::kNote, "single-stop-time",
         fmt::format(
             "there is a single stop time. The standard error of mass_norm therefore assumes a "
             "timing error of {:.2g} s, estimated from the digits of this time; repeat the "
             "coast-down or record its curve",
             coastdown.rows.front().timing_std_s)});
  }
  if (relative_std_error && *relative_std_error > kFragileShare) {
    findings.push_back(
        {coastdown.file, 0, Severity::kWarning, "fragile-mass",
         fmt::format("the standard error of mass_norm is {:.0f} % of its value: a value from a "
                     "stop time depends on the resistance at very low speed (b1 = {:.3f}). "
                     "Record the whole coast-down curve, or more surge runs at low speed",
                     100.0 * *relative_std_error, surge.beta)});
  }
}

void check_mass(const Resistance<double>& surge, const std::vector<CoastCurve>& curves,
                double mass_norm, std::vector<Finding>& findings) {
  for (const CoastCurve& curve : curves) {
    const double deceleration = surge.at(curve.speed_mps.front()) / mass_norm;
    if (!is_implausible(surge, curve.speed_mps.front(), mass_norm)) continue;
    findings.push_back(
        {curve.file, curve.line, Severity::kWarning, "implausible-deceleration",
         fmt::format("this coast-down begins with a deceleration of {:.1f} m/s^2 ({:.1f} g), more "
                     "than a tyre gives; check the units of time and speed",
                     deceleration, deceleration / kGravity_mps2)});
  }
}

bool is_implausible(const Resistance<double>& surge, double speed_mps, double mass_norm) {
  return surge.at(speed_mps) / mass_norm > kGravity_mps2;
}

double mass_norm_by_grip(const Resistance<double>& surge, double speed_mps) {
  return surge.at(speed_mps) / (kTyreFriction * kGravity_mps2);
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
       fmt::format(
           "yaw_inertia_kgm2 is {:.4g} in the vehicle file, but a uniform box of the vehicle's "
           "size and mass has {:.4g} kg m^2; the value of the file is used. Check this value, "
           "the mass and the sizes in the vehicle file",
           given, expected)});
}

}  // namespace awmr
