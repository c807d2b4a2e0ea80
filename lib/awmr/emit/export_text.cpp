#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "awmr/core/text.h"
#include "c_text.h"
#include "exported_values.h"
#include "macros.h"

namespace awmr {
namespace {

/// Returns the shortest decimal that reads back to the same value, always with a point: 1.0,
/// 1.5e-07, 1.0e-07. Without it, some languages would read 1 as an integer, and YAML 1.1 would read
/// 1e-07 as a string.
std::string number(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find('.') != std::string::npos) return text;
  return text.insert(std::min(text.find('e'), text.size()), ".0");
}

/// Returns the first comment lines of the file: one for its content and one for each input with its
/// hash. `mark` begins a comment.
std::string head(const ExportSource& source, std::string_view mark, std::string_view what) {
  std::string text = fmt::format("{} {} of \"{}\", by awmr {} export.\n", mark, what,
                                 comment_safe(source.model.vehicle.name), version());
  for (const InputFile& input : source.inputs) {
    text += fmt::format("{} from {}, SHA-256 {}\n", mark, comment_safe(input.name), input.sha256);
  }
  return text;
}

/// Comment of a value: "a1: MEANING, in UNIT; fitted, log-linear; std error ..., 95 % [...]"
std::string comment(const ExportedValue& value) {
  const std::string uncertainty = uncertainty_text(value);
  return comment_safe(fmt::format("{}, in {}; {}{}{}", value.meaning, value.unit, value.origin,
                                  uncertainty.empty() ? "" : "; ", uncertainty));
}

constexpr std::string_view kForces =
    "Forces and moments are divided by F_max, the largest force of one motor, except those named "
    "si_...";

std::string ros2_text(const ExportSource& source) {
  std::string text = head(source, "#", "Parameters for any node") +
                     fmt::format("# {}\n/**:\n  ros__parameters:\n", kForces);
  for (const ExportedValue& value : exported_values(source)) {
    text += fmt::format("    {}: {}  # {}\n", value.name, number(value.value), comment(value));
  }
  return text;
}

std::string matlab_text(const ExportSource& source) {
  std::string text = head(source, "%", "Parameters") + fmt::format("% {}\n", kForces);
  for (const ExportedValue& value : exported_values(source)) {
    text += fmt::format("awmr.{} = {}; % {}\n", value.name, number(value.value), comment(value));
  }
  return text;
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string python_text(const ExportSource& source) {
  std::string text = head(source, "#", "Parameters") + fmt::format("# {}\n\n", kForces);
  std::string errors;
  std::string intervals;
  for (const ExportedValue& value : exported_values(source)) {
    const std::string name = upper(value.name);
    text += fmt::format("{} = {}  # {}\n", name, number(value.value), comment(value));
    if (value.std_error) errors += fmt::format("    \"{}\": {},\n", name, number(*value.std_error));
    if (value.ci95) {
      intervals += fmt::format("    \"{}\": ({}, {}),\n", name, number(value.ci95->lo),
                               number(value.ci95->hi));
    }
  }
  return text + fmt::format("\nSTD_ERROR = {{\n{}}}\n\nCI95 = {{\n{}}}\n", errors, intervals);
}

/// A quoted field, with inner quotes doubled. [RFC 4180, 2.7]
std::string csv_field(std::string_view text) {
  std::string field = "\"";
  for (const char c : comment_safe(text)) field += c == '"' ? "\"\"" : std::string(1, c);
  return field + "\"";
}

std::string csv_text(const ExportSource& source) {
  const auto cell = [](const std::optional<double>& value) {
    return value ? number(*value) : std::string();
  };
  std::string text =
      head(source, "#", "Parameters") + "name,value,unit,std_error,ci95_lo,ci95_hi,source\n";
  for (const ExportedValue& value : exported_values(source)) {
    const std::string interval =
        value.ci95 ? number(value.ci95->lo) + "," + number(value.ci95->hi) : ",";
    text +=
        fmt::format("{},{},{},{},{},{}\n", value.name, number(value.value), csv_field(value.unit),
                    cell(value.std_error), interval, csv_field(value.origin));
  }
  return text;
}

/// Appends each value of an autopilot to `text`: a comment with the equation, then the value in the
/// format of `row`; last, a comment with the reason for each parameter that the model does not
/// determine.
template <class Row>
std::string autopilot_text(std::string text, const AutopilotValues& found, const Row& row) {
  for (const ExportedValue& value : found.values) {
    text += fmt::format("# {}: {}\n{}", value.name, comment(value), row(value));
  }
  for (const std::string& name : found.left_out) text += fmt::format("# left out: {}\n", name);
  return text;
}

constexpr std::string_view kFirstDrive =
    "# These initial values are computed from the model. First drive with the wheels lifted, then "
    "slowly, with a hand on the power switch.\n"
    "# Intervals are from the model's covariance, to first order.\n";

Result<std::string> ardupilot_text(const ExportSource& source) {
  AWMR_ASSIGN_OR_RETURN(const AutopilotValues found, ardupilot_values(source));
  return autopilot_text(head(source, "#", "ArduPilot Rover parameters") + std::string(kFirstDrive),
                        found, [](const ExportedValue& value) {
                          // CRUISE_THROTTLE is in whole percent.
                          const bool is_percent = value.unit == "%";
                          return is_percent ? fmt::format("{},{:.0f}\n", value.name, value.value)
                                            : fmt::format("{},{:.6f}\n", value.name, value.value);
                        });
}

constexpr int kReal32 = 9;  ///< MAV_PARAM_TYPE_REAL32

Result<std::string> px4_text(const ExportSource& source) {
  AWMR_ASSIGN_OR_RETURN(const AutopilotValues found, px4_values(source));
  return autopilot_text(head(source, "#", "PX4 rover parameters") + std::string(kFirstDrive) +
                            "# Vehicle-Id Component-Id Name Value Type\n",
                        found, [](const ExportedValue& value) {
                          return fmt::format("1\t1\t{}\t{:.6f}\t{}\n", value.name, value.value,
                                             kReal32);
                        });
}

}  // namespace

Result<std::string> export_text(const ExportSource& source, ExportFormat format) {
  switch (format) {
    case ExportFormat::kRos2:
      return ros2_text(source);
    case ExportFormat::kMatlab:
      return matlab_text(source);
    case ExportFormat::kPython:
      return python_text(source);
    case ExportFormat::kCsv:
      return csv_text(source);
    case ExportFormat::kArduPilot:
      return ardupilot_text(source);
    case ExportFormat::kPx4:
      return px4_text(source);
  }
  return program_fault("an export format without a writer");
}

Result<std::vector<Finding>> export_findings(const ExportSource& source, ExportFormat format) {
  std::vector<Finding> findings;
  if (format != ExportFormat::kArduPilot && format != ExportFormat::kPx4) return findings;
  AWMR_ASSIGN_OR_RETURN(const AutopilotValues found, format == ExportFormat::kPx4
                                                         ? px4_values(source)
                                                         : ardupilot_values(source));
  if (found.beyond_range.empty()) return findings;
  findings.push_back({file_name(source.model), 0, Severity::kWarning, "autopilot-range",
                      fmt::format("outside of the ranges in the autopilot's manual: {}. Ground "
                                  "stations may refuse or limit these values. Check them, and "
                                  "drive slowly at first",
                                  fmt::join(found.beyond_range, ", "))});
  return findings;
}

}  // namespace awmr
