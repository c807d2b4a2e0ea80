// The JSON of WPILib's SysId:
//
//     {"sysid": true, "test": "Drivetrain", "units": "Meters", "unitsPerRotation": 0.4788,
//      "slow-forward": [[t, left V, right V, left rot, right rot, left rot/s, right rot/s,
//                        rad, rad/s], ...],
//      "slow-backward": ..., "fast-forward": ..., "fast-backward": ...}
//
// Each test ("slow-forward", ...) becomes a run. "rot" are positions of the wheels in rotations,
// "rot/s" their velocities; both are converted to metres with unitsPerRotation and units. "rad" is
// the heading, "rad/s" the yaw rate, "V" the voltage of the motors.
//                      [wpilibsuite/sysid, docs/data-collection.md and AnalysisManager.cpp]
// The count of numbers in the first row determines their meaning:
//     9   Drivetrain, Drivetrain (Angular)    as above
//     4   Simple, General Mechanism           t, V, rotations, rotations/s
//     10  frc-characterization (older tool)   t, battery V, autospeed, left V, right V, left and
//                                             right rotations, left and right rotations/s, rad

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "awmr/core/json/json_document.h"
#include "awmr/core/name_table.h"
#include "awmr/core/units.h"
#include "log_formats.h"

namespace awmr {
namespace {

/// Names of the tests that a file may contain. Each test becomes a run, in this order.
constexpr std::array<std::string_view, 9> kSysIdTests{
    "slow-forward",    "slow-backward",       "fast-forward",
    "fast-backward",   "quasistatic-forward", "quasistatic-backward",
    "dynamic-forward", "dynamic-backward",    "track-width"};

constexpr NameTable<double, 3> kSysIdLengths_m{
    {{"Meters", 1.0}, {"Feet", 0.3048}, {"Inches", 0.0254}}};

/// Conversion of a number in the file: none, radians to degrees, rotations to metres.
enum class SysIdUnit { kNone, kDegrees, kMetres };

/// A number of a row that becomes a column.
struct SysIdField {
  std::size_t index;      ///< index of the number in the row, from 0
  std::string_view name;  ///< name of the column
  SysIdUnit unit = SysIdUnit::kNone;
};

struct SysIdRow {
  std::size_t numbers;  ///< count of numbers in a row
  std::vector<SysIdField> fields;
  bool is_drivetrain;
};

/// The kinds of rows, as described above.
const std::array<SysIdRow, 3>& sysid_rows() {
  static const std::array<SysIdRow, 3> kRows{{{.numbers = 9,
                                               .fields = {{1, "left_volts"},
                                                          {2, "right_volts"},
                                                          {3, "left_m", SysIdUnit::kMetres},
                                                          {4, "right_m", SysIdUnit::kMetres},
                                                          {5, "left_mps", SysIdUnit::kMetres},
                                                          {6, "right_mps", SysIdUnit::kMetres},
                                                          {7, "heading_deg", SysIdUnit::kDegrees},
                                                          {8, "yaw_rate_radps"}},
                                               .is_drivetrain = true},
                                              {.numbers = 10,
                                               .fields = {{3, "left_volts"},
                                                          {4, "right_volts"},
                                                          {5, "left_m", SysIdUnit::kMetres},
                                                          {6, "right_m", SysIdUnit::kMetres},
                                                          {7, "left_mps", SysIdUnit::kMetres},
                                                          {8, "right_mps", SysIdUnit::kMetres},
                                                          {9, "heading_deg", SysIdUnit::kDegrees}},
                                               .is_drivetrain = true},
                                              {.numbers = 4,
                                               .fields = {{1, "volts"},
                                                          {2, "position_m", SysIdUnit::kMetres},
                                                          {3, "speed_mps", SysIdUnit::kMetres}},
                                               .is_drivetrain = false}}};
  return kRows;
}

class SysIdReader {
 public:
  SysIdReader(const Json& document, std::string file)
      : document_(document), file_(std::move(file)) {}

  Result<ColumnLog> read();

 private:
  void fault(ErrorCode code, const std::string& pointer, std::string message) {
    if (faults_.size() < kMaxFaults)
      faults_.push_back({code, file_ + ":" + pointer, std::move(message)});
  }
  std::optional<std::string> text_at(const char* key);
  const SysIdRow* find_form();
  double read_metres_per_rotation();
  bool check_row(const Json& row, const std::string& pointer, const SysIdRow& form);
  void read_run(std::string_view test, const SysIdRow& form);
  std::vector<double>& values_of(std::string_view column);
  void correct_voltage_signs(std::size_t begin, const SysIdRow& form, std::string_view test);
  void add_speed();

