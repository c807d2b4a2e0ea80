#include "awmr/simulate/plant_sampler.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <optional>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/random.h"
#include "awmr/core/statistics/distributions.h"
#include "awmr/core/statistics/linear_algebra.h"
#include "awmr/model/transform.h"

namespace awmr {
namespace {

/// Number of attempts to draw a plant without negative exponents and resistance terms. With more
/// attempts, a model for which such a plant is rare takes longer to fail.
constexpr int kMaxTries = 1000;

/// Number of the random stream of the scrub moment. Scrub has a stream of its own so that the
/// parameters of a draw are the same whether the model has scrub or not.
constexpr std::uint64_t kScrubStream = std::uint64_t{1} << 61U;

/// An eigenvalue of a covariance may be negative by this fraction of the largest one: a derived
/// parameter (m' from a1, b1) makes the covariance singular, and rounding can then make an
/// eigenvalue negative.
constexpr double kSingularTolerance = 1e-9;

/// False for a negative exponent, and for a negative optional term of a resistance (Coulomb,
/// quadratic, dead zone): a resistance does not fall with speed and does not drive the vehicle.
bool is_admissible(ParameterId id, double value) {
  const bool is_exponent = id == ParameterId::kSurgeBeta || id == ParameterId::kYawBeta;
  return !(is_exponent || info(id).term) || value >= 0.0;
}

/// Smallest fraction of a stratum's width at which a draw is placed: at 0, the normal quantile of
/// the first stratum would be infinite.
constexpr double kInsideStratum = 1e-6;

/// Standard normal quantile: the z with P(Z <= z) = p, where Z is standard normal and 0 < p < 1.
double normal_quantile(double p) { return -std::sqrt(2.0) * boost::math::erfc_inv(2.0 * p); }

/// Returns the value of a quantity, whose quantiles are y, at the standard normal number x. Between
/// the quantiles, the value is interpolated linearly; beyond them, it is extrapolated linearly.
double interpolate(const Quantiles& y, double x) {
  std::size_t right = 1;
  while (right + 1 < kQuantileCount && x > kQuantiles[right].normal_score) ++right;
  const double x0 = kQuantiles[right - 1].normal_score;
  const double share = (x - x0) / (kQuantiles[right].normal_score - x0);
  return y[right - 1] + share * (y[right] - y[right - 1]);
}

/// Draws `count` standard normal numbers, one in each of `count` strata of equal probability, in
/// random order.
std::vector<double> stratified_normals(int count, Random& random) {
  std::vector<double> normals;
  for (int i = 0; i < count; ++i) {
    const double place = std::max(random.uniform(), kInsideStratum);
    normals.push_back(normal_quantile((i + place) / count));
  }
  for (std::size_t i = normals.size(); i > 1; --i) {
    std::swap(normals[i - 1],
              normals[static_cast<std::size_t>(random.uniform() * static_cast<double>(i))]);
  }
  return normals;
}

/// Raises m' to at least Model::mass_norm_by_grip, the smallest normalised mass m' for which the
/// grip of the tyres suffices. Multiplies I'z by the same factor, because I'z = m' Iz/m.
void take_mass_by_grip(Model& model) {
  double& mass = *model[ParameterId::kMassNorm].value;
  const double factor = std::max(1.0, *model.mass_norm_by_grip / mass);
  mass *= factor;
  *model[ParameterId::kInertiaNorm].value *= factor;
}

Status check_shape(const Covariance& covariance, const std::string& place) {
  const std::size_t n = covariance.parameters.size();
  if (n == 0) {
    return input_error(ErrorCode::kNotIdentified, place,
                       "no fitted parameter has a covariance, so no random vehicles (samples) "
                       "can be drawn; identify the model from trials, or do not request samples");
  }
  bool square = covariance.matrix.size() == n;
  for (const auto& row : covariance.matrix) square = square && row.size() == n;
  if (!square) {
    return input_error(
        ErrorCode::kWrongType, place + "/matrix",
        fmt::format("the matrix must be {0} by {0}, one row and column per parameter; identify "
                    "again",
                    n));
  }
  return {};
}

/// Computes the covariance of the coordinates z, in which parameters are drawn (model/transform.h),
/// from the covariance C of the parameters p, q:
///   Cov(z_p, z_q) = C_pq / (dp/dz_p dq/dz_q)
Eigen::MatrixXd coordinate_covariance(const Model& model) {
  const std::vector<ParameterId>& ids = model.covariance.parameters;
  Eigen::MatrixXd covariance(rows_of(ids), rows_of(ids));
  for (std::size_t i = 0; i < ids.size(); ++i) {
    for (std::size_t j = 0; j < ids.size(); ++j) {
      covariance(eigen_index(i), eigen_index(j)) =
          model.covariance.matrix[i][j] /
          (jacobian(ids[i], *model[ids[i]].value) * jacobian(ids[j], *model[ids[j]].value));
    }
  }
  return covariance;
}

/// Returns a factor L of the covariance C, with L L^T = C; empty if C is not positive
/// semi-definite. The eigenvalues w and eigenvectors V also give the factor of a singular C:
///   C = V diag(w) V^T  =>  L = V diag(sqrt w)
std::optional<Eigen::MatrixXd> factor_of(const Eigen::MatrixXd& covariance) {
  const SymmetricEigen eigen = symmetric_eigen(covariance);
  const double largest = eigen.values.maxCoeff();
  if (!eigen.converged || !std::isfinite(largest) ||
      eigen.values.minCoeff() < -kSingularTolerance * std::abs(largest)) {
    return std::nullopt;
  }
  return eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace

Result<PlantSampler> PlantSampler::make(const Model& model) {
  AWMR_RETURN_IF_ERROR(model.plant());
  const std::string place = model.file + ":/covariance";
  AWMR_RETURN_IF_ERROR(check_shape(model.covariance, place));
  const std::optional<Eigen::MatrixXd> factor = factor_of(coordinate_covariance(model));
  if (!factor) {
    return input_error(ErrorCode::kContradiction, place + "/matrix",
                       "this covariance matrix is not positive semi-definite, so no random "
                       "vehicles (samples) can be drawn; identify the model again");
  }
  PlantSampler sampler;
  sampler.model_ = model;
  for (const ParameterId id : model.covariance.parameters) {
    sampler.centre_.push_back(to_coordinate(id, *model[id].value));
    sampler.quantiles_.push_back(model[id].quantiles);
    if (!model[id].quantiles) continue;
    for (double& z : *sampler.quantiles_.back()) z = to_coordinate(id, z);
  }
  for (Eigen::Index i = 0; i < factor->rows(); ++i) {
    std::vector<double>& row = sampler.factor_.emplace_back();
    for (Eigen::Index j = 0; j < factor->cols(); ++j) row.push_back((*factor)(i, j));
    sampler.deviation_.push_back(factor->row(i).norm());
  }
  return sampler;
}

Result<Plant<double>> PlantSampler::draw(std::uint64_t seed, int sample) const {
  AWMR_ASSIGN_OR_RETURN(const Model drawn, draw_model(seed, sample));
  return drawn.plant();
}

Result<std::vector<Plant<double>>> PlantSampler::draw_evenly(std::uint64_t seed, int count) const {
  Random random(seed, 0);  // stream 0; draw() uses the streams from 1 on
  Random of_scrub(seed, kScrubStream);
  const std::vector<double> scrubs = stratified_normals(count, of_scrub);
  std::vector<std::vector<double>> by_direction;
  for (std::size_t j = 0; j < normals_of_a_draw(); ++j) {
    by_direction.push_back(stratified_normals(count, random));
  }
  std::vector<Plant<double>> plants;
  for (int i = 0; i < count; ++i) {
    std::vector<double> normals;
    for (const std::vector<double>& of : by_direction) normals.push_back(of[at(i)]);
    const std::optional<Model> drawn = model_at(normals);
    AWMR_ASSIGN_OR_RETURN(const Plant<double> plant,
                          drawn ? with_scrub(*drawn, scrubs[at(i)]).plant() : draw(seed, i + 1));
    plants.push_back(plant);
  }
  return plants;
}

Result<Model> PlantSampler::draw_model(std::uint64_t seed, int sample) const {
  Random random(seed, static_cast<std::uint64_t>(sample));
  std::vector<double> normals(normals_of_a_draw());
  for (int attempt = 0; attempt < kMaxTries; ++attempt) {
    for (double& normal : normals) normal = random.normal();
    if (std::optional<Model> drawn = model_at(normals)) {
      Random of_scrub(seed, kScrubStream | static_cast<std::uint64_t>(sample));
      return with_scrub(*std::move(drawn), of_scrub.normal());
    }
  }
  return input_error(ErrorCode::kNotIdentified, model_.file + ":/covariance",
                     fmt::format("all {} randomly drawn vehicles have a negative exponent or "
                                 "term of a resistance; identify the model from more trials",
                                 kMaxTries));
}

Model PlantSampler::with_scrub(Model drawn, double normal) const {
  if (const auto& scrub = model_.yaw_scrub) {
    drawn.yaw_scrub->moment_m = scrub->moment_m + scrub->std_error_m * normal;
  }
  return drawn;
}

std::optional<Plant<double>> PlantSampler::plant_at(std::span<const double> normals) const {
  const std::optional<Model> model = model_at(normals);
  if (!model) return std::nullopt;
  const Result<Plant<double>> plant = model->plant();
  return plant ? std::optional(*plant) : std::nullopt;
}

int PlantSampler::rank() const {
  return static_cast<int>(directions_of(model_.covariance.parameters).size());
}

std::vector<std::vector<double>> PlantSampler::directions_of(
    std::span<const ParameterId> ids) const {
  // Each row of L is divided by its length, so that units have no effect. The directions are the
  // eigenvectors of L^T L whose eigenvalues are above 0.
  const std::size_t n = centre_.size();
  Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(eigen_index(n), eigen_index(n));
  for (std::size_t i = 0; i < n; ++i) {
    if (std::ranges::find(ids, model_.covariance.parameters[i]) == ids.end()) continue;
    const Eigen::VectorXd row =
        Eigen::Map<const Eigen::VectorXd>(factor_[i].data(), eigen_index(n));
    if (row.squaredNorm() > 0.0) spread += row * row.transpose() / row.squaredNorm();
  }
  const SymmetricEigen eigen = symmetric_eigen(spread);
  std::vector<std::vector<double>> directions;
  for (Eigen::Index j = eigen.values.size() - 1; j >= 0; --j) {
    if (!(eigen.values(j) > kSingularTolerance)) break;
    const Eigen::VectorXd v = eigen.vectors.col(j);
    directions.emplace_back(v.begin(), v.end());
  }
  return directions;
}

std::optional<Model> PlantSampler::model_at(std::span<const double> normals) const {
  const std::vector<ParameterId>& ids = model_.covariance.parameters;
  Model drawn = model_;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    double off = 0.0;
    for (std::size_t j = 0; j < ids.size(); ++j) off += factor_[i][j] * normals[j];
    const double score = deviation_[i] > 0.0 ? off / deviation_[i] : 0.0;
    const double z = quantiles_[i] ? interpolate(*quantiles_[i], score) : centre_[i] + off;
    const double value = from_coordinate(ids[i], z);
    if (!is_admissible(ids[i], value)) return std::nullopt;
    drawn[ids[i]].value = value;
  }
  const bool has_grip_normal = normals.size() > ids.size();
  if (has_grip_normal && normal_cdf(normals.back()) < kGripShare) take_mass_by_grip(drawn);
  return drawn;
}

}  // namespace awmr
