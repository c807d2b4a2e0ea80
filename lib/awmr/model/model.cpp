#include "awmr/model/model.h"

#include <fmt/format.h>

#include "awmr/model/plant_of.h"

namespace awmr {

double max_wheel_force_n(double mass_kg, double mass_norm) { return mass_kg / mass_norm; }

Model::Model() {
  for (const ParameterInfo& parameter : parameter_table()) {
    if (parameter.term) (*this)[parameter.id] = {0.0, {}, {}, Source::kGiven, "not in the family"};
  }
}

Result<Plant<double>> Model::plant() const {
  std::vector<Fault> faults;
  for (const ParameterInfo& parameter : parameter_table()) {
    if ((*this)[parameter.id].value) continue;
    faults.push_back(
        {fmt::format("{}:{}", file, parameter.pointer),
         fmt::format("no value for {} ({}, {}), which this needs; identify again with {}",
                     parameter.name, parameter.symbol, parameter.meaning, parameter.trial)});
  }
  if (!faults.empty()) return input_errors(std::move(faults));

  ParameterValues<double> values{};
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = *estimates[i].value;
  return plant_of(vehicle, values);
}

}  // namespace awmr
