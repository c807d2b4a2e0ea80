#include "awmr/trials/column_words.h"

#include <algorithm>
#include <cctype>

#include "awmr/core/units.h"

namespace awmr {

const std::set<std::string> kClockWords{"t",     "time",    "timestamp", "stamp",
                                        "clock", "elapsed", "duration"};
namespace {

/// A name fits `column` if it has a word of each set in `all` and no word of `none`.
struct Rule {
  const char* column;
  std::vector<std::set<std::string>> all;
  std::set<std::string> none;
  Dimension dimension;
};

const std::set<std::string> kThrustWords{"force",  "duty",   "pwm",   "throttle", "thrust", "motor",
                                         "effort", "torque", "power", "volts",    "voltage"};
const std::set<std::string> kSteerWords{"steer", "steering", "delta"};
const std::set<std::string> kSideWords{"left", "l", "right", "r"};
const std::set<std::string> kSpeedWords{"speed", "velocity", "vel", "v", "vx", "spd", "linear"};

std::vector<Rule> log_rules() {
  static const std::set<std::string> kCommand{"cmd",    "command", "setpoint",  "sp",  "desired",
                                              "target", "ref",     "reference", "pwm", "pulse"};
  static const std::set<std::string> kAcceleration{"acc",  "accel", "acceleration",
                                                   "jerk", "time",  "covariance"};
  static const std::set<std::string> kNoPosition{
      "orientation", "linear", "angular", "velocity", "vel", "gyr", "gyro", "mag", "q"};
  std::vector<Rule> rules{
      {"force_left", {{"left", "l"}, kThrustWords}, {"speed", "vel", "rpm"}, Dimension::kForce},
      {"force_right", {{"right", "r"}, kThrustWords}, {"speed", "vel", "rpm"}, Dimension::kForce},
      {"x_m", {{"x", "px", "east"}}, kNoPosition, Dimension::kLength},
      {"y_m", {{"y", "py", "north"}}, kNoPosition, Dimension::kLength},
      {"heading_deg",
       {{"heading", "yaw", "psi", "course", "hdg", "compass", "theta"}},
       {"rate", "speed", "dot", "gyr", "gyro"},
       Dimension::kAngle},
      {"speed_mps",
       {kSpeedWords},
       {"y",  "z",  "vy",  "vz",    "angular", "yaw", "left",    "right", "fl",  "fr",
        "rl", "rr", "rpm", "motor", "angle",   "tau", "battery", "batt",  "bat", "supply"},
       Dimension::kSpeed},
      {"sway_mps", {{"vy", "sway"}}, {}, Dimension::kSpeed},
      {"sway_mps", {{"velocity", "vel", "linear"}, {"y"}}, {"angular"}, Dimension::kSpeed},
      {"yaw_rate_radps", {{"yawrate", "omega", "wz", "gz"}}, {}, Dimension::kAngularRate},
      {"yaw_rate_radps", {{"yaw"}, {"rate", "speed", "dot"}}, {}, Dimension::kAngularRate},
      {"yaw_rate_radps", {{"gyr", "gyro", "angular"}, {"z"}}, {}, Dimension::kAngularRate},
      {"yaw_rate_radps", {{"gyr", "gyro"}}, {"x", "y", "z", "temp"}, Dimension::kAngularRate},
      {"steering_deg", {kSteerWords}, kCommand, Dimension::kAngle},
      {"steering_cmd_deg", {kSteerWords, kCommand}, {}, Dimension::kAngle},
      // A column named "servo" is the command of the steering servo, unless its name also has one
      // of the words feedback, measured, actual.
      {"steering_cmd_deg", {{"servo"}}, {"feedback", "measured", "actual"}, Dimension::kAngle},
      {"latitude_deg", {{"lat", "latitude"}}, {}, Dimension::kGeographic},
      {"longitude_deg", {{"lon", "lng", "long", "longitude"}}, {}, Dimension::kGeographic}};
  // A name with a word for an acceleration, a time or a covariance fits none of these columns.
  for (Rule& rule : rules) rule.none.insert(kAcceleration.begin(), kAcceleration.end());
  return rules;
}

/// Rules for tables with one run per row.
std::vector<Rule> table_rules() {
  static const std::set<std::string> kInitial{"initial", "start", "from", "v0", "u0"};
  static const std::set<std::string> kStop{"stop", "stopping", "rest"};
  static const std::set<std::string> kTurn{"yaw", "turn", "turning", "angular", "gyro"};
  std::set<std::string> no_wheel_speed = kSideWords;
  no_wheel_speed.insert(kTurn.begin(), kTurn.end());
  std::set<std::string> not_one_speed = no_wheel_speed;
  not_one_speed.insert(kInitial.begin(), kInitial.end());
  return {
      {"wheel_force", {kThrustWords}, kSideWords, Dimension::kForce},
      {"force_left", {{"left", "l"}, kThrustWords}, {}, Dimension::kForce},
      {"force_right", {{"right", "r"}, kThrustWords}, {}, Dimension::kForce},
      {"speed_mps", {kSpeedWords}, not_one_speed, Dimension::kSpeed},
      {"initial_speed_mps", {kSpeedWords, kInitial}, no_wheel_speed, Dimension::kSpeed},
      {"distance_m", {{"distance", "dist", "length", "way"}}, {}, Dimension::kLength},
      {"elapsed_s", {kClockWords}, kStop, Dimension::kTime},
      {"stop_time_s", {kStop}, {"distance", "speed"}, Dimension::kTime},
      {"t_s", {kClockWords}, kStop, Dimension::kTime},
      {"turns", {{"turns", "laps", "circles", "rounds", "revolutions"}}, {}, Dimension::kCount},
      {"steering_deg", {{"steer", "steering", "delta", "servo", "angle"}}, {}, Dimension::kAngle},
      {"yaw_rate_radps", {{"yawrate", "omega", "wz", "gyro"}}, {}, Dimension::kAngularRate},
      {"yaw_rate_radps", {{"yaw", "turning"}, {"rate", "speed"}}, {}, Dimension::kAngularRate}};
}

const std::vector<Rule>& rules_of(TrialKind kind) {
  static const std::vector<Rule> kLog = log_rules();
  static const std::vector<Rule> kTable = table_rules();
  return kind == TrialKind::kLog ? kLog : kTable;
}

bool fits(const Rule& rule, const Words& words) {
  return !has_any(words, rule.none) &&
         std::all_of(rule.all.begin(), rule.all.end(),
                     [&](const std::set<std::string>& any) { return has_any(words, any); });
}

struct Unit {
  Dimension dimension;
  std::vector<std::string_view> spellings;
  double factor;
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
      {Dimension::kTime, {"s", "sec", "secs", "seconds"}, 1.0},
      {Dimension::kTime, {"ms", "msec", "millis", "milliseconds"}, 0.001},
      {Dimension::kTime, {"us", "usec", "micros", "microseconds"}, 1e-6},
      {Dimension::kTime, {"min", "minutes"}, 60.0},
      {Dimension::kForce, {"percent", "pct"}, 0.01}};
  return kUnits;
}

/// Splits a word that names speed and side together: vl and vr, vleft and vright.
Words with_side_apart(const Words& words) {
  static const std::set<std::string> kTogether{"vl", "vr", "vleft", "vright"};
  Words apart;
  for (const std::string& word : words) {
    if (kTogether.contains(word)) {
      apart.emplace_back("v");
      apart.push_back(word.substr(1));
    } else {
      apart.push_back(word);
    }
  }
  return apart;
}

/// True if the name is only a unit that identifies the quantity: `kmh` and `km/h` are speeds, `dps`
/// is a yaw rate.
bool is_unit_alone(const Rule& rule, const Words& words) {
  static const std::set<std::string> kOnlyOne{"speed_mps", "yaw_rate_radps", "elapsed_s", "t_s"};
  if (kOnlyOne.count(rule.column) == 0 || words.size() > 2) return false;
  const auto unit = unit_in(words, rule.dimension);
  const std::string name = words.size() == 2 ? words[0] + " " + words[1] : words[0];
  return unit && unit->spelling == name;
}

}  // namespace

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

