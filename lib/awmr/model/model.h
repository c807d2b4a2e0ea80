/// model.json (`awmr.model/1`): the identified vehicle, every number with its uncertainty and
/// origin.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/core/result.h"
#include "awmr/model/dynamics.h"
#include "awmr/model/family.h"
#include "awmr/model/parameters.h"
#include "awmr/model/record.h"
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

struct Covariance {
  std::vector<ParameterId> parameters;
  std::vector<std::vector<double>> matrix;  ///< square, symmetric, over `parameters`
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
