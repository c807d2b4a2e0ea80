/// model.json (`awmr.model/1`): the identified vehicle, every number with its uncertainty and
/// origin.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/core/name_table.h"
#include "awmr/core/result.h"
#include "awmr/model/dynamics.h"
#include "awmr/model/family.h"
#include "awmr/model/parameters.h"
#include "awmr/model/record.h"
#include "awmr/model/vehicle.h"

namespace awmr {

/// Where a number comes from.
enum class Source {
  kGiven,    ///< by the user, in vehicle.json
  kDerived,  ///< computed from other numbers of the model, such as I'z from m' and Iz
  kFitted,   ///< estimated from trials
};
inline constexpr NameTable<Source, 3> kSourceNames{
    {{"given", Source::kGiven}, {"derived", Source::kDerived}, {"fitted", Source::kFitted}}};

/// A quantile that model.json may have of an estimate.
struct QuantileInfo {
  std::string_view key;       ///< in model.json
  double probability = 0.5;   ///< in (0, 1)
  double normal_score = 0.0;  ///< the z with P(Z <= z) = probability, Z standard normal
};
inline constexpr std::size_t kQuantileCount = 5;
inline constexpr std::array<QuantileInfo, kQuantileCount> kQuantiles{{
    {"0.025", 0.025, -1.959963984540054},
    {"0.25", 0.25, -0.6744897501960817},
    {"0.5", 0.5, 0.0},
    {"0.75", 0.75, 0.6744897501960817},
    {"0.975", 0.975, 1.959963984540054},
}};
/// By kQuantiles, not falling.
using Quantiles = std::array<double, kQuantileCount>;

/// One identified number with its uncertainty and its origin.
struct Estimate {
  std::optional<double> value;      ///< in the parameter's unit; absent: the data cannot show it
  std::optional<double> std_error;  ///< in the same unit, > 0; absent: given, or too few data
  std::optional<Interval> ci95;     ///< 95 % confidence interval; absent as `std_error`
  Source source = Source::kGiven;
  std::string method;  ///< "log-linear", "box formula", "vehicle.json", ...
  /// Of what the trials leave open, where that is not a normal about `value`: the interval's ends, the
  /// quartiles and the median. Plants are drawn from them (simulate/plant_sampler.h).
  std::optional<Quantiles> quantiles = {};
};

/// The covariance of the fitted parameters.
struct Covariance {
  std::vector<ParameterId> parameters;      ///< which row and column is whose
  std::vector<std::vector<double>> matrix;  ///< square, symmetric, over `parameters`
};

/// What turns by the sides' forces meet beside the resistance of steered turns: the tyres' scrub. Over
/// F_max, as a Coulomb friction:
///   2 d (F'R - F'L) = g3(r) + moment
struct YawScrub {
  double moment_m = 0.0;     ///< m; below 0 by chance alone
  double std_error_m = 0.0;  ///< m, > 0: of the turns' scatter and of g3
  Interval ci95_m;           ///< 95 % confidence interval
  int rows = 0;              ///< turns that show it, >= 3
  Interval yaw_rate_radps;   ///< of those turns, > 0
  /// All that it is, with its uncertainty, between the slowest and the fastest of those turns, where it
  /// changes with the yaw rate; absent where no change shows.
  std::optional<Interval> changing_m = {};
};

/// False for what the vehicle does not have: the servo of one without steering.
bool has(const Vehicle& vehicle, ParameterId id);
/// The trial that shows a parameter of this vehicle, in words for a refusal.
std::string_view trial_of(const Vehicle& vehicle, ParameterId id);

/// Motions by what the equations of each take of a model.
enum class Motion {
  kSteadySurge,  ///< straight ahead at constant speed: g1
  kSteadyTurn,   ///< a constant yaw rate: g3
  kStraight,     ///< straight ahead, wheels straight, v = r = 0: g1 and m'
  kPlanar,       ///< any: every parameter
};
/// True where the motion's equations have the parameter in them.
bool takes(Motion motion, ParameterId id);
/// The motion that a trial of the kind is a measurement of.
Motion motion_of(TrialKind kind);

/// The vehicle as identified: what is known beforehand, the resistance families, every quantity
/// with its uncertainty.
struct Model {
  /// A model of which nothing is known yet. Only the terms that a power law does not have are set,
  /// to 0.
  Model();

  std::string file = "model.json";  ///< what errors call it: the path that it was read from
  Vehicle vehicle;
  Family surge_family = Family::kPower;
  Family yaw_family = Family::kPower;
  std::array<Estimate, kParameterCount> estimates;  ///< by ParameterId
  Covariance covariance;
  /// The least m', s^2/m, > 0, with which no coast-down decelerates by more than tyres of friction
  /// kTyreFriction hold: g1(u)/(mu g). Absent where the identified m' is plausible.
  std::optional<double> mass_norm_by_grip;
  std::optional<YawScrub> yaw_scrub;  ///< absent: no turning trial shows it
  /// The largest yaw moment by the sides' forces, m, > 0, under which the vehicle did not turn; absent:
  /// it always did.
  std::optional<double> yaw_held_m;
  /// g3 was fitted to turns by the sides' forces of a vehicle that also steers: it holds their scrub.
  bool yaw_by_sides_alone = false;
  IdentificationRecord record;

  Estimate& operator[](ParameterId id) { return estimates[static_cast<std::size_t>(id)]; }
  const Estimate& operator[](ParameterId id) const {
    return estimates[static_cast<std::size_t>(id)];
  }

  /// The plant that the estimates and the vehicle make, for simulation and control, in this motion.
  /// Errors (input): a parameter that the motion takes has no value; each is named with the trial
  /// that would show it.
  Result<Plant<double>> plant(Motion motion = Motion::kPlanar) const;

  /// The same for all that the trials in the record are measurements of.
  Result<Plant<double>> plant_of_trials() const;

  /// The same, unchecked. A parameter without a value stands for none of it: no resistance, an
  /// inertia and a time constant of 1. In a motion that does not take it, it multiplies zeros.
  Plant<double> plant_as_known() const;

  /// The richest motion that the model could be simulated in: kStraight where something of turning
  /// is not known.
  Motion simulated_motion() const;
};

/// True for a term that the model's family does not have: it is nowhere in model.json.
bool is_absent_term(const Model& model, ParameterId id);

/// The largest force of one motor, N:
///   F_max = m/m'                                                                      [paper (66)]
double max_wheel_force_n(double mass_kg, double mass_norm);

}  // namespace awmr