std::optional<WheelSpeedName> wheel_speed_in(const Words& words) {
  static const std::set<std::string> kOther{
      "cmd", "command",  "setpoint", "sp",    "desired", "target",       "ref",  "reference",
      "acc", "accel",    "rpm",      "motor", "angular", "acceleration", "jerk", "pwm",
      "yaw", "throttle", "angle",    "time",  "w",       "covariance",   "tau",  "duty"};
  WheelSpeedName name{false, with_side_apart(words)};
  if (has_any(name.rest, kOther) || !has_any(name.rest, kSpeedWords)) return std::nullopt;
  if (unit_in(name.rest, Dimension::kAngularRate)) return std::nullopt;
  const auto is_side = [](const std::string& word) { return kSideWords.contains(word); };
  if (std::ranges::count_if(name.rest, is_side) != 1) return std::nullopt;
  const auto side = std::ranges::find_if(name.rest, is_side);
  name.is_left = side->front() == 'l';
  name.rest.erase(side);
  return name;
}

std::optional<NamedUnit> unit_in(const Words& words, Dimension dimension) {
  const std::string& last = words.back();
  const std::string last_two = words.size() > 1 ? words[words.size() - 2] + " " + last : last;
  for (const Unit& unit : units()) {
    if (unit.dimension != dimension) continue;
    for (const std::string_view spelling : unit.spellings) {
      if (spelling == last || spelling == last_two) return NamedUnit{spelling, unit.factor};
    }
  }
  return std::nullopt;
}

std::optional<Dimension> dimension_as(TrialKind kind, const std::string& column,
                                      const Words& words) {
  for (const Rule& rule : rules_of(kind)) {
    if (rule.column != column) continue;
    if (is_unit_alone(rule, words) || fits(rule, words)) return rule.dimension;
  }
  return std::nullopt;
}

}  // namespace awmr
