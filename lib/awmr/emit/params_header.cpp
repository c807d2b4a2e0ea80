#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "awmr/core/hash.h"
#include "awmr/core/units.h"
#include "awmr/emit/emit.h"

namespace awmr {
namespace {

struct Define {
  std::string name;
  double value;
  std::string comment;
  bool positive = true;
};

/// A float literal that reads back to the same float: %.9g and `f`, always with a point or
/// exponent.
std::string float_literal(double value) {
  std::string text = fmt::format("{:.9g}", static_cast<double>(static_cast<float>(value)));
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text + "f";
}

bool is_float(double value) {
  const double magnitude = std::abs(value);
  using Limits = std::numeric_limits<float>;
  return magnitude == 0.0 || (magnitude >= static_cast<double>(Limits::min()) &&
                              magnitude <= static_cast<double>(Limits::max()));
}

std::string origin(const Estimate& estimate) {
  const char* source = estimate.source == Source::kGiven     ? "given"
                       : estimate.source == Source::kDerived ? "derived"
                                                             : "fitted";
  std::string text = fmt::format("{}, {}", source, estimate.method);
  if (estimate.std_error) text += fmt::format(", std error {:.2g}", *estimate.std_error);
  return text;
}

/// A comment may not end early: file contents reach it through names.
std::string comment_safe(std::string text) {
  for (std::size_t at = 0; (at = text.find("*/", at)) != std::string::npos;)
    text.replace(at, 2, "* /");
  return text;
}

std::vector<Define> defines_of(const Model& model, const Gains<double>& gains) {
  const auto parameter = [&](const char* name, ParameterId id, bool positive) {
    const ParameterInfo& p = info(id);
    return Define{name, *model[id].value,
                  fmt::format("{}, {}: {}; {}", p.symbol, p.unit, p.meaning, origin(model[id])),
                  positive};
  };
  const Vehicle& v = model.vehicle;
  return {
      parameter("AWMR_SURGE_ALPHA", ParameterId::kSurgeAlpha, true),
      parameter("AWMR_SURGE_BETA", ParameterId::kSurgeBeta, false),
      parameter("AWMR_YAW_ALPHA", ParameterId::kYawAlpha, true),
      parameter("AWMR_YAW_BETA", ParameterId::kYawBeta, false),
      parameter("AWMR_SWAY_ALPHA", ParameterId::kSwayAlpha, false),
      parameter("AWMR_MASS_NORM", ParameterId::kMassNorm, true),
      parameter("AWMR_INERTIA_NORM", ParameterId::kInertiaNorm, true),
      {"AWMR_FRONT_AXLE_M", v.front_axle_m, "l_f, m: centre of gravity to front axle; vehicle"},
      {"AWMR_HALF_TRACK_M", v.half_track_m, "d, m: centre line to a wheel; vehicle"},
      {"AWMR_WHEEL_FORCE_MIN", v.wheel_force.lo, "F'min of one wheel over F_max; vehicle", false},
      {"AWMR_WHEEL_FORCE_MAX", v.wheel_force.hi, "F'max of one wheel over F_max; vehicle"},
      {"AWMR_STEERING_MAX_RAD", radians(v.steering_max_deg),
       "stop of the front wheels, rad; vehicle"},
      {"AWMR_SAMPLE_TIME_S", v.sample_time_s, "T_s, s; vehicle"},
      {"AWMR_HEADING_LAMBDA", gains.heading.lambda, "lambda, 1/s; gains"},
      {"AWMR_HEADING_MU", gains.heading.mu, "mu, rad/s^2; gains"},
      {"AWMR_HEADING_EPSILON", gains.heading.epsilon, "epsilon, rad/s; gains"},
      {"AWMR_SPEED_MU", gains.speed.mu, "mu_s, m/s^2; gains"},
      {"AWMR_SPEED_EPSILON", gains.speed.epsilon, "epsilon_s, m/s; gains"},
  };
}

/// The compiler's own checks, in a form that C89 accepts without a complaint: floating constants
/// may not size an array there, but a bit-field's width is folded, and `__extension__` keeps
/// -Wpedantic quiet about it.
std::string checks(const std::vector<Define>& defines) {
  std::string text =
      "/* Checked by the compiler, after an edit by hand too: a condition that does not hold makes "
      "a\n"
      "   bit-field of negative width. */\n"
      "#if defined(__GNUC__)\n"
      "#define AWMR_CHECK_EXTENSION __extension__\n"
      "#else\n"
      "#define AWMR_CHECK_EXTENSION\n"
      "#endif\n"
      "#define AWMR_CHECK(name, condition) \\\n"
      "  AWMR_CHECK_EXTENSION struct awmr_check_##name { unsigned int holds : (condition) ? 1 : "
      "-1; }\n\n"
      "/* T2 < T1: epsilon/(2 mu) < 1/lambda */\n"
      "AWMR_CHECK(reaching_is_faster_than_sliding,\n"
      "           AWMR_HEADING_EPSILON * AWMR_HEADING_LAMBDA < 2.0f * AWMR_HEADING_MU);\n"
      "AWMR_CHECK(wheel_force_range, AWMR_WHEEL_FORCE_MIN < AWMR_WHEEL_FORCE_MAX);\n";
  for (const Define& define : defines) {
    if (define.positive) {
      text += fmt::format("AWMR_CHECK({}_is_positive, {} > 0.0f);\n", define.name.substr(5),
                          define.name);
    }
  }
  return text;
}

Status check_values(const std::vector<Define>& defines, const Gains<double>& gains,
                    const std::string& model_file) {
  std::vector<Fault> faults;
  for (const Define& define : defines) {
    if (!is_float(define.value)) {
      faults.push_back({model_file, fmt::format("{} = {:g} is not a normal 32-bit float",
                                                define.name, define.value)});
    } else if (define.positive && !(define.value > 0.0)) {
      faults.push_back(
          {model_file, fmt::format("{} = {:g} has to be above 0", define.name, define.value)});
    }
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  const double t1_s = gains.heading.sliding_time_constant_s();
  const double t2_s = gains.heading.reaching_time_constant_s();
  if (t2_s >= t1_s) {
    return refusal(
        fmt::format("T2 = {:.4g} s is not below T1 = {:.4g} s: the reaching phase has to be the "
                    "faster; tune again",
                    t2_s, t1_s));
  }
  return {};
}

}  // namespace

Result<std::string> params_header(const Model& model, const Gains<double>& gains,
                                  const EmitInputs& inputs) {
  if (const auto plant = model.plant(inputs.model_file); !plant) {
    return tl::unexpected(plant.error());
  }
  const std::vector<Define> defines = defines_of(model, gains);
  if (const auto checked = check_values(defines, gains, inputs.model_file); !checked) {
    return tl::unexpected(checked.error());
  }
  std::string text = fmt::format(
      "/* awmr_params.h: parameters and gains of \"{}\", made by awmr {}.\n"
      "   Forces are over F_max, the largest force of one motor. Make it again rather than edit "
      "it. */\n"
      "#ifndef AWMR_PARAMS_H\n#define AWMR_PARAMS_H\n\n",
      comment_safe(model.vehicle.name), version());
  for (const Define& define : defines) {
    text += fmt::format("/* {} */\n#define {} {}\n", comment_safe(define.comment), define.name,
                        define.value < 0.0 ? fmt::format("({})", float_literal(define.value))
                                           : float_literal(define.value));
  }
  text += fmt::format(
      "/* SHA-256 of the model's SHA-256 followed by the gains', both in hexadecimal */\n"
      "#define AWMR_PARAMS_SHA256 \"{}\"\n\n",
      sha256_hex(inputs.model_sha256 + inputs.gains_sha256));
  return text + checks(defines) + "\n#endif /* AWMR_PARAMS_H */\n";
}

}  // namespace awmr
