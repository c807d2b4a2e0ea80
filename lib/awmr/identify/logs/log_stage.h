/// Identification from driving logs: fit, choice of the model, checks. Called by identify().
/// Private to identify/.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "awmr/identify/options.h"
#include "awmr/model/model.h"

namespace awmr {

/// Result of run_log_stage().
struct LogStage {
  /// A parameter that gets its value in the model from the logs.
  struct Main {
    ParameterId id;
    Estimate estimate;
    Eigen::Index place;  ///< index of the parameter in `block`
    double jacobian;     ///< d value / d coordinate
  };
  std::vector<Main> main;
  Family surge_family = Family::kPower;  ///< families of the fit
  Family yaw_family = Family::kPower;
  Eigen::MatrixXd block;  ///< covariance of all coordinates of the fit
  /// Reason why the logs do not identify a parameter, for each such parameter that the user
  /// requested or that has no value from other trials.
  std::map<ParameterId, std::string> reasons;
  /// True if k_e (back-EMF) was free in the fit but is not identified. The model then has no value
  /// of k_e: 0 would be wrong, because the other parameters were fitted with a nonzero k_e.
  bool is_back_emf_open = false;
  std::vector<EstimatorReport> reports;  ///< one for each fit of a resistance family
  std::size_t chosen_report = 0;         ///< index in `reports` of the fit from which `main` comes
  std::vector<Finding> findings;
  bool withdraws_intervals = false;  ///< true: the values get no standard errors or intervals
};

/// Fits the logs, starting from the values in `model`. The parameters in `requested` and those
/// without a value are free, the others fixed. If `overrule` is true, values from the logs replace
/// those from other trials.
///
/// Adds the findings of all checks and of term_findings.h. Errors (input): those of check_replay(),
/// if a time constant is too small.
Result<LogStage> run_log_stage(const Vehicle& vehicle, const std::vector<DrivingLog>& logs,
                               const IdentifyOptions& options,
                               const std::vector<ParameterId>& requested, const Model& model,
                               bool overrule);

}  // namespace awmr
