#include <fmt/format.h>

#include <string_view>

#include "awmr/core/files/hash.h"
#include "awmr/core/text.h"
#include "awmr/core/units.h"
#include "awmr/emit/emit.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/observer_rate.h"
#include "c_text.h"
#include "macros.h"

namespace awmr {
namespace {

constexpr std::string_view kCheckMacro = R"(
/* The compiler checks these conditions, also after an edit by hand. In C, a condition that does not
   hold makes a bit-field of negative width, and the compiler's error has the condition as its name.
   ISO C does not permit a comparison of floats here, but compilers evaluate it; __extension__
   prevents the warning of -Wpedantic. */
#if defined(__cplusplus) && __cplusplus >= 201103L
#define AWMR_PARAMS_CHECK(what, condition) static_assert(condition, #what)
#elif defined(__GNUC__)
#define AWMR_PARAMS_CHECK(what, condition) \
  __extension__ struct awmr_check_##what { unsigned int what : (condition) ? 1 : -1; }
#else
#define AWMR_PARAMS_CHECK(what, condition) \
  struct awmr_check_##what { unsigned int what : (condition) ? 1 : -1; }
#endif

)";

/// The constraint T2 < T1 of tune/: the sliding surface is reached faster than the heading error
/// decays on it. A compiler checks it in the form without a division:
///   epsilon/(2 mu) < 1/lambda   is   epsilon lambda/2 < mu                      [paper (91), (95)]
constexpr std::string_view kReaching =
    R"(AWMR_PARAMS_CHECK(AWMR_T2_IS_BELOW_T1{0},
                  0.5f * AWMR_HEADING_EPSILON{0} * AWMR_HEADING_LAMBDA{0} < AWMR_HEADING_MU{0});
)";
constexpr std::string_view kReachingComment =
    R"(/* T2 = epsilon/(2 mu) < T1 = 1/lambda: the sliding surface is reached faster than the
   heading error decays on it */
)";
constexpr std::string_view kRelations =
    R"(AWMR_PARAMS_CHECK(AWMR_WHEEL_FORCE_MIN_IS_BELOW_MAX, AWMR_WHEEL_FORCE_MIN < AWMR_WHEEL_FORCE_MAX);
AWMR_PARAMS_CHECK(AWMR_STEERING_MAX_RAD_IS_BELOW_HALF_PI, AWMR_STEERING_MAX_RAD < 1.57079633f);
)";

constexpr std::string_view kObserverRelation =
    R"(AWMR_PARAMS_CHECK(AWMR_OBSERVER_DOES_NOT_SWING{0},
                  AWMR_OBSERVER_BANDWIDTH_RADPS{0} * AWMR_SAMPLE_TIME_S < 1.0f);
)";

std::string checks_text(const std::vector<Macro>& macros, const ModeGains& gains) {
  std::string text(kCheckMacro);
  for (const Macro& macro : macros) {
    if (macro.range == MacroRange::kPositive) {
      text += fmt::format("AWMR_PARAMS_CHECK({0}_IS_POSITIVE, {0} > 0.0f);\n", macro.name);
    } else if (macro.range == MacroRange::kNotNegative) {
      text += fmt::format("AWMR_PARAMS_CHECK({0}_IS_NOT_NEGATIVE, {0} >= 0.0f);\n", macro.name);
    }
  }
  text += kReachingComment;
  text += fmt::format(kReaching, "");
  for (const YawMode mode : gains.listed_modes()) {
    text += fmt::format(kReaching, mode_suffix(mode));
  }
  text += kRelations;
  if (gains.common().observer.is_on()) text += fmt::format(kObserverRelation, "");
  for (const YawMode mode : gains.listed_modes()) {
    if (gains.has_observer()) text += fmt::format(kObserverRelation, mode_suffix(mode));
  }
  return text + "#undef AWMR_PARAMS_CHECK\n";
}

/// Returns the worst cases of the heading loop in gains.json as comment lines: the smallest damping
/// ratio and delay margin of each mode. Empty if gains.json has none. For gains of another
/// model, or that were changed after tuning: a line that they were not checked.
std::string certificate_text(const EmitInputs& inputs) {
  if (inputs.has_gains_of_another_model) {
    return "   The gains were tuned with another model: stability with this model was not "
           "checked.\n";
  }
  if (inputs.has_changed_gains) {
    return "   The gains were changed after tuning: stability was not checked.\n";
  }
  const std::optional<CertifiedGains>& certificate = inputs.certificate;
  if (!certificate) return {};
  std::string text = fmt::format(
      "   Heading loop with {:g} s of latency, worst case over the model's parameters ({}):\n",
      certificate->latency_s, comment_safe(certificate->set));
  for (const CertifiedMode& one : certificate->modes) {
    text += fmt::format("     {}: damping {:.3g}, delay margin {:.3g} s\n", comment_safe(one.mode),
                        one.damping_min, one.delay_margin_s);
  }
  return text;
}

