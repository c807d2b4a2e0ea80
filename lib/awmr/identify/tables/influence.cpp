#include "awmr/identify/tables/influence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "awmr/core/index.h"

namespace awmr {
namespace {

/// A row is influential where leaving it out moves a parameter by this many standard errors.
constexpr double kInfluential = 1.0;

SteadyFit refit_without(std::size_t row, const Subject& subject, const SteadyProblem& problem,
                        bool log_linear, const SteadyFit& fit) {
  std::vector<SteadyPoint> points = subject.points;
  points.erase(points.begin() + eigen_index(row));
  if (!has_two_forces(points)) return {};
  if (log_linear) return fit_log_linear(points);
  SteadyProblem rest = problem;
  rest.points = std::move(points);
  return fit_steady(rest, fit.theta);
}

/// "surge.alpha becomes 0.3 (from 0.25), ..."; empty where nothing moves by much.
std::string what_moves(const Subject& subject, const std::vector<TransformedParameter>& coordinates,
                       const SteadyFit& without, const SteadyFit& fit) {
  std::string moved;
  for (const TransformedParameter c : coordinates) {
    const auto error = fit.std_error(c);
    if (!error || std::abs(without[c] - fit[c]) <= kInfluential * *error) continue;
    moved += fmt::format("{}{} becomes {:.4g} (from {:.4g})", moved.empty() ? "" : ", ",
                         info(parameter_of(subject, c)).name, value_from(c, without[c]),
                         value_from(c, fit[c]));
  }
  return moved;
}

}  // namespace

Influence leave_one_out(const Subject& subject, const SteadyProblem& problem, bool log_linear,
                        const SteadyFit& fit) {
  Influence influence;
  const std::vector<TransformedParameter> coordinates = coordinates_of(problem.family);
  for (std::size_t i = 0; i < subject.points.size(); ++i) {
    const SteadyFit without = refit_without(i, subject, problem, log_linear, fit);
    if (!without.usable) continue;
    LeaveOneOut entry{subject.file, subject.points[i].line, {}};
    for (const TransformedParameter c : coordinates) {
      entry.values.push_back(value_from(c, without[c]));
    }
    const std::string moved = what_moves(subject, coordinates, without, fit);
    if (!moved.empty()) {
      influence.findings.push_back({subject.file, entry.line, Severity::kNote, "influential-row",
                                    "without this run, " + moved});
    }
    influence.without.push_back(std::move(entry));
  }
  return influence;
}

bool has_two_forces(const std::vector<SteadyPoint>& points) {
  constexpr double kSame = 1e-9;
  return std::any_of(points.begin(), points.end(), [&](const SteadyPoint& p) {
    return std::abs(p.force - points.front().force) > kSame * points.front().force;
  });
}

}  // namespace awmr
