/// Trials -> Model: fits, derived quantities, uncertainty, identifiability.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/model.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// Which estimator fills the main values.
enum class Method { kLogLinear, kNonlinear };
/// Where the nonlinear fit puts the error.
enum class Noise { kForce, kSpeed, kTime };

struct IdentifyOptions {
  Method method = Method::kLogLinear;  ///< the paper's, the default for tables
  std::optional<Noise> noise;          ///< default: time where it is given, else speed
  std::vector<ParameterId> asked;      ///< empty: those the given trials exist for
};

struct TrialData {
  std::optional<TrialSet<SurgeRow>> surge;
  std::optional<TrialSet<TurningRow>> turning;
  std::optional<TrialSet<StopTimeRow>> coastdown;
};

struct Identification {
  Model model;
  std::vector<ParameterId> refused;  ///< asked for, but not identifiable: exit code 1
};

/// Errors (input): values that no option can save, such as an empty set of trials. A parameter the
/// data cannot identify is not an error: it has no value, a `not-identifiable` finding, and is in
/// `refused`.
Result<Identification> identify(const Vehicle& vehicle, const TrialData& data,
                                const IdentifyOptions& options, std::vector<Finding> findings);

}  // namespace awmr
