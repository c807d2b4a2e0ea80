#include "awmr/trials/column_guess.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/csv.h"
#include "awmr/core/csv/column_expression.h"
#include "awmr/core/csv/time_column.h"
#include "awmr/core/units.h"
#include "awmr/trials/checks/channel_quality.h"
#include "awmr/trials/checks/constant_channels.h"
#include "awmr/trials/column_words.h"
#include "awmr/trials/trial_columns.h"

namespace awmr {
namespace {

/// A guess of the unit of a file's column, with the `--column` expression that converts the column
/// to awmr's unit.
struct Scale {
  std::string expression;
  Confidence confidence = Confidence::kUnsure;
  std::string why;
};

std::string times(const std::string& name, double factor) {
  return factor == 1.0 ? name : fmt::format("{}*{:.7g}", name, factor);
}

std::optional<Scale> by_unit_in_name(const std::string& quoted, const Words& words,
                                     Dimension dimension) {
  const auto unit = unit_in(words, dimension);
  if (!unit) return std::nullopt;
  return Scale{times(quoted, unit->factor), Confidence::kLikely,
               fmt::format("the name ends in the unit {}", unit->spelling)};
}

/// True if the words of a name indicate a field of a ROS 2 message or a gyroscope of ArduPilot.
/// Their units are known: SI by convention, for the gyroscope rad/s.
bool is_si_by_convention(const Words& words) {
  const bool ros = has_any(words, {"twist", "pose", "drive"}) ||
                   (has_any(words, {"angular"}) && has_any(words, {"velocity", "z"}));
  return ros || (has_any(words, {"imu"}) && has_any(words, {"gyr"}));
}

/// Assumed angle of the steering stop and voltage of full power, for guesses that need them. The
/// reason of such a guess states the value, so that the user can check it.
constexpr double kUsualStop_deg = 20.0;
constexpr double kUsualVolts = 12.0;

/// True if the values may be pulse lengths of a servo or a motor driver in us: all lie between 800
/// and 2200. (Usual pulses have 1000 to 2000 us.)
bool looks_like_pulses(const std::vector<double>& values) {
  if (values.empty()) return false;
  const auto [least, most] = std::ranges::minmax(values);
  return least >= 800.0 && most <= 2200.0;
}

Scale force_scale(const std::string& quoted, const Words& words,
                  const std::vector<double>& values) {
  const double most = largest_size(values);
  if (has_any(words, {"volts", "volt", "voltage"})) {
    return {fmt::format("{}/{:g}", quoted, kUsualVolts), Confidence::kUnsure,
            fmt::format("volts divided by the voltage of full power, assumed to be {:g} V",
                        kUsualVolts)};
  }
  if (most <= 1.0) {
    return {quoted, Confidence::kLikely,
            "the values lie within [-1, 1], as forces divided by "
            "the largest force of a motor do"};
  }
  if (most <= 100.0) return {quoted + "/100", Confidence::kUnsure, "the values look like percent"};
  if (most <= 255.0)
    return {quoted + "/255", Confidence::kUnsure, "the values look like 8-bit PWM"};
  if (looks_like_pulses(values)) {
    return {fmt::format("({} - 1500)/500", quoted), Confidence::kUnsure,
            "the values look like servo pulses in us, 1500 at rest"};
  }
  return {fmt::format("{}/{:.4g}", quoted, most), Confidence::kUnsure,
          fmt::format("the value at full power is unknown; assumed to be the largest value, {:.4g}",
                      most)};
}

Scale scale_of(const std::string& quoted, const Words& words, Dimension dimension,
               const std::vector<double>& values) {
  if (auto unit = by_unit_in_name(quoted, words, dimension)) return *std::move(unit);
  if (dimension == Dimension::kForce) return force_scale(quoted, words, values);
  if (dimension == Dimension::kCount) return {quoted, Confidence::kLikely, "a number without unit"};
  if (dimension == Dimension::kGeographic) {
    return {quoted, Confidence::kLikely, "positions on the Earth are given in degrees"};
  }
  const double to_column_unit = dimension == Dimension::kAngle ? degrees(1.0) : 1.0;
  if (is_si_by_convention(words)) {
    return {times(quoted, to_column_unit), Confidence::kLikely,
            "messages of this kind are in SI units"};
  }
  if (dimension == Dimension::kAngle && looks_like_pulses(values)) {
    return {fmt::format("({} - 1500)/500*{:g}", quoted, kUsualStop_deg), Confidence::kUnsure,
            fmt::format("the values look like servo pulses in us: 1500 is straight ahead, 1000 and "
                        "2000 are the steering stops, assumed to be at {:g} deg",
                        kUsualStop_deg)};
  }
  if (dimension == Dimension::kAngle && largest_size(values) > 2.0 * pi<double>()) {
    return {quoted, Confidence::kLikely,
            fmt::format("the values reach {:.4g}, more than a full turn in radians, so they are "
                        "degrees",
                        largest_size(values))};
  }
  return {times(quoted, 1.0), Confidence::kUnsure,
          "the name has no unit, and the values fit several units"};
}

/// Returns the name as it is written in an expression: in backticks if necessary.
std::string quoted(const std::string& name) {
  const bool bare = std::all_of(name.begin(), name.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
  });
  const bool begins_as_name =
      !name.empty() && std::isdigit(static_cast<unsigned char>(name[0])) == 0;
  return bare && begins_as_name && name != "pi" ? name : "`" + name + "`";
}

std::vector<double> first_of(const std::vector<double>& values) {
  constexpr std::size_t kShown = 5;
  return {values.begin(),
          values.begin() + static_cast<std::ptrdiff_t>(std::min(values.size(), kShown))};
}

/// Adds guesses of the heading from orientation quaternions with all four components.
void add_quaternions(const FileSample& sample, std::vector<ColumnGuess>& guesses) {
  const std::set<std::string> names(sample.names.begin(), sample.names.end());
  for (const std::string& name : sample.names) {
    constexpr std::string_view kEnd = "orientation.w";
    if (!name.ends_with(kEnd)) continue;
    const std::string stem = name.substr(0, name.size() - 1);
    const auto part = [&](const char* axis) { return quoted(stem + axis); };
    if (names.count(stem + "x") + names.count(stem + "y") + names.count(stem + "z") != 3) continue;
    guesses.push_back({"heading_deg",
                       fmt::format("atan2(2*({0}*{3} + {1}*{2}), 1 - 2*({2}*{2} + {3}*{3}))*180/pi",
                                   part("w"), part("x"), part("y"), part("z")),
                       Confidence::kLikely, "the heading of this orientation quaternion"});
  }
}

bool increases(const std::vector<double>& values) {
  return values.size() > 1 &&
         std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end();
}

/// Adds a guess for the first column whose values rise and whose name has a word for a time or
/// begins with a unit of time: `TimeUS`, `ms_today`, `t`. Without a unit, assumes seconds.
void add_named_time(const FileSample& sample, std::vector<ColumnGuess>& guesses) {
  for (std::size_t i = 0; i < sample.names.size(); ++i) {
    const Words words = words_of(sample.names[i]);
    const auto first_unit = unit_in({words.front()}, Dimension::kTime);
    const bool is_time = has_any(words, kClockWords) || first_unit;
    const auto unit = first_unit ? first_unit : unit_in(words, Dimension::kTime);
    if (!is_time || !increases(sample.values[i])) continue;
    guesses.push_back({std::string(kTimeName),
                       times(quoted(sample.names[i]), unit ? unit->factor : 1.0),
                       unit ? Confidence::kLikely : Confidence::kUnsure,
                       unit ? "the name has a unit of time, and the values rise"
                            : "the values rise, and the name has no unit; seconds are assumed",
                       first_of(sample.values[i])});
    return;
  }
}

void add_time(const FileSample& sample, std::vector<ColumnGuess>& guesses) {
  const auto time = find_time(sample.names, sample.texts);
  if (!time) {
    guesses.push_back({std::string(kTimeName), "", Confidence::kUnsure, time.error()});
  } else if (*time) {
    guesses.push_back({std::string(kTimeName), (*time)->expression, Confidence::kLikely,
                       (*time)->meaning + "; it is also read without a mapping"});
  }
  if (!guesses.empty()) return;
  add_named_time(sample, guesses);
}

/// Index of the file's column that the guess uses; empty for a formula of several columns.
std::optional<std::size_t> source_of(const ColumnGuess& guess, const FileSample& sample) {
  for (std::size_t i = 0; i < sample.names.size(); ++i) {
    const std::string name = quoted(sample.names[i]);
    const bool is_source = guess.expression == name || guess.expression == sample.names[i] ||
                           guess.expression.starts_with(name + "*");
    if (is_source) return i;
  }
  return std::nullopt;
}

/// Clears each guess whose source column is constant while other channels of the file move, because
/// such a column is not a measurement.
void withdraw_constants(const FileSample& sample, std::vector<ColumnGuess>& guesses) {
  for (ColumnGuess& guess : guesses) {
    const auto source = source_of(guess, sample);
    if (!source) continue;
    // Returns the values of one of awmr's columns: those of the source column of this guess, or for
    // any other column, those of the source column of its first guess.
    const auto values = [&](std::string_view column) -> std::optional<std::span<const double>> {
      if (column == guess.column) return sample.values[*source];
      for (const ColumnGuess& other : guesses) {
        if (other.column != column) continue;
        const auto index = source_of(other, sample);
        return index ? std::optional(std::span<const double>(sample.values[*index])) : std::nullopt;
      }
      return std::nullopt;
    };
    for (const ConstantChannel& one : constant_channels(values)) {
      if (info(one.channel).column != guess.column) continue;
      guess.why = fmt::format(
          "{} is {:g} in the first {} rows while other channels move: not a "
          "measurement",
          sample.names[*source], one.value, sample.values[*source].size());
      guess.expression.clear();
      guess.confidence = Confidence::kUnsure;
      break;
    }
  }
}

/// Sorts the guesses for one column by confidence. If several guesses are kLikely and none is
/// kSure, the user must choose, so the kLikely guesses become kUnsure.
void settle(std::span<ColumnGuess> guesses) {
  std::stable_sort(guesses.begin(), guesses.end(), [](const ColumnGuess& a, const ColumnGuess& b) {
    return a.confidence < b.confidence;
  });
  if (guesses.size() < 2 || guesses[0].confidence != Confidence::kLikely) return;
  if (guesses[1].confidence != Confidence::kLikely) return;
  for (ColumnGuess& guess : guesses) {
    if (guess.confidence != Confidence::kLikely) continue;
    guess.confidence = Confidence::kUnsure;
    guess.why += "; another column fits as well";
  }
}

/// True if the log names velocities by the letters u and v, as vehicle dynamics and `awmr simulate`
/// do (u_mps, v_mps). The letter v is then the lateral speed, not the speed.
bool has_body_velocities(const FileSample& sample) {
  const auto has = [&](const char* letter) {
    return std::any_of(sample.names.begin(), sample.names.end(),
                       [&](const std::string& name) { return words_of(name).front() == letter; });
  };
  return has("u") && has("v");
}
/// Replaces the letter u, v or r by the word speed, sway or yawrate, if the name consists only of
/// that letter and a unit (u_mps). u_ref_mps stays, because it is a reference, not a measurement.
Words with_body_velocity(Words words) {
  const bool is_reading = words.size() == 1 || unit_in(words, Dimension::kSpeed) ||
                          unit_in(words, Dimension::kAngularRate);
  if (!is_reading || words.size() > 3 || has_any(words, {"ref", "cmd", "des"})) return words;
  if (words.front() == "u") words.front() = "speed";
  if (words.front() == "v") words.front() = "sway";
  if (words.front() == "r") words.front() = "yawrate";
  return words;
}

/// Columns with the speeds of a left and a right wheel, and their unit.
struct WheelSpeeds {
  std::string left;   ///< name as it is written in an expression
  std::string right;  ///< as `left`
  std::optional<NamedUnit> unit;
};

/// Returns all pairs of columns whose names differ only in the side.
std::vector<WheelSpeeds> wheel_speeds_in(const FileSample& sample) {
  std::vector<WheelSpeeds> pairs;
  for (const std::string& left : sample.names) {
    const auto of_left = wheel_speed_in(words_of(left));
    if (!of_left || !of_left->is_left) continue;
    for (const std::string& right : sample.names) {
      const auto of_right = wheel_speed_in(words_of(right));
      if (!of_right || of_right->is_left || of_right->rest != of_left->rest) continue;
      pairs.push_back({quoted(left), quoted(right), unit_in(of_left->rest, Dimension::kSpeed)});
    }
  }
  return pairs;
}

/// Text that states how the unit of the wheel speeds is known.
std::string unit_reason(const WheelSpeeds& wheels) {
  return wheels.unit ? fmt::format("the names have the unit {}", wheels.unit->spelling)
                     : "the names have no unit, and the values fit several units";
}

/// Adds the speed as the mean of the speeds of a left and a right wheel.
void add_mean_of_wheels(const FileSample& sample, std::vector<ColumnGuess>& guesses) {
  for (const WheelSpeeds& wheels : wheel_speeds_in(sample)) {
    guesses.push_back({"speed_mps",
                       times(fmt::format("({}+{})/2", wheels.left, wheels.right),
                             wheels.unit ? wheels.unit->factor : 1.0),
                       wheels.unit ? Confidence::kLikely : Confidence::kUnsure,
                       "the mean of a left and a right wheel; " + unit_reason(wheels)});
  }
}

/// Adds the yaw rate r = (v_R - v_L)/track of the wheel speeds v_L and v_R. Without a track, the
/// guess has no expression, and its reason gives the formula.
void add_difference_of_wheels(const FileSample& sample, std::optional<double> track_m,
                              std::vector<ColumnGuess>& guesses) {
  for (const WheelSpeeds& wheels : wheel_speeds_in(sample)) {
    const double factor = wheels.unit ? wheels.unit->factor : 1.0;
    const auto formula = [&](const std::string& track) {
      return times(fmt::format("({}-{})/{}", wheels.right, wheels.left, track), factor);
    };
    if (!track_m) {
      guesses.push_back(
          {"yaw_rate_radps", "", Confidence::kUnsure,
           fmt::format("{}, with the distance TRACK of the left from the right wheels in m; a "
                       "vehicle file gives it (option --vehicle)",
                       formula("TRACK"))});
      continue;
    }
    guesses.push_back({"yaw_rate_radps", formula(fmt::format("{:.7g}", *track_m)),
                       wheels.unit ? Confidence::kLikely : Confidence::kUnsure,
                       "the difference of a right and a left wheel over the track; wheels that "
                       "slide sideways make it too large, a gyroscope does not; " +
                           unit_reason(wheels)});
  }
}

/// Adds guesses for the force of one side from columns without a side, such as `throttle_pct`: one
/// command for all motors.
void add_common_force(const std::string& column, const FileSample& sample,
                      std::vector<ColumnGuess>& guesses) {
  static const std::set<std::string> kOfBattery{"voltage", "volts",   "power", "input",
                                                "supply",  "battery", "batt",  "bat"};
  for (std::size_t i = 0; i < sample.names.size(); ++i) {
    const Words words = words_of(sample.names[i]);
    const auto dimension = dimension_as(TrialKind::kSurge, "wheel_force", words);
    if (!dimension || has_any(words, kOfBattery) ||
        dimension_as(TrialKind::kLog, "steering_cmd_deg", words)) {
      continue;
    }
    Scale scale = scale_of(quoted(sample.names[i]), words, *dimension, sample.values[i]);
    guesses.push_back({column, std::move(scale.expression), Confidence::kUnsure,
                       "one command for both sides; " + scale.why, first_of(sample.values[i])});
  }
}

/// Guesses which columns of the sample provide awmr's column `column`. `track_m`: as in
/// guess_columns().
std::vector<ColumnGuess> guesses_of(const std::string& column, const FileSample& sample,
                                    TrialKind kind, std::optional<double> track_m) {
  std::vector<ColumnGuess> guesses;
  const bool by_letters = kind == TrialKind::kLog && has_body_velocities(sample);
  for (std::size_t i = 0; i < sample.names.size(); ++i) {
    const std::string& name = sample.names[i];
    if (name == column) {
      guesses.push_back({column, name, Confidence::kSure, "the column already has awmr's name",
                         first_of(sample.values[i])});
      continue;
    }
    const Words words = by_letters ? with_body_velocity(words_of(name)) : words_of(name);
    const auto dimension = dimension_as(kind, column, words);
    if (!dimension) continue;
    Scale scale = scale_of(quoted(name), words, *dimension, sample.values[i]);
    guesses.push_back({column, std::move(scale.expression), scale.confidence, std::move(scale.why),
                       first_of(sample.values[i])});
  }
  if (column == "heading_deg") add_quaternions(sample, guesses);
  if (!guesses.empty()) return guesses;
  if (column == kTimeName) add_time(sample, guesses);
  if (kind != TrialKind::kLog) return guesses;
  if (column == "force_left" || column == "force_right") add_common_force(column, sample, guesses);
  if (column == "speed_mps") add_mean_of_wheels(sample, guesses);
  if (column == "yaw_rate_radps") add_difference_of_wheels(sample, track_m, guesses);
  return guesses;
}

}  // namespace