std::string intro_text(const Model& model, const EmitInputs& inputs) {
  return fmt::format(
      "/* awmr_params.h: parameters and gains of \"{}\", made by awmr {}.\n"
      "   model: {}, SHA-256 {}\n"
      "   gains: {}, SHA-256 {}\n"
      "{}   Forces are divided by F_max, the largest force of one motor, in N. */\n"
      "#ifndef AWMR_PARAMS_H\n"
      "#define AWMR_PARAMS_H\n\n",
      comment_safe(model.vehicle.name), version(), comment_safe(file_name(model)),
      comment_safe(inputs.model_sha256), comment_safe(inputs.gains_file),
      comment_safe(inputs.gains_sha256), certificate_text(inputs));
}

std::string defines_text(const std::vector<Macro>& macros, const EmitInputs& inputs) {
  std::string text;
  for (const Macro& macro : macros) {
    text += fmt::format("/* {} */\n#define {} {}\n", comment_safe(macro.comment), macro.name,
                        float_literal(macro.value));
  }
  return text +
         fmt::format(
             "/* SHA-256 of 128 lower-case hexadecimal digits: the SHA-256 of the model file, then "
             "that of the gains file */\n"
             "#define AWMR_PARAMS_SHA256 \"{}\"\n",
             params_sha256(inputs));
}

/// Checks T2 < T1 (heading law) after rounding to float32, which can make both equal. `place`:
/// place of the gains, for the error.
Status check_reaching(const HeadingGains<double>& gains, const std::string& place) {
  // The user's compiler may evaluate the product epsilon lambda in float or exactly: T2 < T1 must
  // hold in both cases.
  const float epsilon = static_cast<float>(gains.epsilon);
  const float lambda = static_cast<float>(gains.lambda);
  const float mu = static_cast<float>(gains.mu);
  const double exact = 0.5 * static_cast<double>(epsilon) * static_cast<double>(lambda);
  if (0.5F * epsilon * lambda < mu && exact < static_cast<double>(mu)) return {};
  return refusal(
      ErrorCode::kSlowReaching,
      fmt::format("T2 = epsilon/(2 mu) = {:g} s is not below T1 = 1/lambda = {:g} s in {}: the "
                  "sliding surface has to be reached faster than the error decays on it; lower "
                  "epsilon or lambda, raise mu, or tune again",
                  gains.reaching_time_constant_s(), gains.sliding_time_constant_s(), place));
}

/// Checks, after rounding to float32: F'min < F'max (wheel force), d_max < 90 deg (steering stop).
Status check_vehicle(const Model& model) {
  const Vehicle& vehicle = model.vehicle;
  std::vector<Fault> faults;
  if (!(static_cast<float>(vehicle.wheel_force.lo) < static_cast<float>(vehicle.wheel_force.hi))) {
    faults.push_back(
        {ErrorCode::kWrongOrder, file_name(model) + ":/vehicle/wheel_force",
         fmt::format("the smallest wheel force, {:g}, has to be below the largest, {:g}; "
                     "correct vehicle.json and identify again",
                     vehicle.wheel_force.lo, vehicle.wheel_force.hi)});
  }
  if (!(static_cast<float>(radians(vehicle.steering_max_deg)) < 1.57079633F)) {
    faults.push_back({ErrorCode::kOutOfRange, file_name(model) + ":/vehicle/steering/max_deg",
                      fmt::format("the steering stop, {:g} deg, has to be below 90 deg; correct "
                                  "vehicle.json and identify again",
                                  vehicle.steering_max_deg)});
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return {};
}

}  // namespace

std::string comment_safe(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (continues_character(c)) continue;
    const bool joins =
        !safe.empty() && ((safe.back() == '*' && c == '/') || (safe.back() == '/' && c == '*'));
    if (joins) safe += ' ';
    safe += c >= ' ' && c <= '~' ? c : '?';
  }
  return safe;
}

/// The float as %.9g and `f`. Nine significant digits read back to the same float. `3f` is not a C
/// literal, so a text without point or exponent gets a point. A negative value is in parentheses,
/// because an operator can stand before a macro.
std::string float_literal(double value) {
  const float rounded = static_cast<float>(value) + 0.0F;  // adding 0 turns -0 into 0
  std::string text = fmt::format("{:.9g}", static_cast<double>(rounded));
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  text += "f";
  return rounded < 0.0F ? "(" + text + ")" : text;
}

std::string params_sha256(const EmitInputs& inputs) {
  return sha256_hex(inputs.model_sha256 + inputs.gains_sha256);
}

Result<std::string> params_header(const Model& model, const ModeGains& gains,
                                  const EmitInputs& inputs) {
  AWMR_RETURN_IF_ERROR(model.plant());
  const std::vector<Macro> macros = macros_of(model, gains, inputs);
  AWMR_RETURN_IF_ERROR(check_macros(macros));
  AWMR_RETURN_IF_ERROR(check_vehicle(model));
  for (const YawMode mode : kYawModes) {
    const std::string set = pointer_of(gains, mode);
    AWMR_RETURN_IF_ERROR(
        check_reaching(gains.in(mode).heading, inputs.gains_file + (set.empty() ? "" : ":" + set)));
    AWMR_RETURN_IF_ERROR(
        check_observer_rate(gains.in(mode).observer.bandwidth_radps, model.vehicle.sample_time_s,
                            inputs.gains_file + ":" + set + "/observer/bandwidth_radps"));
  }
  return intro_text(model, inputs) + defines_text(macros, inputs) + checks_text(macros, gains) +
         "\n#endif /* AWMR_PARAMS_H */\n";
}

}  // namespace awmr
