/// model.json (`awmr.model/1`): the identified vehicle, every number with its uncertainty and
/// origin.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/model/dynamics.h"
#include "awmr/model/family.h"
#include "awmr/model/parameters.h"
#include "awmr/model/vehicle.h"

namespace awmr {

enum class Source { kGiven, kDerived, kFitted };

/// One number, as honest as it can be: no value where the data cannot show it.
struct Estimate {
  std::optional<double> value;
  std::optional<double> std_error;
  std::optional<Interval> ci95;
  Source source = Source::kGiven;
  std::string method;  ///< "log-linear", "box formula", "vehicle.json", ...
};

enum class Severity { kNote, kWarning, kError };

/// Something the user should know about the data or the result.
struct Finding {
  std::string file;  ///< empty where it is about no file
  int line = 0;      ///< 0 where it is about no line
  Severity severity = Severity::kWarning;
  std::string code;  ///< "speed-mismatch", "not-identifiable", ...: stable, for scripts
  std::string message;
};

/// A parameter as one estimator saw it.
struct EstimatorParameter {
  std::string name;  ///< "surge.alpha"
  double value = 0.0;
  std::optional<double> std_error;
  std::optional<Interval> ci95;  ///< of the curvature at the optimum
  /// From the profile of the cost: bounds where the data leave an end open.
  std::optional<Interval> profile95 = {};
};

/// A test of what a fit assumes of its residuals.
struct Diagnostic {
  std::string name;  ///< "normality", "whiteness of yaw_rate_radps", "lack of fit"
  double statistic = 0.0;
  double p_value = 1.0;
  std::string meaning;  ///< one sentence
};

/// What the estimates become without one row or log.
struct LeaveOneOut {
  std::string file;
  int line = 0;                ///< 0: the whole file
  std::vector<double> values;  ///< as EstimatorReport::parameters
};

/// One of the starts of a search.
struct SearchStart {
  std::vector<double> values;  ///< as EstimatorReport::parameters
  double cost = 0.0;           ///< after the search, half the sum of squared standardised residuals
  bool chosen = false;
  std::string stop_reason;
};

/// What one estimator made of one set of trials: an entry of /estimates.
struct EstimatorReport {
  std::string subject;  ///< "surge", "yaw", "mass", "log"
  std::string
      estimator;      ///< "log-linear", "nonlinear", "trajectory", "stop-time", "curve", "joint"
  std::string noise;  ///< where the error is put: "log force", "force", "speed", "time", ...
  std::vector<EstimatorParameter> parameters;
  double residual_std = 0.0;  ///< in the unit of the noise
  int rows_used = 0;
  int degrees_of_freedom = 0;
  int rank = 0;
  double condition_number = 0.0;
  std::string stop_reason;
  std::string family = {};          ///< of resistance; empty: the paper's power law
  std::optional<double> aicc = {};  ///< corrected Akaike criterion; less is better, same noise only
  std::vector<Diagnostic> diagnostics = {};
  std::vector<LeaveOneOut> leave_one_out = {};
  std::vector<SearchStart> starts = {};
};

struct Covariance {
  std::vector<ParameterId> parameters;
  std::vector<std::vector<double>> matrix;  ///< square, symmetric, over `parameters`
};

/// One row of a trial as it was used, kept in the model so that later steps need no CSV.
struct TrialPoint {
  std::string kind;  ///< "surge", "turning", "coastdown"
  std::string file;
  int line = 0;
  double input =
      0.0;  ///< surge: tau_speed; turning: tau_turn in m; coastdown: initial speed in m/s
  double measured =
      0.0;  ///< surge: speed in m/s; turning: yaw rate in rad/s; coastdown: stop time in s
  std::optional<double> predicted;  ///< the main model's, same unit as `measured`
};

/// How a model was identified: what every estimator made of the data, what is doubtful, and where
/// it all comes from.
struct IdentificationRecord {
  std::vector<EstimatorReport> reports;
  std::vector<Finding> findings;
  std::vector<TrialPoint> trials;
  Provenance provenance;
};

/// The vehicle as identified: what is known beforehand, the resistance families, every quantity
/// with its uncertainty.
struct Model {
  /// Nothing known but that a power law has no other terms.
  Model();

  std::string file = "model.json";  ///< the name that errors about it carry; the path it was read from
  Vehicle vehicle;
  Family surge_family = Family::kPower;
  Family yaw_family = Family::kPower;
  std::array<Estimate, kParameterCount> estimates;  ///< by ParameterId
  Covariance covariance;
  IdentificationRecord record;

  Estimate& operator[](ParameterId id) { return estimates[static_cast<std::size_t>(id)]; }
  const Estimate& operator[](ParameterId id) const {
    return estimates[static_cast<std::size_t>(id)];
  }

  /// Everything the simulator needs. Errors (input): a parameter has no value; it is named with the
  /// trial that would show it.
  Result<Plant<double>> plant() const;
};

/// F_max = m/m', N.                                                                     [paper
/// (66)]
double max_wheel_force_n(double mass_kg, double mass_norm);

Result<Model> read_model(const std::filesystem::path& path);
/// The bytes of model.json.
std::string model_text(const Model& model);

}  // namespace awmr
