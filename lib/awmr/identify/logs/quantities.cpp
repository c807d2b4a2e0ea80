#include "awmr/identify/logs/quantities.h"

#include <fmt/format.h>

#include "awmr/core/index.h"

namespace awmr {
namespace {

Interval bounds_of(const FreeQuantity& quantity, double initial, const Vehicle& vehicle) {
  if (quantity.kind == FreeQuantity::Kind::kDelay) return {0.0, 1.0};
  if (quantity.kind == FreeQuantity::Kind::kBias) return {-1e6, 1e6};
  if (quantity.id == ParameterId::kSurgeBeta) {
    return {vehicle.surge_beta_range.lo, vehicle.surge_beta_range.hi};
  }
  if (quantity.id == ParameterId::kYawBeta) {
    return {vehicle.yaw_beta_range.lo, vehicle.yaw_beta_range.hi};
  }
  if (quantity.scale == Scale::kLinear) return {0.0, 1e6};
  return {initial - 10.0, initial + 10.0};
}

}  // namespace

std::string FreeQuantity::name() const {
  switch (kind) {
    case Kind::kParameter:
      return std::string(info(id).name);
    case Kind::kDelay:
      return std::string(kInputDelayName);
    case Kind::kBias:
      return fmt::format("{}{}", kBiasPrefix, info(channel).name);
  }
  return {};
}

double FreeQuantity::value(double coordinate) const { return from_coordinate(scale, coordinate); }

double FreeQuantity::jacobian(double coordinate) const {
  return awmr::jacobian(scale, value(coordinate));
}

std::vector<FreeQuantity> free_quantities(const LogFitOptions& options) {
  std::vector<FreeQuantity> quantities;
  for (const ParameterId id : options.free) {
    // A term is measured against the force that it is a part of.
    quantities.push_back(
        {.id = id, .scale = scale_of(id), .large_change = info(id).term ? 0.2 : 1.0});
  }
  if (options.delay) {
    quantities.push_back({.kind = FreeQuantity::Kind::kDelay, .large_change = 0.1});
  }
  for (const LogChannel channel : options.biases) {
    quantities.push_back({.kind = FreeQuantity::Kind::kBias, .channel = channel});
  }
  return quantities;
}

std::vector<double> initial_coordinates(const std::vector<FreeQuantity>& quantities,
                                        const ParameterValues<double>& initial_guess) {
  std::vector<double> coordinates;
  for (const FreeQuantity& q : quantities) {
    const bool parameter = q.kind == FreeQuantity::Kind::kParameter;
    coordinates.push_back(parameter ? to_coordinate(q.id, initial_guess[at(q.id)]) : 0.0);
  }
  return coordinates;
}

std::vector<Interval> coordinate_bounds(const std::vector<FreeQuantity>& quantities,
                                        const std::vector<double>& initial,
                                        const Vehicle& vehicle) {
  std::vector<Interval> bounds;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    bounds.push_back(bounds_of(quantities[i], initial[i], vehicle));
  }
  return bounds;
}

std::vector<double> values_at(const std::vector<FreeQuantity>& quantities,
                              const std::vector<double>& coordinates) {
  std::vector<double> values;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    values.push_back(quantities[i].value(coordinates[i]));
  }
  return values;
}

}  // namespace awmr
