#include "awmr/compare/draw.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>

#include "awmr/core/random.h"

namespace awmr {
namespace {

constexpr int kMostTries = 1000;

/// What a negative eigenvalue may be for rounding's sake, over the largest: the file's matrix has
/// 17 digits, a derived parameter (m' from a1, b1) makes it singular.
constexpr double kSingularTolerance = 1e-9;

bool is_exponent(ParameterId id) {
  return id == ParameterId::kSurgeBeta || id == ParameterId::kYawBeta;
}

bool in_range(const Vehicle& vehicle, ParameterId id, double value) {
  if (id == ParameterId::kSurgeBeta) return vehicle.surge_beta_range.contains(value);
  if (id == ParameterId::kYawBeta) return vehicle.yaw_beta_range.contains(value);
  return true;
}

/// d p/d z of the drawn coordinate z: p for z = ln p, 1 for z = p.
double scale_of(ParameterId id, double value) { return is_exponent(id) ? 1.0 : value; }

Status check_shape(const Covariance& covariance, const std::string& place) {
  const std::size_t n = covariance.parameters.size();
  if (n == 0) {
    return input_error(place,
                       "no fitted parameter has a covariance, which samples are drawn from; "
                       "identify the model from trials, or compare without samples");
  }
  bool square = covariance.matrix.size() == n;
  for (const auto& row : covariance.matrix) square = square && row.size() == n;
  if (!square) {
    return input_error(place + "/matrix",
                       fmt::format("has to be {0} by {0}, one row and column per parameter", n));
  }
  return {};
}

}  // namespace

Result<PlantSampler> PlantSampler::make(const Model& model) {
  if (const auto plant = model.plant(); !plant) return tl::unexpected(plant.error());
  const std::string place = model.file + ":/covariance";
  const Covariance& covariance = model.covariance;
  if (const Status shape = check_shape(covariance, place); !shape) {
    return tl::unexpected(shape.error());
  }

  PlantSampler sampler;
  sampler.model_ = model;
  const auto n = static_cast<Eigen::Index>(covariance.parameters.size());
  Eigen::MatrixXd drawn(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const ParameterId id_i = covariance.parameters[static_cast<std::size_t>(i)];
    const double value = *model[id_i].value;
    sampler.centre_.push_back(is_exponent(id_i) ? value : std::log(value));
    for (Eigen::Index j = 0; j < n; ++j) {
      const ParameterId id_j = covariance.parameters[static_cast<std::size_t>(j)];
      drawn(i, j) = covariance.matrix[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] /
                    (scale_of(id_i, value) * scale_of(id_j, *model[id_j].value));
    }
  }

  // C = V diag(w) V^T  =>  L = V diag(sqrt w), which also holds for a singular C.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(drawn);
  const double largest = eigen.eigenvalues().maxCoeff();
  if (eigen.info() != Eigen::Success || !std::isfinite(largest) ||
      eigen.eigenvalues().minCoeff() < -kSingularTolerance * std::abs(largest)) {
    return input_error(place + "/matrix",
                       "is no covariance: it is not positive semi-definite; identify again");
  }
  const Eigen::MatrixXd factor =
      eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  for (Eigen::Index i = 0; i < n; ++i) {
    std::vector<double>& row = sampler.factor_.emplace_back();
    for (Eigen::Index j = 0; j < n; ++j) row.push_back(factor(i, j));
  }
  return sampler;
}

Result<Plant<double>> PlantSampler::draw(std::uint64_t seed, int sample) const {
  const Result<Model> drawn = draw_model(seed, sample);
  if (!drawn) return tl::unexpected(drawn.error());
  return drawn->plant();
}

Result<Model> PlantSampler::draw_model(std::uint64_t seed, int sample) const {
  Random random(seed, static_cast<std::uint64_t>(sample));
  const std::vector<ParameterId>& ids = model_.covariance.parameters;
  std::vector<double> normals(ids.size());
  Model drawn = model_;
  for (int attempt = 0; attempt < kMostTries; ++attempt) {
    for (double& normal : normals) normal = random.normal();
    bool accepted = true;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      double z = centre_[i];
      for (std::size_t j = 0; j < ids.size(); ++j) z += factor_[i][j] * normals[j];
      const double value = is_exponent(ids[i]) ? z : std::exp(z);
      accepted = accepted && in_range(model_.vehicle, ids[i], value);
      drawn[ids[i]].value = value;
    }
    if (accepted) return drawn;
  }
  return input_error(model_.file + ":/vehicle",
                     fmt::format("{} draws of the exponents all fell outside surge_beta_range or "
                                 "yaw_beta_range: widen the range, or identify from more trials",
                                 kMostTries));
}

}  // namespace awmr
