/// Functions that write the results of each kind of trial into the model, with their covariance.
/// Private to identify/.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "awmr/identify/coastdown/mass.h"
#include "awmr/identify/logs/log_stage.h"
#include "awmr/identify/tables/subject_fit.h"
#include "awmr/model/model.h"

namespace awmr {

/// Covariance of all identified parameters, assembled from independent fits. Each fit is a block of
/// estimated numbers with its own covariance, for example ln a1, b1 and ln m' from surge runs and
/// coast-downs. Every parameter is a function of these numbers. The covariance of the parameters is
/// C = G B G^T. B is block diagonal, with the covariance of each fit. Each row of G is the gradient
/// of one parameter with respect to all these numbers.
class JointCovariance {
 public:
  /// Derivatives of one parameter with respect to the estimated numbers. Key: index of a number,
  /// counted over all blocks. If a number is not listed, the derivative is 0.
  using Gradient = std::map<Eigen::Index, double>;

  /// Appends a block and returns the index of its first number.
  Eigen::Index add_block(const Eigen::MatrixXd& covariance);
  /// Sets the gradient of a parameter. Replaces an earlier gradient.
  void set(ParameterId id, Gradient gradient) { gradients_[id] = std::move(gradient); }
  bool has(ParameterId id) const { return gradients_.contains(id); }
  /// Variance of a parameter that has this gradient with respect to the estimated numbers.
  double variance(const Gradient& gradient) const;
  const Gradient& gradient(ParameterId id) const { return gradients_.at(id); }
  /// Covariance of all parameters for which set() was called, in the order of ParameterId. Exactly
  /// symmetric.
  Covariance covariance() const;

 private:
  double product(const Gradient& a, const Gradient& b) const;
  std::vector<std::pair<Eigen::Index, Eigen::MatrixXd>> blocks_;
  Eigen::Index size_ = 0;
  std::map<ParameterId, Gradient> gradients_;
};

/// A model under construction and the covariance of its fitted parameters. Each function below
/// overwrites parameters that earlier calls have set.
struct MainValues {
  Model& model;
  JointCovariance covariance = {};
};

/// Sets the values that vehicle.json gives: sway resistance, back-EMF and servo time constant.
void set_given(const Vehicle& vehicle, Model& model);

/// Sets the parameters and the family of a resistance law. Precondition: `fit.chosen` is set.
void set_law(const Subject& subject, const SubjectFit& fit, MainValues& values);

/// Sets the mass m' from coast-downs, and the yaw inertia I'z from m' (both divided by F_max). If
/// there is no surge law, it sets only the exponent b1, from a power-law fit of the coast-down
/// curves. If the chosen surge law does not describe the surge runs (`SubjectFit::is_inadequate`),
/// the values get no intervals. Precondition: set_law() was called with the surge fit, if there is
/// one.
void set_mass(const MassResult& mass, const SubjectFit& surge, MainValues& values);

/// Sets the values, the families and the covariance that the logs determine.
void set_logs(const LogStage& logs, MainValues& values);

}  // namespace awmr
