#include "awmr/identify/logs/choice/model_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "awmr/core/option_text.h"
#include "awmr/identify/logs/choice/back_emf.h"
#include "awmr/identify/uncertainty/akaike.h"

namespace awmr {
namespace {

using Kind = FreeQuantity::Kind;

bool is_open(const FamilyChoice& choice) {
  return !choice.family || (!choice.requested && choice.family == Family::kPower);
}

/// Axes (surge, yaw) whose resistance family may change, because the user did not select one. Yaw
/// counts only if its resistance is estimated.
OpenAxes open_axes(const LogFitOptions& power_law, const IdentifyOptions& options) {
  return {.surge = is_open(options.surge_family),
          .yaw = is_open(options.yaw_family) && power_law.frees(ParameterId::kYawAlpha)};
}

/// Calls options.notice if the step `what` may take more than 10 s on one processor. `numbers`:
/// approximate work of the step, in the unit of Effort.
void announce(const IdentifyOptions& options, double numbers, const std::string& what) {
  constexpr double kNumbersPerSecond = 2e7;  // work (Effort) per second on a processor of 2023
  constexpr double kLong_s = 10.0;
  const double about_s = numbers / kNumbersPerSecond;
  if (!options.notice || about_s <= kLong_s) return;
  options.notice(fmt::format(
      "{} may take up to about {:.0f} s on one processor; use a part of the logs ({}) to save time",
      what, about_s, option_text("from S")));
}

/// Estimated work of the first fit, in the unit of Effort. Each evaluation of the logs integrates
/// the state, and its derivatives with respect to every free quantity and every component of the
/// initial state.
double numbers_of_first_fit(const std::vector<DrivingLog>& logs, const LogFitOptions& options) {
  constexpr double kEvaluations = 40.0;
  constexpr double kStepsOfRow = 2.0;
  constexpr double kInitialComponents = 7.0;
  double rows = 0.0;
  for (const DrivingLog& log : logs) rows += static_cast<double>(log.rows());
  const double derivatives = static_cast<double>(options.free.size()) + kInitialComponents;
  return kEvaluations * kStepsOfRow * rows * (1.0 + derivatives);
}

bool has_log_terms(const LogFit& fit) {
  return std::ranges::any_of(fit.quantities, [](const FreeQuantity& q) { return q.log != 0; });
}

/// The fit without the delays, errors and forces that it estimates for all logs, which may imitate
/// a family or back-EMF. Keeps the terms of single logs, a delay of the commands and biases. Only
/// quantities and coordinates are right.
FamilyFit without_other_terms(FamilyFit fit) {
  for (std::size_t i = fit.fit.quantities.size(); i-- > 0;) {
    const FreeQuantity& q = fit.fit.quantities[i];
    if (q.log != 0 || q.is(Kind::kParameter) || q.is(Kind::kDelay) || q.is(Kind::kBias)) continue;
    fit.fit.remove(i);
  }
  return fit;
}

/// True if both fits have the same families, and both or none estimates the back-EMF.
bool has_same_model(const FamilyFit& a, const FamilyFit& b) {
  return a.surge == b.surge && a.yaw == b.yaw &&
         a.options.frees(ParameterId::kBackEmf) == b.options.frees(ParameterId::kBackEmf);
}

/// If LogFit::relative_error is above this, the resistance family is probably wrong.
constexpr double kErrorOfModel = 1.5;

}  // namespace

void show_step(const IdentifyOptions& options, std::string_view what) {
  if (options.doing) options.doing(what);
}

LogFitOptions with_optional_coulomb(LogFitOptions power_law, const IdentifyOptions& options,
                                    Family surge, Family yaw) {
  const OpenAxes open = open_axes(power_law, options);
  if (open.surge && surge == Family::kPower) {
    power_law.optional_coulomb.push_back(ParameterId::kSurgeCoulomb);
  }
  if (open.yaw && yaw == Family::kPower) {
    power_law.optional_coulomb.push_back(ParameterId::kYawCoulomb);
  }
  return power_law;
}

/// refine() of a rough fit by likely_families(), with Coulomb friction as a candidate.
FamilyFit refined(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                  const IdentifyOptions& options, const FamilyFit& rough) {
  return refine(logs, with_optional_coulomb(power_law, options, rough.surge, rough.yaw), rough);
}

FamilyFit fit_first_family(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                           const IdentifyOptions& options, const Families& begin) {
  show_step(options, "fitting the logs");
  announce(options, numbers_of_first_fit(logs, power_law), "fitting logs of this length");
  const Family surge = options.surge_family.family.value_or(begin.surge);
  const Family yaw = options.fitted_yaw_family().family.value_or(begin.yaw);
  const OpenAxes open = open_axes(power_law, options);
  if (!open.any()) return fit_family(logs, power_law, surge, yaw);
  LogFitOptions first = with_optional_coulomb(power_law, options, surge, yaw);
  first.give_up_above = kErrorOfModel;
  const FamilyFit fit = fit_family(logs, first, surge, yaw);
  if (!fit.fit.gave_up) return fit;
  return refined(logs, power_law, options, likely_families(logs, power_law, fit, open));
}

std::vector<DrivingLog> with_measured_steering(std::vector<DrivingLog> logs) {
  for (DrivingLog& log : logs) {
    log[LogChannel::kSteering] = Measured{.value = *std::move(log.steering_command_rad),
                                          .fresh = std::vector<bool>(log.rows(), true)};
    log.steering_command_rad.reset();
  }
  return logs;
}

bool is_steering_measured(const std::vector<DrivingLog>& logs, LogFitOptions power_law,
                          const FamilyFit& first) {
  constexpr double kOfRow = 0.5;
  const auto is_command = [](const DrivingLog& log) {
    return log.steering_command_rad && !log[LogChannel::kSteering];
  };
  if (!std::ranges::all_of(logs, is_command)) return false;
  const auto lag_s = first.fit.value_of(ParameterId::kSteeringTimeConstant);
  const double late_stamps_s =
      std::max(0.0, -first.fit.value_of(Kind::kSteeringDelay).value_or(0.0));
  if (!lag_s || *lag_s - late_stamps_s > kOfRow * logs.front().median_step_s()) return false;
  LogFitOptions from = from_optimum(std::move(power_law), first);
  std::erase(from.free, ParameterId::kSteeringTimeConstant);
  std::erase_if(from.terms, [](const FreeTerm& term) {
    const Kind kind = term.quantity.kind;
    return kind == Kind::kSteeringDelay ||
           (term.quantity.is_of_linkage() && kind != Kind::kSteeringTrim);
  });
  const FamilyFit follows = fit_family(with_measured_steering(logs), from, first.surge, first.yaw);
  // A servo lag with equally late time stamps of the commands describes measured angles just as
  // well, but takes two more terms. If `first` has these terms, the model without them needs no
  // significantly lower AIC.
  const double threshold = late_stamps_s > 0.0 ? 0.0 : kFamilyAicThreshold;
  return follows.fit.usable && aic_lead(follows.fit, first.fit) > threshold;
}

Finding measured_steering_finding(const std::string& file) {
  return {file, 0, Severity::kWarning, "steering-measured",
          fmt::format("the vehicle follows steering_cmd_deg without a servo lag, so the column is "
                      "used as the measured angle. Map it by {}, or log the steering command, so "
                      "that the servo's lag can be identified",
                      option_text(R"(column 'steering_deg="steering_cmd_deg"')"))};
}

namespace {

/// Screens families and back-EMF again if `first` has found differences between the logs, which the
/// first screening did not contain, and its errors are still too large. Returns the refined fit of
/// another model, or `first` if no other model is likelier.
FamilyFit screened_again(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                         const IdentifyOptions& options, FamilyFit first) {
  const OpenAxes open = open_axes(power_law, options);
  const bool is_wrong = first.fit.usable && first.fit.relative_error > kErrorOfModel;
  const bool has_back_emf = first.options.frees(ParameterId::kBackEmf);
  if (!is_wrong || !open.any() || has_back_emf || !has_log_terms(first.fit)) return first;
  const FamilyFit again = likely_families(logs, power_law, without_other_terms(first), open);
  if (has_same_model(again, first)) return first;
  return refined(logs, power_law, options, again);
}

struct Chosen {
  BestFamily found;
  bool may_have_back_emf = false;  ///< true: the first fit indicates back-EMF
};

/// Selects the resistance families: those that the user requested, else the best ones. `first`:
/// result of fit_first_family().
Chosen choose_families(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                       const IdentifyOptions& options, FamilyFit first) {
  const OpenAxes open = open_axes(power_law, options);
  Chosen chosen{{.best = std::move(first), .others = {}, .findings = {}}};
  chosen.may_have_back_emf = suspects_back_emf(chosen.found.best.fit, power_law.candidate_terms);
  if (!open.any()) return chosen;
  // If the user gave `--family auto`, any lower AIC is enough for a family to replace the power
  // law. Else the AIC of the family has to be significantly lower.
  show_step(options, "trying families of resistance");
  const bool is_family_requested = !options.surge_family.family || !options.yaw_family.family;
  const FamilyContest contest{.open = open,
                              .lead = is_family_requested ? 0.0 : kFamilyAicThreshold,
                              .only_candidates = !is_family_requested};
  const auto contenders =
      static_cast<double>(contender_count(power_law, chosen.found.best, contest));
  announce(options,
           std::min(contenders * static_cast<double>(power_law.effort->spent()),
                    static_cast<double>(power_law.effort->left())),
           "comparing families of resistance");
  chosen.found = best_family(logs, power_law, std::move(chosen.found.best), contest);
  return chosen;
}

/// Selects the families with the back-EMF of `first`. Compares the result with a fit of the same
/// families and terms without back-EMF; empty unless shows_back_emf() is then true.
std::optional<BestFamily> with_screened_back_emf(const std::vector<DrivingLog>& logs,
                                                 LogFitOptions& power_law,
                                                 const IdentifyOptions& options,
                                                 const FamilyFit& first) {
  LogFitOptions freed = with_back_emf_as_in(first, power_law);
  FamilyFit without = fit_from(logs, power_law, first, first.surge, first.yaw);
  BestFamily with = choose_families(logs, freed, options, first).found;
  if (!shows_back_emf(with.best, without)) return std::nullopt;
  with.findings.push_back(back_emf_finding(logs.front().file, with.best, without));
  with.others.push_back(std::move(without));
  power_law = std::move(freed);
  return with;
}

/// Tests whether the motors have back-EMF: fits the best families of `ideal`, the result without
/// back-EMF, with back-EMF in addition. If this fit is significantly better, makes back-EMF a free
/// parameter of `power_law`, selects the families again, and returns the new result, with the best
/// fit of `ideal` as one of its alternatives. Otherwise returns `ideal`, with the fit with back-EMF
/// as one of its alternatives.
/// The fit with back-EMF stops early if its quick searches show no gain (with_limits_for_gain()).
BestFamily or_with_back_emf(const std::vector<DrivingLog>& logs, LogFitOptions& power_law,
                            const IdentifyOptions& options, BestFamily ideal) {
  show_step(options, "trying back-EMF of the motors");
  LogFitOptions freed = with_back_emf(power_law);
  // The limits are relative to the quick searches of a fit without back-EMF.
  const LogFitOptions limited = with_back_emf(with_limits_for_gain(ideal.best, logs, power_law));
  const FamilyFit same = fit_from(logs, limited, ideal.best, ideal.best.surge, ideal.best.yaw);
  ideal.best = searched_again(logs, power_law, std::move(ideal.best), same);
  if (!shows_back_emf(same, ideal.best)) {
    if (!same.fit.usable && !same.fit.gave_up) {
      ideal.is_out_of_time = is_over(power_law);
      ideal.findings.push_back(
          {logs.front().file, 0, Severity::kWarning, "families-not-compared",
           fmt::format("the model with back-EMF could not be fitted to these logs: {}{}",
                       same.fit.report.stop_reason,
                       ideal.is_out_of_time ? "; the intervals are withdrawn" : "")});
    }
    ideal.others.push_back(same);
    return ideal;
  }
  BestFamily braked =
      choose_families(logs, freed, options, fit_first_family(logs, freed, options)).found;
  if (!shows_back_emf(braked.best, ideal.best)) braked.best = same;
  braked.findings.push_back(back_emf_finding(logs.front().file, braked.best, ideal.best));
  braked.others.push_back(std::move(ideal.best));
  power_law = std::move(freed);
  return braked;
}

}  // namespace

BestFamily choose_model(const std::vector<DrivingLog>& logs, LogFitOptions& power_law,
                        const IdentifyOptions& options, FamilyFit first) {
  first = screened_again(logs, power_law, options, std::move(first));
  if (first.options.frees(ParameterId::kBackEmf) && !power_law.frees(ParameterId::kBackEmf)) {
    if (auto with = with_screened_back_emf(logs, power_law, options, first)) {
      return *std::move(with);
    }
    std::erase(power_law.candidate_terms, ParameterId::kBackEmf);
    first = fit_first_family(logs, power_law, options);
  }
  auto [found, may_have_back_emf] = choose_families(logs, power_law, options, std::move(first));
  if (!may_have_back_emf || found.is_out_of_time) return std::move(found);
  return or_with_back_emf(logs, power_law, options, std::move(found));
}

}  // namespace awmr
