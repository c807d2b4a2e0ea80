#include "awmr/model/plausibility.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include "awmr/core/interval.h"
#include "awmr/core/units.h"

namespace awmr {
namespace {

/// A probable unit error. The given value looks like another unit (`words`: "looks like mm"); the
/// intended value is the given value times `factor`.
struct Guess {
  double factor;
  std::string_view words;
};
constexpr std::array<Guess, 2> kLengths{{{1e-3, "looks like mm"}, {1e-2, "looks like cm"}}};
constexpr std::array<Guess, 3> kHalfTrack{
    {{0.5, "looks like the whole track"}, {1e-3, "looks like mm"}, {1e-2, "looks like cm"}}};
constexpr std::array<Guess, 3> kFrontAxle{
    {{0.5, "looks like the wheelbase"}, {1e-3, "looks like mm"}, {1e-2, "looks like cm"}}};
constexpr std::array<Guess, 5> kInertia{{{1e-4, "looks like kg cm^2"},
                                         {1e-3, "looks like g m^2"},
                                         {1e-6, "looks like kg mm^2"},
                                         {1e-7, "looks like g cm^2"},
                                         {1e-9, "looks like g mm^2"}}};

/// Returns the guess whose factor brings `ratio` into the plausible `range`; if there are several,
/// the guess whose result is nearest to the `usual` ratio. None if no factor does.
std::optional<Guess> likely(double ratio, std::span<const Guess> guesses, Interval range,
                            double usual) {
  std::optional<Guess> best;
  for (const Guess& guess : guesses) {
    const auto apart = [&](const Guess& g) { return std::abs(std::log(ratio * g.factor / usual)); };
    if (!range.contains(ratio * guess.factor)) continue;
    if (!best || apart(guess) < apart(*best)) best = guess;
  }
  return best;
}

/// End of a message with the probable unit and the converted value, such as "; the value looks like
/// mm: 0.32". If there is no guess, the text advises to measure again.
std::string remedy(double value, const std::optional<Guess>& guess) {
  if (!guess) return "; measure it again";
  return fmt::format("; the value {}: {:.4g}", guess->words, value * guess->factor);
}

/// Factors that convert sizes and mass from the units in which they were probably given.
struct Scale {
  double size;
  double mass;
};

/// The scale that brings the mass per footprint area nearest to 50 kg/m^2, a typical value for
/// robots (chosen). None if no scale brings it into 5 to 500 kg/m^2. Precondition: length and width
/// have the same unit.
std::optional<Scale> likely_scale(double mass_per_area) {
  static constexpr std::array<Scale, 5> kScales{
      {{1e-3, 1.0}, {1e-2, 1.0}, {1.0, 1e-3}, {1e-3, 1e-3}, {1e-2, 1e-3}}};
  constexpr Interval kUsual{5.0, 500.0};
  constexpr double kMiddle = 50.0;
  std::optional<Scale> best;
  double least = 0.0;
  for (const Scale& scale : kScales) {
    const double there = mass_per_area * scale.mass / (scale.size * scale.size);
    const double apart = std::abs(std::log(there / kMiddle));
    if (!kUsual.contains(there) || (best && apart >= least)) continue;
    best = scale;
    least = apart;
  }
  return best;
}

/// Checks the ratio of length to width. If it is implausible, converts the larger of length and
/// width from mm or cm to m.
void check_shape(Vehicle& vehicle, std::vector<Implausible>& found) {
  constexpr Interval kShape{0.2, 10.0};
  const double ratio = vehicle.length_m / vehicle.width_m;
  if (kShape.contains(ratio)) return;
  const bool is_long = ratio > 1.0;
  double& larger = is_long ? vehicle.length_m : vehicle.width_m;
  const auto guess = likely(is_long ? ratio : 1.0 / ratio, kLengths, {0.3, 6.0}, 1.5);
  found.push_back({is_long ? "/length_m" : "/width_m",
                   fmt::format("length_m {:g} and width_m {:g} have the ratio {:.3g}, where 0.2 to "
                               "10 is plausible{}",
                               vehicle.length_m, vehicle.width_m, ratio, remedy(larger, guess))});
  if (guess) larger *= guess->factor;
}

/// Checks the mass per footprint area. If it is implausible, tries to convert the mass from g to
/// kg, or length and width from mm or cm to m, or both. Converts only if the result is plausible.
void check_mass(Vehicle& vehicle, std::vector<Implausible>& found) {
  constexpr Interval kMassPerArea{1.0, 5000.0};
  const double per_area = vehicle.mass_kg / (vehicle.length_m * vehicle.width_m);
  if (kMassPerArea.contains(per_area)) return;
  const std::string compared =
      fmt::format("{:g} kg on {:g} m x {:g} m is {:.3g} kg/m^2, where robots have 5 to 500",
                  vehicle.mass_kg, vehicle.length_m, vehicle.width_m, per_area);
  const auto scale = likely_scale(per_area);
  if (!scale) {
    found.push_back({"/mass_kg", compared + "; measure mass and sizes again"});
    return;
  }
  if (scale->mass != 1.0) {
    found.push_back({"/mass_kg", fmt::format("{}; mass_kg looks like g: {:.4g}", compared,
                                             vehicle.mass_kg * scale->mass)});
    vehicle.mass_kg *= scale->mass;
  }
  if (scale->size == 1.0) return;
  const std::string_view unit = scale->size == 1e-3 ? "mm" : "cm";
  for (const auto& [pointer, size] :
       {std::pair{"/length_m", &vehicle.length_m}, std::pair{"/width_m", &vehicle.width_m}}) {
    found.push_back({pointer, fmt::format("{}; the size looks like {}: {:.4g}", compared, unit,
                                          *size * scale->size)});
    *size *= scale->size;
  }
}

void check_axles(const Vehicle& vehicle, std::vector<Implausible>& found) {
  const double track = 2.0 * vehicle.half_track_m / vehicle.width_m;
  if (!Interval{0.2, 1.2}.contains(track)) {
    found.push_back(
        {"/half_track_m",
         fmt::format("half_track_m {:g} makes a track of {:.3g} m on a vehicle of width {:.3g} m{}",
                     vehicle.half_track_m, 2.0 * vehicle.half_track_m, vehicle.width_m,
                     remedy(vehicle.half_track_m, likely(track, kHalfTrack, {0.3, 1.1}, 0.9)))});
  }
  if (!vehicle.has_steering()) return;
  const double front = 2.0 * vehicle.front_axle_m / vehicle.length_m;
  if (!Interval{0.02, 1.0}.contains(front)) {
    found.push_back(
        {"/front_axle_m",
         fmt::format(
             "front_axle_m {:g} is {:.3g} times half of the length {:.3g} m, but the front axle "
             "is between the centre of gravity and the front end{}",
             vehicle.front_axle_m, front, vehicle.length_m,
             remedy(vehicle.front_axle_m, likely(front, kFrontAxle, {0.1, 1.0}, 0.6)))});
  }
}

void check_inertia(const Vehicle& vehicle, std::vector<Implausible>& found) {
  if (!vehicle.yaw_inertia_kgm2) return;
  Vehicle box = vehicle;
  box.yaw_inertia_kgm2.reset();
  const double ratio = *vehicle.yaw_inertia_kgm2 / box.inertia_kgm2();
  if (kInertiaOverBox.contains(ratio)) return;
  const auto guess = likely(ratio, kInertia, {0.3, 3.0}, 1.0);
  found.push_back(
      {"/yaw_inertia_kgm2",
       fmt::format(
           "yaw_inertia_kgm2 is {:.3g} times the inertia of a box of this mass and size, {:.4g} "
           "kg m^2 (with all mass in the corners, it would be 3 times){}",
           ratio, box.inertia_kgm2(),
           guess ? remedy(*vehicle.yaw_inertia_kgm2, guess)
                 : "; measure it again, or omit the key to use the inertia of the box")});
}

void check_steering(const Vehicle& vehicle, std::vector<Implausible>& found) {
  if (!vehicle.has_steering()) return;
  if (vehicle.steering_max_deg < 2.0) {
    found.push_back({"/steering/max_deg",
                     fmt::format("a steering stop of {:g} deg is implausible; the value looks like "
                                 "radians: {:.4g}",
                                 vehicle.steering_max_deg, degrees(vehicle.steering_max_deg))});
  }
  if (vehicle.steering_max_rate_degps < 8.0) {
    found.push_back(
        {"/steering/max_rate_degps",
         fmt::format("a steering rate of {:g} deg/s is implausible; the value looks like rad/s: "
                     "{:.4g}",
                     vehicle.steering_max_rate_degps, degrees(vehicle.steering_max_rate_degps))});
  }
  if (vehicle.steering_time_constant_s > kSlowestServo_s) {
    found.push_back(
        {"/steering/time_constant_s",
         fmt::format("a servo time constant of {:g} s is implausible; the value looks like ms: "
                     "{:.4g}",
                     vehicle.steering_time_constant_s, 1e-3 * vehicle.steering_time_constant_s)});
  }
}

}  // namespace

double inertia_over_vehicle(const Vehicle& vehicle, double inertia_norm, double mass_norm) {
  return inertia_norm / mass_norm / (vehicle.inertia_kgm2() / vehicle.mass_kg);
}

Interval inertia_over_vehicle(const Vehicle& vehicle, const Estimate& inertia,
                              const Estimate& mass) {
  if (inertia.ci95 && mass.ci95) {
    const double largest = mass.ci95->lo > 0.0
                               ? inertia_over_vehicle(vehicle, inertia.ci95->hi, mass.ci95->lo)
                               : std::numeric_limits<double>::max();
    return {inertia_over_vehicle(vehicle, inertia.ci95->lo, mass.ci95->hi), largest};
  }
  const double ratio = inertia_over_vehicle(vehicle, *inertia.value, *mass.value);
  return {0.5 * ratio, 2.0 * ratio};
}

std::vector<Implausible> implausible_values(const Vehicle& vehicle) {
  std::vector<Implausible> found;
  Vehicle corrected = vehicle;
  check_shape(corrected, found);
  check_mass(corrected, found);
  check_axles(corrected, found);
  check_inertia(corrected, found);
  check_steering(corrected, found);
  return found;
}

Status check_plausible(const Vehicle& vehicle, const std::string& place,
                       const std::string& remedy) {
  std::vector<Fault> faults;
  for (const Implausible& one : implausible_values(vehicle)) {
    faults.push_back({ErrorCode::kImplausible, place + one.pointer, one.message + ". " + remedy});
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return {};
}

std::vector<Finding> plausibility_findings(const Vehicle& vehicle, Severity severity,
                                           const std::string& file) {
  std::vector<Finding> findings;
  for (const Implausible& one : implausible_values(vehicle)) {
    const std::string place = file.empty() ? file : file + ":" + one.pointer;
    findings.push_back({place, 0, severity, "implausible-vehicle", one.message});
  }
  return findings;
}

}  // namespace awmr
