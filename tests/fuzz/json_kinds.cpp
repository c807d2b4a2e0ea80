/// Each kind of JSON file is read with values in range, or refused by name; its written form reads
/// back.
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
  require(again.has_value(), "a model that was written reads back");
  require(awmr::model_text(*again) == text, "and is written the same");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::filesystem::path& path = awmr::fuzz::file_of_bytes(data, size);
  if (const auto vehicle = awmr::read_vehicle(path); !is_refused(vehicle)) {
    require(vehicle->mass_kg > 0.0 && vehicle->front_axle_m > 0.0, "sizes are above 0");
    require(vehicle->wheel_force.lo < vehicle->wheel_force.hi, "there is a range of forces");
  }
  if (const auto gains = awmr::read_gains(path); !is_refused(gains)) {
    require(gains->heading.lambda > 0.0 && gains->speed.epsilon > 0.0, "gains are above 0");
    require(!gains->observer.is_on() || gains->observer.yaw_max_m > 0.0, "an observer has a limit");
  }
  if (const auto config = awmr::read_tune_config(path); !is_refused(config)) {
    require(config->options.margin > 0.0 && config->options.margin < 1.0, "there is a margin");
  }
  (void)is_refused(awmr::read_scenario(path));
  (void)is_refused(awmr::cli::read_project(path));
  if (const auto fit = awmr::read_tyres(path); !is_refused(fit)) {
    require(fit->tyres.friction > 0.0 && fit->tyres.cornering_per_rad > 0.0, "tyres are above 0");
  }
  check_model(path);
  return 0;
}