std::vector<ColumnGuess> guess_columns(const FileSample& sample, TrialKind kind,
                                       std::optional<double> track_m) {
  std::vector<ColumnGuess> all;
  // Among coast-down files, only a table of speed bins (column from_mps) needs elapsed_s.
  const bool has_no_bins =
      kind == TrialKind::kCoastdown && !contains(sample.names, std::string_view("from_mps"));
  for (const CsvColumn& column : columns_of(kind)) {
    if (has_no_bins && column.name == "elapsed_s") continue;
    append(all, guesses_of(column.name, sample, kind, track_m));
  }
  if (kind == TrialKind::kLog) withdraw_constants(sample, all);
  for (auto begin = all.begin(); begin != all.end();) {
    const auto end = std::find_if(
        begin, all.end(), [&](const ColumnGuess& guess) { return guess.column != begin->column; });
    settle({begin, end});
    begin = end;
  }
  return all;
}

std::vector<ColumnGuess> likely_columns(const std::vector<ColumnGuess>& guesses) {
  std::vector<ColumnGuess> first;
  for (const ColumnGuess& guess : guesses) {
    const bool is_new = std::none_of(first.begin(), first.end(), [&](const ColumnGuess& other) {
      return other.column == guess.column;
    });
    if (is_new && guess.confidence != Confidence::kUnsure) first.push_back(guess);
  }
  return first;
}

std::vector<std::string> unused_columns(const FileSample& sample,
                                        const std::vector<ColumnGuess>& guesses) {
  std::set<std::string> used;
  for (const ColumnGuess& guess : guesses) {
    // A guess of the form SOURCE*SCALE+OFFSET is matched by text, because SOURCE may contain
    // characters that ColumnExpression::parse() does not accept in a name.
    for (const std::string& name : sample.names) {
      if (guess.expression == name || guess.expression.starts_with(name + "*")) used.insert(name);
    }
    const auto formula = ColumnExpression::parse(guess.expression);
    if (formula) used.insert(formula->names().begin(), formula->names().end());
  }
  std::vector<std::string> unused;
  std::ranges::copy_if(sample.names, std::back_inserter(unused),
                       [&](const std::string& name) { return !used.contains(name); });
  return unused;
}

}  // namespace awmr
