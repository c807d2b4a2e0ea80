#include "awmr/identify/logs/findings/term_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "awmr/core/containers.h"
#include "awmr/core/units.h"
#include "awmr/identify/logs/log_report.h"

namespace awmr {
namespace {

struct FoundStribeck {
  std::string_view axis;  ///< "surge." or "yaw.", with which parameter names begin
  std::string_view what;
  std::string_view unit;
  Identified force;
  double coulomb;               ///< Coulomb friction c
  std::optional<double> speed;  ///< speed scale w_s; empty if not identified

  bool is_large() const { return force.value > 0.05 * coulomb; }
};

std::vector<FoundStribeck> found_stribeck(const LogFit& fit) {
  std::vector<FoundStribeck> found;
  const auto add = [&](ExtraForce force, ExtraForce speed, ParameterId coulomb,
                       std::string_view axis, std::string_view what, std::string_view unit) {
    const auto one = significant(fit, force);
    if (!one) return;
    const auto scale = identified(fit, speed);
    found.push_back({axis, what, unit, *one, fit.value_of(coulomb).value_or(0.0),
                     scale ? std::optional(scale->value) : std::nullopt});
  };
  add(ExtraForce::kSurgeStribeck, ExtraForce::kSurgeStribeckSpeed, ParameterId::kSurgeCoulomb,
      "surge.", "rolling", "m/s");
  add(ExtraForce::kYawStribeck, ExtraForce::kYawStribeckSpeed, ParameterId::kYawCoulomb, "yaw.",
      "turning", "rad/s");
  return found;
}

std::vector<Finding> stribeck_findings(const LogFit& fit, const std::string& file) {
  std::vector<Finding> findings;
  for (const FoundStribeck& one : found_stribeck(fit)) {
    findings.push_back(
        {file, 0, Severity::kWarning, "stribeck-friction",
         fmt::format("the friction of {} is larger at low speed (Stribeck effect): by {:.2g} +- "
                     "{:.2g} in addition to the Coulomb friction {:.2g}{}. The fit compensates "
                     "for this, but simulations and tuned gains ignore it, so avoid low speeds{}",
                     one.what, one.force.value, one.force.error, one.coulomb,
                     one.speed ? fmt::format(", mainly below {:.2g} {}", *one.speed, one.unit) : "",
                     one.is_large() ? fmt::format("; the intervals of {}* are withdrawn, because "
                                                  "the true form of the friction is "
                                                  "unknown",
                                                  one.axis)
                                    : "")});
  }
  return findings;
}

std::vector<Finding> slope_findings(const LogFit& fit, const std::string& file) {
  constexpr double kGravity_mps2 = 9.81;
  const auto x = identified(fit, ExtraForce::kSlopeX);
  const auto y = identified(fit, ExtraForce::kSlopeY);
  if (!x || !y) return {};
  const Identified slope = length_of(*x, *y);
  if (!is_significant(slope)) return {};
  return {{file, 0, Severity::kWarning, "slope",
           fmt::format("a constant force pushes the vehicle towards the heading {:.0f} deg with "
                       "{:.2g} +- {:.1g} m/s^2, like ground that falls by {:.2g} deg. The fit "
                       "compensates for this, but simulations ignore it; record logs on level "
                       "ground",
                       degrees(std::atan2(y->value, x->value)), slope.value, slope.error,
                       degrees(std::asin(std::min(1.0, slope.value / kGravity_mps2))))}};
}

std::vector<Finding> side_pull_findings(const LogFit& fit, const std::string& file) {
  const auto pull = significant(fit, ExtraForce::kSidePull);
  if (!pull) return {};
  return {
      {file, 0, Severity::kWarning, "side-pull",
       fmt::format("a yaw moment of {:.2g} +- {:.1g} m (divided by F_max) pulls the vehicle to "
                   "the {} when it drives forward: a dragging brake, unequal tyres, or a wheel "
                   "out of line. The fit compensates for this, but simulations and tuned gains "
                   "ignore it; correct the cause, or tune with an observer (awmr tune --observer)",
                   std::abs(pull->value), pull->error, pull->value > 0.0 ? "left" : "right")}};
}

std::vector<Finding> axle_offset_findings(const LogFit& fit, const std::string& file) {
  const auto offset = significant(fit, ExtraForce::kAxleOffset);
  if (!offset || std::abs(offset->value) < kMinReported) return {};
  return {{file, 0, Severity::kWarning, "axle-offset",
           fmt::format("the vehicle turns like one whose centre of gravity lies {:.3f} +- {:.3f} m "
                       "{} the axle whose wheels do not slide sideways, so driving {} resists "
                       "turning. The fit compensates for this, with I'z about that axle, but "
                       "simulations and tuned gains ignore it; move the load over the axle, or "
                       "tune with an observer (awmr tune --observer)",
                       std::abs(offset->value), offset->error,
                       offset->value > 0.0 ? "ahead of" : "behind",
                       offset->value > 0.0 ? "forward" : "backward")}};
}

std::vector<Finding> turn_drag_findings(const LogFit& fit, const std::string& file) {
  const auto drag = significant(fit, ExtraForce::kTurnDrag);
  if (!drag) return {};
  return {
      {file, 0, Severity::kWarning, "turn-drag",
       fmt::format(
           "the resistance to driving is larger in turns, by {:.2g} +- {:.2g} of F_max at 1 rad/s "
           "and 1 m/s: tyres or tracks are dragged sideways (scrub). The fit compensates for this, "
           "but simulations and tuned gains ignore it: expect lower speeds in turns than simulated",
           drag->value, drag->error)}};
}

std::vector<Finding> backward_drag_findings(const LogFit& fit, const std::string& file) {
  const auto excess = significant(fit, ExtraForce::kBackwardDrag);
  if (!excess || std::abs(excess->value) < kMinReported) return {};
  return {{file, 0, Severity::kWarning, "backward-drag",
           fmt::format("the resistance is {:.1f} +- {:.1f} % {} driving backward than forward. The "
                       "values of surge.* are those of forward motion, which simulations and gains "
                       "use in both directions, so drive forward only",
                       100.0 * std::abs(excess->value), 100.0 * excess->error,
                       excess->value > 0.0 ? "larger" : "smaller")}};
}

std::vector<Finding> force_excess_findings(const LogFit& fit, const std::string& file) {
  std::vector<Finding> findings;
  const auto add = [&](ExtraForce force, std::string_view code, std::string_view which,
                       std::string_view reference) {
    const auto excess = significant(fit, force);
    if (!excess || std::abs(excess->value) < kMinReported) return;
    findings.push_back(
        {file, 0, Severity::kWarning, std::string(code),
         fmt::format(
             "{} push {:.1f} +- {:.1f} % {} than {} (in logs that only drive forward, every "
             "negative force brakes). The fit compensates for this, but simulations and tuned "
             "gains ignore it; divide such commands by {:.3g} before they are sent to the "
             "motors, and log the commands before this division",
             which, 100.0 * std::abs(excess->value), 100.0 * excess->error,
             excess->value > 0.0 ? "more" : "less", reference, 1.0 + excess->value)});
  };
  add(ExtraForce::kBrakeForce, "brake-force", "forces against the motion", "forces along it");
  add(ExtraForce::kReverseForce, "reverse-force", "negative forces", "positive ones");
  return findings;
}

}  // namespace

bool is_significant(const Identified& quantity) {
  constexpr double kStandardErrors = 2.0;
  return std::abs(quantity.value) > kStandardErrors * quantity.error;
}

Identified length_of(const Identified& x, const Identified& y) {
  const double length = std::hypot(x.value, y.value);
  return {length, std::hypot(x.error * x.value, y.error * y.value) / length};
}

std::vector<Finding> force_findings(const LogFit& fit, const std::string& file) {
  std::vector<Finding> findings = stribeck_findings(fit, file);
  for (auto* const more : {&slope_findings, &side_pull_findings, &axle_offset_findings,
                           &turn_drag_findings, &backward_drag_findings, &force_excess_findings}) {
    append(findings, more(fit, file));
  }
  return findings;
}

void withdraw_by_stribeck(LogFit& fit) {
  for (const FoundStribeck& one : found_stribeck(fit)) {
    if (one.is_large()) withdraw_intervals(fit.report, one.axis);
  }
}

}  // namespace awmr
