/// Fuzz target: reads the bytes as each kind of JSON file. The reader returns values within their
/// ranges or a readable input error. A model that was written can be read again and is unchanged.
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/model/vehicle_file.h"
#include "awmr/simulate/scenario_file.h"
#include "awmr/tune/tune_file.h"
#include "awmr/validate/tyre_fit.h"
#include "fuzz/file_of_bytes.h"
#include "fuzz/target.h"
#include "project.h"

using awmr::fuzz::is_refused;
using awmr::fuzz::require;

namespace {

void check_model(const std::filesystem::path& path) {
  const auto model = awmr::read_model(path);
  if (is_refused(model)) return;
  (void)is_refused(model->plant());
  const std::string text = awmr::model_text(*model);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
  const auto again = awmr::read_model(awmr::fuzz::file_of_bytes(bytes, text.size()));
  require(again.has_value(), "a written model can be read");
  require(awmr::model_text(*again) == text, "a model read again is written unchanged");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::filesystem::path& path = awmr::fuzz::file_of_bytes(data, size);
  if (const auto vehicle = awmr::read_vehicle(path); !is_refused(vehicle)) {
    require(vehicle->mass_kg > 0.0 && vehicle->front_axle_m > 0.0,
            "mass and axle distance are above 0");
    require(vehicle->wheel_force.lo < vehicle->wheel_force.hi, "wheel force min is below max");
  }
  if (const auto gains = awmr::read_gains(path); !is_refused(gains)) {
    require(gains->heading.lambda > 0.0 && gains->speed.epsilon > 0.0, "gains are above 0");
    require(!gains->observer.is_on() || gains->observer.yaw_max_m > 0.0,
            "the observer's limit is above 0");
  }
  if (const auto config = awmr::read_tune_config(path); !is_refused(config)) {
    require(config->options.margin > 0.0 && config->options.margin < 1.0,
            "the margin is in (0, 1)");
  }
  (void)is_refused(awmr::read_scenario(path));
  (void)is_refused(awmr::cli::read_project(path));
  if (const auto fit = awmr::read_tyres(path); !is_refused(fit)) {
    require(fit->tyres.friction > 0.0 && fit->tyres.cornering_per_rad > 0.0,
            "the tyres' numbers are above 0");
  }
  check_model(path);
  return 0;
}
