#include "awmr/identify/logs/choice/log_terms.h"

#include <algorithm>
#include <map>
#include <utility>

#include "awmr/core/containers.h"

namespace awmr {
namespace {

using Kind = FreeQuantity::Kind;

constexpr Kind kKindsOfLogs[] = {Kind::kDelay, Kind::kForceScale, Kind::kResistanceScale,
                                 Kind::kBias};

FreeQuantity gyro_bias() { return free_term(Kind::kBias, LogChannel::kYawRate); }

/// True for a term that adds to a term of the same kind in all logs.
bool adds(Kind kind) { return kind == Kind::kDelay || kind == Kind::kBias; }

bool drives(const DrivingLog& log) {
  const auto is_force = [](double force) { return force != 0.0; };
  return std::ranges::any_of(log.force_left, is_force) ||
         std::ranges::any_of(log.force_right, is_force);
}

/// The logs of the problem but the first, by their numbers. Empty for more than kMostLogs logs.
std::map<int, const DrivingLog*> later_logs(const LogProblem& problem) {
  constexpr std::size_t kMostLogs = 12;
  std::map<int, const DrivingLog*> logs;
  for (const FitWindow& window : problem.windows) {
    logs.emplace(window.rows.log->number, window.rows.log);
  }
  if (logs.empty() || logs.size() > kMostLogs) return {};
  logs.erase(logs.begin());
  return logs;
}

/// Terms of this kind that can differ between logs and that this log can show.
std::vector<FreeQuantity> terms_of(Kind kind, const LogProblem& problem, const DrivingLog& log) {
  std::vector<FreeQuantity> terms;
  const bool is_of_commands = kind == Kind::kForceScale || kind == Kind::kDelay;
  if (is_of_commands && drives(log)) terms.push_back(free_term(kind));
  if (kind == Kind::kBias && log[LogChannel::kYawRate]) terms.push_back(gyro_bias());
  if (kind != Kind::kResistanceScale) return terms;
  for (const LogChannel axis : {LogChannel::kSpeed, LogChannel::kYawRate}) {
    const ParameterId alpha = resistance_of(axis).front();
    if (has(problem.model.quantities, alpha)) terms.push_back(free_term(kind, axis));
  }
  return terms;
}

/// Terms of this kind for all logs but the first.
std::vector<FreeQuantity> terms_of_logs(const LogProblem& problem, Kind kind) {
  std::vector<FreeQuantity> terms;
  for (const auto& [number, log] : later_logs(problem)) {
    for (const FreeQuantity& term : terms_of(kind, problem, *log)) {
      terms.push_back(in_log(term, number));
    }
  }
  return terms;
}

/// True for a parameter of the resistance whose scale is `term`.
bool is_scaled(const FreeQuantity& parameter, const FreeQuantity& term) {
  if (term.kind != Kind::kResistanceScale) return false;
  const auto scaled = resistance_of(term.channel);
  return std::ranges::any_of(scaled, [&](ParameterId id) { return parameter.is(id); });
}

}  // namespace

FreeQuantity in_log(FreeQuantity term, int number) {
  term.log = number;
  return term;
}

std::vector<FreeQuantity> further_log_terms(const LogProblem& problem) {
  std::vector<FreeQuantity> found;
  for (const Kind kind : kKindsOfLogs) {
    const auto is_of_log = [&](const FreeQuantity& q) { return q.kind == kind && q.log != 0; };
    if (std::ranges::any_of(problem.model.quantities, is_of_log)) continue;
    append(found, terms_of_logs(problem, kind));
  }
  return found;
}

std::vector<FreeQuantity> partners_of(const FreeQuantity& term, const LogProblem& problem) {
  if (term.log == 0) return {};
  std::vector<FreeQuantity> partners = terms_of_logs(problem, term.kind);
  std::erase_if(partners, [&](const FreeQuantity& other) { return other.name() == term.name(); });
  const FreeQuantity of_all = in_log(term, 0);
  if (adds(term.kind) && !has(problem.model.quantities, of_all.name())) partners.push_back(of_all);
  return partners;
}

DrivingLog without_log_terms(DrivingLog log, const LogFit& fit) {
  for (std::size_t i = 0; i < fit.quantities.size(); ++i) {
    const FreeQuantity& q = fit.quantities[i];
    if (q.log != log.number) continue;
    const double value = fit.coordinates[i];
    if (q.kind == Kind::kForceScale) {
      for (double& force : log.force_left) force *= 1.0 + value;
      for (double& force : log.force_right) force *= 1.0 + value;
    } else if (q.kind == Kind::kBias && log[q.channel]) {
      for (double& reading : log[q.channel]->value) reading -= value;
    }
  }
  return log;
}

LogFitOptions without_log_terms(LogFitOptions options) {
  std::erase_if(options.terms, [](const FreeTerm& term) { return term.quantity.log != 0; });
  return options;
}

LogFit of_single_log(LogFit fit, const DrivingLog& log) {
  for (std::size_t i = fit.quantities.size(); i-- > 0;) {
    const FreeQuantity term = fit.quantities[i];
    if (term.log == 0) continue;
    const double value = fit.coordinates[i];
    fit.remove(i);
    if (!term.acts_in(log)) continue;
    for (std::size_t k = 0; k < fit.quantities.size(); ++k) {
      const FreeQuantity& q = fit.quantities[k];
      double& x = fit.coordinates[k];
      if (term.kind == Kind::kDelay && q.is(Kind::kDelay)) x += value;
      if (is_scaled(q, term)) x = to_coordinate(q.scale, (1.0 + value) * q.value(x));
    }
  }
  return fit;
}

bool differs_by_log(const LogFit& fit, const FreeQuantity& quantity) {
  return std::ranges::any_of(fit.quantities, [&](const FreeQuantity& q) {
    return q.log != 0 &&
           (is_scaled(quantity, q) || (adds(q.kind) && in_log(q, 0).name() == quantity.name()));
  });
}

}  // namespace awmr
