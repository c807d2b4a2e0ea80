/// Identification of model parameters from driving logs, and their comparison with those of other
/// trials. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "awmr/identify/options.h"
#include "awmr/model/model.h"

namespace awmr {

struct LogStage {
  /// A parameter that the logs set.
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
  /// k_e was free in the fit and is not identifiable: a model without k_e would be inconsistent.
  bool is_back_emf_open = false;
  std::vector<EstimatorReport> reports;  ///< of all fitted families
  std::size_t chosen_report = 0;         ///< in `reports`: index of the fit that sets `main`
  std::vector<Finding> findings;
  bool withdraws_intervals = false;  ///< the values have no standard errors and intervals
};

/// Fits the logs, starting from the model's values. All of `requested` are free; the others are
/// fixed at their value, or free without one. `overrule`: the logs also replace values of other
/// trials. Findings: `estimates-disagree` (logs against tables, p < 0.01), `coloured-residuals`,
/// `model-inadequate`, `power-law-inadequate`, `family-undecided`, `back-emf`, `sensor-delay`,
/// `logs-disagree`, `not-identifiable`, `not-converged`, `held-out-misses`, `inertia-mismatch`,
/// `held-out-log` (each log predicted by the others), `families-not-compared` (the time limit
/// ended). Errors (input): a given time constant is too small for a log.
Result<LogStage> run_log_stage(const Vehicle& vehicle, const std::vector<DrivingLog>& logs,
                               const IdentifyOptions& options,
                               const std::vector<ParameterId>& requested, const Model& model,
                               bool overrule);

}  // namespace awmr
