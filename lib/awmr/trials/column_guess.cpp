#include "awmr/trials/column_guess.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "awmr/core/csv.h"
#include "awmr/core/time_column.h"
#include "awmr/core/units.h"
#include "awmr/trials/trial_columns.h"

namespace awmr {
namespace {

using Words = std::vector<std::string>;

/// A name in its words, lower case: `IMU.GyrZ` is imu, gyr, z.
Words words_of(std::string_view name) {
  Words words(1);
  char before = ' ';
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool begins =
        std::isupper(byte) != 0 && std::islower(static_cast<unsigned char>(before)) != 0;
    if ((begins || std::isalnum(byte) == 0) && !words.back().empty()) words.emplace_back();
    if (std::isalnum(byte) != 0) words.back() += static_cast<char>(std::tolower(byte));
    before = c;
  }
  if (words.size() > 1 && words.back().empty()) words.pop_back();
  return words;
}

bool has_any(const Words& words, const std::set<std::string>& any) {
  return std::any_of(words.begin(), words.end(),
                     [&](const std::string& word) { return any.count(word) != 0; });
}

enum class Dimension { kForce, kAngle, kAngularRate, kSpeed, kLength, kGeographic };

/// What the words of a name have to be for a column: one of each of `all`, none of `none`.
struct Rule {
  const char* column;
  std::vector<std::set<std::string>> all;
  std::set<std::string> none;
  Dimension dimension;
};

const std::vector<Rule>& rules() {
  static const std::set<std::string> kCommand{"cmd",     "command", "setpoint", "sp",
                                              "desired", "target",  "ref",      "reference"};
  static const std::set<std::string> kThrust{"force", "duty",   "pwm",    "throttle", "thrust",
                                             "motor", "effort", "torque", "power"};
  static const std::set<std::string> kSteer{"steer", "steering", "delta", "servo"};
  static const std::set<std::string> kAcceleration{"acc",  "accel", "acceleration",
                                                   "jerk", "time",  "covariance"};
  static const std::set<std::string> kNoPosition{
      "orientation", "linear", "angular", "velocity", "vel", "gyr", "gyro", "mag", "q"};
  static const std::vector<Rule> kRules{
      {"force_left", {{"left", "l"}, kThrust}, {"speed", "vel", "rpm"}, Dimension::kForce},
      {"force_right", {{"right", "r"}, kThrust}, {"speed", "vel", "rpm"}, Dimension::kForce},
      {"x_m", {{"x", "px", "east"}}, kNoPosition, Dimension::kLength},
      {"y_m", {{"y", "py", "north"}}, kNoPosition, Dimension::kLength},
      {"heading_deg",
       {{"heading", "yaw", "psi", "course", "hdg"}},
       {"rate", "speed", "dot"},
       Dimension::kAngle},
      {"speed_mps",
       {{"speed", "velocity", "vel", "v", "vx", "spd", "linear"}},
       {"y", "z", "vy", "vz", "angular", "yaw", "wheel", "left", "right", "motor", "angle"},
       Dimension::kSpeed},
      {"sway_mps", {{"vy", "sway"}}, {}, Dimension::kSpeed},
      {"sway_mps", {{"velocity", "vel", "linear"}, {"y"}}, {"angular"}, Dimension::kSpeed},
      {"yaw_rate_radps", {{"yawrate", "omega", "wz"}}, {}, Dimension::kAngularRate},
      {"yaw_rate_radps", {{"yaw"}, {"rate", "speed", "dot"}}, {}, Dimension::kAngularRate},
      {"yaw_rate_radps", {{"gyr", "gyro", "angular"}, {"z"}}, {}, Dimension::kAngularRate},
      {"steering_deg", {kSteer}, kCommand, Dimension::kAngle},
      {"steering_cmd_deg", {kSteer, kCommand}, {}, Dimension::kAngle},
      {"latitude_deg", {{"lat", "latitude"}}, {}, Dimension::kGeographic},
      {"longitude_deg", {{"lon", "lng", "long", "longitude"}}, {}, Dimension::kGeographic}};
  // What accelerates or is a time or a covariance is none of them.
  static const std::vector<Rule> kAll = [] {
    std::vector<Rule> all = kRules;
    for (Rule& rule : all) rule.none.insert(kAcceleration.begin(), kAcceleration.end());
    return all;
  }();
  return kAll;
}

bool fits(const Rule& rule, const Words& words) {
  return !has_any(words, rule.none) &&
         std::all_of(rule.all.begin(), rule.all.end(),
                     [&](const std::set<std::string>& any) { return has_any(words, any); });
}

/// A unit that a name ends in, by its last word or its last two (`m/s` is m, s).
struct Unit {
  Dimension dimension;
  std::vector<std::string_view> spellings;
  double factor;  ///< to the unit that is asked for
};

const std::vector<Unit>& units() {
  static const double kDegree = degrees(1.0);
  static const std::vector<Unit> kUnits{
      {Dimension::kSpeed, {"mps", "m s"}, 1.0},
      {Dimension::kSpeed, {"kmh", "kph", "km h"}, 1.0 / 3.6},
      {Dimension::kSpeed, {"mph"}, 0.44704},
      {Dimension::kSpeed, {"cmps", "cm s"}, 0.01},
      {Dimension::kSpeed, {"mmps", "mm s"}, 0.001},
      {Dimension::kAngularRate, {"radps", "rad s", "rads"}, 1.0},
      {Dimension::kAngularRate, {"degps", "dps", "deg s", "degs"}, 1.0 / kDegree},
      {Dimension::kAngle, {"deg", "degrees"}, 1.0},
      {Dimension::kAngle, {"rad", "radians"}, kDegree},
      {Dimension::kLength, {"m", "metres", "meters"}, 1.0},
      {Dimension::kLength, {"cm"}, 0.01},
      {Dimension::kLength, {"mm"}, 0.001},
      {Dimension::kGeographic, {"deg", "degrees"}, 1.0},
      {Dimension::kForce, {"percent", "pct"}, 0.01}};
  return kUnits;
}

/// What a guess of the unit comes to.
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
  if (words.size() < 2) return std::nullopt;
  const std::string& last = words.back();
  const std::string last_two = words[words.size() - 2] + " " + last;
  for (const Unit& unit : units()) {
    if (unit.dimension != dimension) continue;
    for (const std::string_view spelling : unit.spellings) {
      if (spelling != last && spelling != last_two) continue;
      return Scale{times(quoted, unit.factor), Confidence::kLikely,
                   fmt::format("the name ends in the unit {}", spelling)};
    }
  }
  return std::nullopt;
}

