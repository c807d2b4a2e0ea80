/// The values that `awmr export` writes, as numbers before they are formatted. Private to emit/.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/emit/export.h"

namespace awmr {

/// One number of an exported file.
struct ExportedValue {
  std::string name;  ///< an identifier in every language: "surge_alpha"
  double value = 0.0;
  std::string unit;
  std::string meaning;
  std::string origin;  ///< source and method: "fitted, log-linear"
  std::optional<double> std_error = {};
  std::optional<Interval> ci95 = {};
};

/// Returns the identified quantities (forces divided by F_max, and in SI units), the dimensions and
/// limits of the vehicle, and the gains. Unknown values are left out.
std::vector<ExportedValue> exported_values(const ExportSource& source);

/// Values for an autopilot's parameter file, and texts about the parameters without a value.
struct AutopilotValues {
  std::vector<ExportedValue> values;      ///< the equation is in ExportedValue::meaning
  std::vector<std::string> left_out;      ///< "NAME: reason"
  std::vector<std::string> beyond_range;  ///< "NAME = 2.68 (0 to 2)": outside of the manual's range
};
/// Derives the parameters of ArduPilot Rover and of PX4's rovers. Errors (input): the model lacks
/// the surge law or has back-EMF; not all four wheels are driven.
Result<AutopilotValues> ardupilot_values(const ExportSource& source);
Result<AutopilotValues> px4_values(const ExportSource& source);

/// Standard error and interval as text, as far as they are known: "std error 0.018, 95 % [1.275,
/// 1.357]".
std::string uncertainty_text(const ExportedValue& value);

}  // namespace awmr