  const Json& document_;
  std::string file_;
  std::vector<Fault> faults_ = {};
  ColumnLog log_ = {};
  double metres_ = 1.0;  ///< metres per rotation
  double runs_ = 0.0;
  std::vector<std::string> tests_ = {};
  std::vector<std::string> unsigned_tests_ = {};
};

std::optional<std::string> SysIdReader::text_at(const char* key) {
  const auto found = document_.find(key);
  if (found == document_.end()) return std::nullopt;
  if (found->is_string()) return found->get<std::string>();
  fault(ErrorCode::kWrongType, fmt::format("/{}", key), "expected a string");
  return std::nullopt;
}

/// Selects the row format by the number of values in a row. Adds a fault and returns null if there
/// is none.
const SysIdRow* SysIdReader::find_form() {
  const std::string test = text_at("test").value_or("");
  if (test == "Arm" || test == "Elevator") {
    fault(ErrorCode::kWrongFile, "/test",
          fmt::format("the test \"{}\" does not drive the robot; give a log of the test Drivetrain",
                      test));
    return nullptr;
  }
  for (const std::string_view name : kSysIdTests) {
    const auto rows = document_.find(name);
    if (rows == document_.end() || !rows->is_array() || rows->empty()) continue;
    const Json& first = rows->front();
    for (const SysIdRow& form : sysid_rows()) {
      if (first.is_array() && first.size() == form.numbers) return &form;
    }
    fault(ErrorCode::kWrongType, fmt::format("/{}/0", name),
          "expected 9 numbers (drivetrain), 4 (simple mechanism) or 10 (frc-characterization)");
    return nullptr;
  }
  fault(ErrorCode::kMissing, "/slow-forward",
        "no test has rows; record slow-forward, slow-backward, fast-forward and "
        "fast-backward");
  return nullptr;
}

double SysIdReader::read_metres_per_rotation() {
  const std::string units = text_at("units").value_or("");
  const auto unit_m = value_in(kSysIdLengths_m, units);
  if (!unit_m) {
    fault(ErrorCode::kUnknownName, "/units",
          fmt::format("\"{}\" is not a unit of length; set units to \"Meters\" and "
                      "unitsPerRotation to the wheel's circumference in metres",
                      units));
    return 1.0;
  }
  const auto factor = document_.find("unitsPerRotation");
  const bool is_positive =
      factor != document_.end() && factor->is_number() && factor->get<double>() > 0.0;
  const double metres = is_positive ? factor->get<double>() * *unit_m : 0.0;
  if (metres > 0.0 && std::isfinite(metres)) return metres;
  fault(ErrorCode::kOutOfRange, "/unitsPerRotation",
        fmt::format("expected a number above 0: the wheel's circumference in {}", units));
  return 1.0;
}

bool SysIdReader::check_row(const Json& row, const std::string& pointer, const SysIdRow& form) {
  if (!row.is_array() || row.size() != form.numbers) {
    fault(ErrorCode::kBrokenFile, pointer,
          fmt::format("expected {} numbers, as in the first row", form.numbers));
    return false;
  }
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (row[i].is_number() && std::isfinite(row[i].get<double>())) continue;
    fault(ErrorCode::kWrongType, fmt::format("{}/{}", pointer, i), "expected a finite number");
    return false;
  }
  return true;
}

void SysIdReader::read_run(std::string_view test, const SysIdRow& form) {
  const auto rows = document_.find(test);
  if (rows == document_.end()) return;
  if (!rows->is_array())
    return fault(ErrorCode::kWrongType, fmt::format("/{}", test), "expected an array of rows");
  if (rows->empty()) return;
  const std::size_t begin = log_.rows();
  double first_s = 0.0;
  double last_s = 0.0;
  std::size_t number = 0;
  for (const Json& row : *rows) {
    const std::string pointer = fmt::format("/{}/{}", test, number++);
    if (!check_row(row, pointer, form)) continue;
    const double t_s = row[0].get<double>();
    if (log_.rows() == begin) first_s = t_s;
    if (log_.rows() > begin && !(t_s > last_s)) {
      fault(ErrorCode::kWrongOrder, pointer + "/0",
            fmt::format("found {} after {}: time must increase", t_s, last_s));
      continue;
    }
    last_s = t_s;
    log_.columns[0].push_back(runs_ + 1.0);
    log_.columns[1].push_back(t_s - first_s);
    for (std::size_t i = 0; i < form.fields.size(); ++i) {
      const SysIdField& field = form.fields[i];
      const double factor = field.unit == SysIdUnit::kMetres    ? metres_
                            : field.unit == SysIdUnit::kDegrees ? degrees(1.0)
                                                                : 1.0;
      const double value = row[field.index].get<double>() * factor;
      if (!std::isfinite(value))
        fault(ErrorCode::kOutOfRange, pointer, "too large after conversion to metres or degrees");
      log_.columns[i + 2].push_back(value);
    }
  }
  if (log_.rows() == begin) return;
  correct_voltage_signs(begin, form, test);
  runs_ += 1.0;
  tests_.emplace_back(test);
}

std::vector<double>& SysIdReader::values_of(std::string_view column) {
  const auto found = std::ranges::find(log_.header, column);
  return log_.columns[static_cast<std::size_t>(found - log_.header.begin())];
}

/// Makes voltages without sign negative, as read_sysid() describes. (SysId itself gives a voltage
/// the sign of the wheels' velocity.)
void SysIdReader::correct_voltage_signs(std::size_t begin, const SysIdRow& form,
                                        std::string_view test) {
  using Pair = std::pair<std::string_view, std::string_view>;
  const std::vector<Pair> pairs =
      form.is_drivetrain
          ? std::vector<Pair>{{"left_volts", "left_mps"}, {"right_volts", "right_mps"}}
          : std::vector<Pair>{{"volts", "speed_mps"}};
  bool is_mirrored = false;
  for (const auto& [volts_name, speed_name] : pairs) {
    std::vector<double>& volts = values_of(volts_name);
    const std::vector<double>& speed = values_of(speed_name);
    double travelled = 0.0;
    double most_volts = 0.0;
    bool has_negative = false;
    for (std::size_t i = begin; i < log_.rows(); ++i) {
      travelled += speed[i];
      most_volts = std::max(most_volts, volts[i]);
      has_negative = has_negative || volts[i] < 0.0;
    }
    if (has_negative || !(most_volts > 0.0) || travelled >= 0.0) continue;
    for (std::size_t i = begin; i < log_.rows(); ++i) volts[i] = -volts[i];
    is_mirrored = true;
  }
  if (is_mirrored) unsigned_tests_.emplace_back(test);
}

/// Adds the column speed_mps of a drivetrain: the mean of its left and right speeds.
void SysIdReader::add_speed() {
  std::vector<double> speed = values_of("left_mps");
  const std::vector<double>& right = values_of("right_mps");
  for (std::size_t i = 0; i < speed.size(); ++i) speed[i] = 0.5 * (speed[i] + right[i]);
  log_.header.emplace_back("speed_mps");
  log_.columns.push_back(std::move(speed));
}

Result<ColumnLog> SysIdReader::read() {
  if (!document_.is_object()) {
    return input_error(ErrorCode::kWrongFile, file_, "expected an object, as SysId writes it");
  }
  const SysIdRow* form = find_form();
  metres_ = read_metres_per_rotation();
  if (!faults_.empty()) return input_errors(std::move(faults_));
  log_.header = {"run", "t_s"};
  for (const SysIdField& field : form->fields) log_.header.emplace_back(field.name);
  log_.columns.resize(log_.header.size());
  for (const std::string_view test : kSysIdTests) read_run(test, *form);
  if (!faults_.empty()) return input_errors(std::move(faults_));
  if (form->is_drivetrain) add_speed();
  std::string message = fmt::format(
      "SysId record: runs {}; {:.6g} m per rotation; {} in volts: divide by the voltage of full "
      "power to get F'",
      fmt::join(tests_, ", "), metres_,
      form->is_drivetrain ? "left_volts and right_volts are" : "volts is");
  if (!unsigned_tests_.empty()) {
    message += fmt::format(
        "; the voltages of {} have no sign and are used as negative, because the wheels "
        "turned backward",
        fmt::join(unsigned_tests_, ", "));
  }
  log_.notes.push_back({0, "sysid-log", std::move(message)});
  return std::move(log_);
}

}  // namespace

bool is_sysid(std::string_view bytes) {
  constexpr std::string_view kBlanks = " \t\r\n";
  constexpr std::size_t kLooked = std::size_t{1} << 12U;
  const std::size_t brace = bytes.find_first_not_of(kBlanks);
  if (brace == std::string_view::npos || bytes[brace] != '{') return false;
  const std::string_view begin = bytes.substr(brace, kLooked);
  if (begin.find("\"sysid\"") != std::string_view::npos) return true;
  return std::ranges::any_of(kSysIdTests, [&](std::string_view test) {
    return begin.find(fmt::format("\"{}\"", test)) != std::string_view::npos;
  });
}

Result<ColumnLog> read_sysid(std::string_view bytes, const std::string& file) {
  AWMR_ASSIGN_OR_RETURN(const Json document, read_json_text(bytes, file));
  return SysIdReader(document, file).read();
}

}  // namespace awmr
