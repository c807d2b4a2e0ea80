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

/// Origin of a number.
enum class Source {
  kGiven,    ///< given by the user in vehicle.json
  kDerived,  ///< computed from other numbers of the model, such as I'z from m' and Iz
  kFitted,   ///< estimated from trials
};
inline constexpr NameTable<Source, 3> kSourceNames{
    {{"given", Source::kGiven}, {"derived", Source::kDerived}, {"fitted", Source::kFitted}}};

/// One of the quantiles by which model.json can describe the uncertainty of an estimate.
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
/// The values of the quantiles in the order of kQuantiles, ascending.
using Quantiles = std::array<double, kQuantileCount>;

/// One identified number with its uncertainty and its origin.
struct Estimate {
  /// In the parameter's unit. Absent if the data do not determine it.
  std::optional<double> value;
  /// Standard error, in the parameter's unit, >= 0; 0: the value is known exactly. Absent for a
  /// given value, or if there are too few data.
  std::optional<double> std_error;
  std::optional<Interval> ci95;  ///< 95 % confidence interval; absent if `std_error` is absent
  Source source = Source::kGiven;
  std::string method;  ///< "log-linear", "box formula", "vehicle.json", ...
  /// Quantiles of the estimate: the ends of the 95 % interval, the quartiles and the median.
  /// Present only if the error is not normally distributed about `value`. Monte-Carlo simulations
  /// then draw the plants' values from the quantiles (simulate/plant_sampler.h).
  std::optional<Quantiles> quantiles = {};
};

/// The covariance of the fitted parameters' values, in the units of parameter_table().
struct Covariance {
  std::vector<ParameterId> parameters;      ///< the parameters of the rows and columns, in order
  std::vector<std::vector<double>> matrix;  ///< square, symmetric, over `parameters`
};

/// Tyre scrub: the yaw moment that resists differential (skid) turns in addition to the resistance
/// g3 of steered turns. The model treats it as Coulomb friction, the same at every yaw rate. In a
/// steady differential turn,
///   2 d (F'R - F'L) = g3(r) + moment_m            (moments divided by F_max; d: half track)
struct YawScrub {
  double moment_m = 0.0;     ///< mean moment, m; a negative value is due to noise
  double std_error_m = 0.0;  ///< m, > 0: from the scatter of the turns and the uncertainty of g3
  Interval ci95_m;           ///< 95 % confidence interval
  int rows = 0;              ///< turns from which it was estimated, >= 3
  Interval yaw_rate_radps;   ///< range of the yaw rates of these turns, > 0
  /// Range of the moment over the yaw rates of these turns, widened by its uncertainty. Absent if
  /// no change of the moment with the yaw rate was detected.
  std::optional<Interval> changing_m = {};
};

/// False if the vehicle does not have this parameter: the time constant of the servo without
/// steering.
bool has(const Vehicle& vehicle, ParameterId id);
/// Description, for messages, of the trial that identifies a parameter of this vehicle.
std::string_view trial_of(const Vehicle& vehicle, ParameterId id);

/// Types of motion, by the parameters in their equations. Dead zone and back-EMF are in all
/// equations.
enum class Motion {
  kSteadySurge,  ///< straight ahead at constant speed: g1
  kSteadyTurn,   ///< turn at constant yaw rate: g3
  kStraight,     ///< straight ahead, wheels straight, v = r = 0: g1 and m'
  kPlanar,       ///< any motion: all parameters
};
/// True if the motion's equations contain the parameter.
bool takes(Motion motion, ParameterId id);

/// The identified vehicle: the data given before the trials (`vehicle`), the resistance families,
/// and every identified quantity with its uncertainty.
struct Model {
  /// A model without any identified quantity: optional terms (ParameterInfo::term) are 0, all other
  /// parameters have no value.
  Model();

  std::string file = "model.json";  ///< name in errors: the path that it was read from
  Vehicle vehicle;
  Family surge_family = Family::kPower;
  Family yaw_family = Family::kPower;
  std::array<Estimate, kParameterCount> estimates;  ///< by ParameterId
  Covariance covariance;
  /// Smallest plausible m', s^2/m, > 0: g1(u)/(mu g). With a smaller m', the resistance g1(u) would
  /// brake the vehicle harder than its tyres permit. u: highest initial speed of the coast-downs;
  /// mu: friction kTyreFriction; g: acceleration of gravity. Absent if the identified m' is
  /// plausible.
  std::optional<double> mass_norm_by_grip;
  std::optional<YawScrub> yaw_scrub;  ///< absent: no turning trial determines it
  /// Largest yaw moment divided by F_max, m, > 0, that the difference of left and right wheel
  /// forces made while the vehicle did not turn. Absent: the vehicle turned in every trial.
  std::optional<double> yaw_held_m;
  /// True: the yaw resistance g3 was fitted only to differential turns, although the vehicle also
  /// steers. g3 then includes the moment of tyre scrub.
  bool yaw_by_sides_alone = false;
  IdentificationRecord record;

  Estimate& operator[](ParameterId id) { return estimates[static_cast<std::size_t>(id)]; }
  const Estimate& operator[](ParameterId id) const {
    return estimates[static_cast<std::size_t>(id)];
  }

  /// The plant from estimates and vehicle, for simulation and control in this motion. Errors
  /// (input): a parameter in the equations of the motion has no value. The message names it, with
  /// the trial that identifies it.
  Result<Plant<double>> plant(Motion motion = Motion::kPlanar) const;

  /// The plant for simulating only the motions that the trials in `record` measured, such as
  /// straight driving. Only the parameters of these motions need a value. Errors: as plant().
  Result<Plant<double>> plant_of_trials() const;

  /// The plant without checks, for motions that do not depend on the parameters without a value.
  /// Such a parameter is replaced: a resistance by 0; an inertia, an exponent or a time constant by
  /// 1.
  Plant<double> plant_as_known() const;

  /// The most general motion for which the model can be simulated: kPlanar, or kStraight if a
  /// parameter that kPlanar needs has no value.
  Motion simulated_motion() const;
};

/// True for an optional term (ParameterInfo::term) that this model lacks: it was not fitted, and
/// its given value is 0 or missing. model.json does not contain it.
bool is_absent_term(const Model& model, ParameterId id);

/// The largest force of one motor, N:
///   F_max = m/m'                                                                      [paper (66)]
double max_wheel_force_n(double mass_kg, double mass_norm);

}  // namespace awmr
