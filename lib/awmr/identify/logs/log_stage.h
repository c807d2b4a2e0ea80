/// Fit of driving logs into a model: the parameters that they fill, and the comparison with those
/// of other trials. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "awmr/identify/options.h"
#include "awmr/model/model.h"

namespace awmr {

struct LogStage {
  /// A parameter that the logs fill.
  struct Main {
    ParameterId id;
    Estimate estimate;
    Eigen::Index place;  ///< in `block`
    double jacobian;     ///< d value / d coordinate
  };
  std::vector<Main> main;
  Family surge_family = Family::kPower;  ///< of the fit
  Family yaw_family = Family::kPower;
  Eigen::MatrixXd block;                       ///< covariance of the fit's coordinates
  std::map<ParameterId, std::string> reasons;  ///< free in the fit, but not identifiable
  /// k_e was free in the fit and is not identifiable: no value would go with the others.
  bool is_back_emf_open = false;
  std::vector<EstimatorReport> reports;  ///< of every family that was tried
  std::size_t chosen_report = 0;         ///< in `reports`: of the fit that fills `main`
  std::vector<Finding> findings;
  bool withdraws_intervals = false;  ///< the values are shown without standard errors and intervals
};

/// Whether the commanded forces of the two sides differ anywhere.
bool pushes_apart(const DrivingLog& log);

/// Fits the logs from the model's values so far. All of `asked` are free; others are held at their
/// value, or free as well where they have none. `overrule`: the logs also fill what other trials
/// did.
/// Findings: `estimates-disagree` (logs against tables, p < 0.01), `coloured-residuals`,
/// `model-inadequate`, `power-law-inadequate`, `family-undecided`, `back-emf`, `sensor-delay`, `logs-disagree`, `not-identifiable`, `not-converged`, `held-out-misses`, `inertia-mismatch`, `held-out-log`
/// (each log predicted by the others), `families-not-compared` (the time limit ended).
/// Errors (input): a given time constant is too fast for a log.
Result<LogStage> run_log_stage(const Vehicle& vehicle, const std::vector<DrivingLog>& logs,
                               const IdentifyOptions& options,
                               const std::vector<ParameterId>& asked, const Model& model,
                               bool overrule);

}  // namespace awmr