/// ROS 2 messages are in SI units by their convention, and ArduPilot's gyros in rad/s.
bool is_si_by_convention(const Words& words) {
  const bool ros = has_any(words, {"twist", "pose", "drive"}) ||
                   (has_any(words, {"angular"}) && has_any(words, {"velocity", "z"}));
  return ros || (has_any(words, {"imu"}) && has_any(words, {"gyr"}));
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

Scale force_scale(const std::string& quoted, const std::vector<double>& values) {
  const double most = largest(values);
  const double least =
      values.empty() ? 0.0 : std::abs(*std::min_element(values.begin(), values.end()));
  if (most <= 1.0) {
    return {quoted, Confidence::kLikely, "the values lie within [-1, 1], as forces over F_max do"};
  }
  if (most <= 100.0) return {quoted + "/100", Confidence::kUnsure, "the values look like percent"};
  if (most <= 255.0)
    return {quoted + "/255", Confidence::kUnsure, "the values look like 8-bit PWM"};
  if (least >= 800.0 && most <= 2200.0) {
    return {fmt::format("({} - 1500)/500", quoted), Confidence::kUnsure,
            "the values look like servo pulses in us, 1500 at rest"};
  }
  return {fmt::format("{}/{:.4g}", quoted, most), Confidence::kUnsure,
          fmt::format("full scale is not known; the largest value here is {:.4g}", most)};
}

Scale scale_of(const std::string& quoted, const Words& words, Dimension dimension,
               const std::vector<double>& values) {
  if (auto unit = by_unit_in_name(quoted, words, dimension)) return *std::move(unit);
  if (dimension == Dimension::kForce) return force_scale(quoted, values);
  if (dimension == Dimension::kGeographic) {
    return {quoted, Confidence::kLikely, "positions on the Earth are given in degrees"};
  }
  const double to_asked = dimension == Dimension::kAngle ? degrees(1.0) : 1.0;
  if (is_si_by_convention(words)) {
    return {times(quoted, to_asked), Confidence::kLikely, "such messages are in SI units"};
  }
  if (dimension == Dimension::kAngle && largest(values) > 2.0 * pi<double>()) {
    return {
        quoted, Confidence::kLikely,
        fmt::format("the values reach {:.4g}, beyond a turn in radians: degrees", largest(values))};
  }
  return {times(quoted, 1.0), Confidence::kUnsure,
          "the name says no unit, and the values fit several"};
}

/// The name as it stands in an expression.
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

/// The heading from the quaternion of one message, where all four numbers are there.
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
                       Confidence::kLikely, "the turn about the vertical of this quaternion"});
  }
}

void add_time(const FileSample& sample, std::vector<ColumnGuess>& guesses) {
  const auto time = find_time(sample.names, sample.texts);
  if (!time) {
    guesses.push_back({std::string(kTimeName), "", Confidence::kUnsure, time.error()});
  } else if (*time) {
    guesses.push_back({std::string(kTimeName), (*time)->expression, Confidence::kLikely,
                       (*time)->meaning + "; it is taken without a mapping as well"});
  }
}

/// Where two columns fit as well, neither is likely.
void settle(std::vector<ColumnGuess>& guesses) {
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

}  // namespace

std::vector<ColumnGuess> guess_columns(const FileSample& sample) {
  std::vector<ColumnGuess> all;
  std::vector<ColumnGuess> quaternions;
  add_quaternions(sample, quaternions);
  for (const CsvColumn& column : columns_of(TrialKind::kLog)) {
    std::vector<ColumnGuess> guesses;
    for (std::size_t i = 0; i < sample.names.size(); ++i) {
      const std::string& name = sample.names[i];
      if (name == column.name) {
        guesses.push_back(
            {column.name, name, Confidence::kSure, "it has this name", first_of(sample.values[i])});
        continue;
      }
      const Words words = words_of(name);
      const auto rule = std::find_if(rules().begin(), rules().end(), [&](const Rule& one) {
        return one.column == column.name && fits(one, words);
      });
      if (rule == rules().end()) continue;
      Scale scale = scale_of(quoted(name), words, rule->dimension, sample.values[i]);
      guesses.push_back({column.name, std::move(scale.expression), scale.confidence,
                         std::move(scale.why), first_of(sample.values[i])});
    }
    if (column.name == "heading_deg") {
      guesses.insert(guesses.end(), quaternions.begin(), quaternions.end());
    }
    if (column.name == kTimeName && guesses.empty()) add_time(sample, guesses);
    settle(guesses);
    all.insert(all.end(), guesses.begin(), guesses.end());
  }
  return all;
}

}  // namespace awmr
