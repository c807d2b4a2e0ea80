#include "awmr/tune/search.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <mutex>
#include <span>

#include "awmr/core/parallel.h"
#include "awmr/tune/nlopt_search.h"
#include "awmr/tune/pole_placement.h"

namespace awmr {
namespace {

/// Individuals of the evolution strategy ISRES in each generation. NLopt's default, 20 (n + 1) for
/// n gains, is too large: the default budget of evaluations would end in the first generation.
constexpr unsigned kPopulation = 40;
/// If a local search lowers the objective by at least this, the next local search begins at its
/// result. While no gains meet the constraints, their violation replaces the objective.
constexpr double kWorthwhile = 1e-4;
/// Evaluations of the local search on all drawn vehicles, if the gains from which it starts are
/// feasible on all of them.
constexpr int kFinishEvaluations = 24;
/// Factor of slowed() for the second start of the local searches.
constexpr double kSlower = 0.8;

/// Values of a point, which NLopt requests in separate calls.
class NloptCallbacks {
 public:
  virtual ~NloptCallbacks() = default;
  virtual double objective(const Point& point) = 0;
  virtual void residuals(const Point& point, std::span<double> result) = 0;
};

/// Evaluates one point at a time. Caches the last point, so that each point is evaluated once.
class OneByOne : public NloptCallbacks {
 public:
  explicit OneByOne(Problem& problem) : problem_(problem) {}
  double objective(const Point& point) override { return at(point).value(); }
  void residuals(const Point& point, std::span<double> result) override {
    std::ranges::copy(at(point).residuals, result.begin());
  }

 private:
  const Looked& at(const Point& point) {
    if (!last_ || last_->point != point) last_ = problem_.look_at(std::span(&point, 1)).front();
    return *last_;
  }

  Problem& problem_;
  std::optional<Looked> last_;
};

/// Callbacks for one generation of ISRES. For points that were evaluated before, they return the
/// known values. The points of the next generation are collected, and then the search is stopped.
/// NLopt selects all points of a generation before it needs any of their values.
class OneGeneration : public NloptCallbacks {
 public:
  OneGeneration(const std::vector<Looked>& known, nlopt_opt search)
      : known_(known), search_(search) {}
  std::vector<Point> next;

  double objective(const Point& point) override {
    if (requested_ < known_.size()) return known_[requested_++].value();
    next.push_back(point);
    if (next.size() == kPopulation) nlopt_force_stop(search_);
    return 0.0;
  }
  void residuals(const Point&, std::span<double> result) override {
    std::ranges::fill(result, 0.0);
    if (next.empty()) std::ranges::copy(known_[requested_ - 1].residuals, result.begin());
  }

 private:
  const std::vector<Looked>& known_;
  nlopt_opt search_;
  std::size_t requested_ = 0;
};

double objective_callback(unsigned dimension, const double* x, double*, void* data) {
  return static_cast<NloptCallbacks*>(data)->objective(point_at(dimension, x));
}

void constraints_callback(unsigned count, double* result, unsigned dimension, const double* x,
                          double*, void* data) {
  static_cast<NloptCallbacks*>(data)->residuals(point_at(dimension, x), {result, count});
}

std::string reason(nlopt_result code) {
  switch (code) {
    case NLOPT_MAXEVAL_REACHED:
      return "evaluation budget spent";
    case NLOPT_XTOL_REACHED:
      return "steps below 0.1 %";
    case NLOPT_ROUNDOFF_LIMITED:
      return "limited by rounding";
    default:
      return nlopt_result_to_string(code);
  }
}

nlopt_result run(nlopt_opt search, NloptCallbacks& callbacks, unsigned constraints,
                 const Point& start) {
  const std::vector<double> tolerances(constraints, 0.0);
  nlopt_set_min_objective(search, objective_callback, &callbacks);
  nlopt_add_inequality_mconstraint(search, constraints, constraints_callback, &callbacks,
                                   tolerances.data());
  Point x = start;
  double value = 0.0;
  return nlopt_optimize(search, x.data(), &value);
}

bool failed(nlopt_result code) { return code < 0 && code != NLOPT_ROUNDOFF_LIMITED; }

/// Runs ISRES by generations, to evaluate the points of a generation in parallel. NLopt requests
/// one point at a time, so this function restarts the seeded search for each generation and replays
/// the known values. The result equals that of a sequential run.
nlopt_result search_globally(Problem& problem, const TuneOptions& options, const Point& start) {
  // NLopt has one random generator per process, so global searches take turns.
  static std::mutex generator;
  const std::lock_guard<std::mutex> turn(generator);
  std::vector<Looked> known;
  while (true) {
    const Optimizer search = optimizer(NLOPT_GN_ISRES, problem.space(), options.global_evaluations);
    nlopt_set_population(search.get(), kPopulation);
    nlopt_srand(static_cast<unsigned long>((options.seed ^ (options.seed >> 32)) & 0xffffffffULL));
    OneGeneration generation(known, search.get());
    const nlopt_result code = run(search.get(), generation, problem.constraints(), start);
    if (generation.next.empty()) return code;
    for (Looked& looked : problem.look_at(generation.next)) known.push_back(std::move(looked));
  }
}

/// Returns at most kMaxHistorySteps of the steps: evenly spaced, including the first and the last.
std::vector<SearchStep> at_even_ranks(const std::vector<SearchStep>& steps) {
  if (steps.size() <= kMaxHistorySteps) return steps;
  std::vector<SearchStep> kept;
  for (std::size_t i = 0; i < kMaxHistorySteps; ++i) {
    kept.push_back(steps[i * (steps.size() - 1) / (kMaxHistorySteps - 1)]);
  }
  return kept;
}

/// Runs NLopt's LN_COBYLA from `start`, then restarts it from the best point of `problem`, each
/// time with the first step size. Stops when a run improves the objective by less than 1e-4 (while
/// no gains are feasible: improves the violation by less), or after `most_evaluations`. Returns the
/// reason for stopping. Errors (program fault): a failure of NLopt.
Result<std::string> search_locally(Problem& problem, const Gains<double>& start,
                                   int most_evaluations) {
  const int budget = problem.evaluations + most_evaluations;
  std::string stop;
  Gains<double> from = start;
  for (int searches = 1; problem.evaluations < budget; ++searches) {
    const Candidate before = problem.nearest;
    const Optimizer search = local_optimizer(problem.space(), budget - problem.evaluations);
    OneByOne callbacks(problem);
    const nlopt_result code =
        run(search.get(), callbacks, problem.constraints(), problem.space().point_of(from));
    if (failed(code)) return program_fault("NLopt's COBYLA: " + reason(code));
    stop = fmt::format("; local, {} searches: {}", searches, reason(code));
    const Candidate& after = problem.nearest;
    const double gained =
        after.feasible() ? before.objective - after.objective : before.violation - after.violation;
    const bool is_same_group = after.feasible() == before.feasible() &&
                               after.meets_constraints == before.meets_constraints;
    if (is_same_group && !(gained >= kWorthwhile)) break;
    from = after.gains;
  }
  return stop;
}

/// Stores in `result` the constraint that `problem.nearest` violates most, and its residual.
void note_broken(Problem& problem, SearchResult& result) {
  const Point nearest[] = {problem.space().point_of(problem.nearest.gains)};
  const Looked looked = problem.look_at(nearest).front();
  const auto most = std::ranges::max_element(looked.residuals);
  result.broken_most = problem.names()[static_cast<std::size_t>(most - looked.residuals.begin())];
  result.broken_by = *most;
}

void look_at_gains(Problem& problem, std::span<const Gains<double>> gains) {
  std::vector<Point> points;
  for (const Gains<double>& one : gains) points.push_back(problem.space().point_of(one));
  problem.look_at(points);
}

/// Runs search_locally() from each of `starts`, independently and in parallel, with at most
/// `most_evaluations` each. Adds the evaluations to `problem`, in the order of the starts. Returns
/// the reasons for stopping.
Result<std::string> search_from_each(Problem& problem, std::span<const Gains<double>> starts,
                                     int most_evaluations) {
  std::vector<Problem> searches(starts.size(), problem.unused());
  std::vector<Result<std::string>> stops(starts.size(), std::string());
  parallel_for(starts.size(), 0, [&](std::size_t i) {
    stops[i] = search_locally(searches[i], starts[i], most_evaluations);
  });
  std::string all;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    AWMR_ASSIGN_OR_RETURN(const std::string stop, std::move(stops[i]));
    all += stop;
    problem.add(searches[i]);
  }
  return all;
}

/// Local search on all drawn vehicles, from the best of `found` and `starts` on all vehicles.
/// `found`: the best gains on the few vehicles of `searched`. Few vehicles can favour the wrong
/// gains, above all if noise dominates the metrics. Starts that are much worse than `found` on the
/// few vehicles are left out.
Result<std::string> finish(Problem& problem, const Objective& searched, const Gains<double>& found,
                           std::span<const Gains<double>> starts, int most_evaluations) {
  constexpr double kMuchWorse = 1.25;
  look_at_gains(problem, std::span(&found, 1));
  const double most = problem.nearest.feasible() ? kMuchWorse * searched(found).objective
                                                 : std::numeric_limits<double>::infinity();
  std::vector<Gains<double>> good;
  std::ranges::copy_if(starts, std::back_inserter(good), [&](const Gains<double>& start) {
    return searched(start).objective <= most;
  });
  look_at_gains(problem, good);
  problem.simulate_all = true;
  const int budget = problem.nearest.feasible() ? std::min(kFinishEvaluations, most_evaluations)
                                                : most_evaluations;
  AWMR_ASSIGN_OR_RETURN(const std::string stop,
                        search_locally(problem, problem.nearest.gains, budget));
  return "; on all draws" + stop;
}

}  // namespace

Result<std::string> search_near(Problem& problem, int most_evaluations) {
  problem.simulate_all = true;
  const Gains<double> best = problem.nearest.gains;
  const Gains<double> starts[] = {best, slowed(best, kSlower)};
  return search_from_each(problem, starts, most_evaluations / static_cast<int>(std::size(starts)));
}

Result<SearchResult> search(const TuneOptions& options, const ConstraintContext& context,
                            const Objective& searched, const Objective& all,
                            std::span<const Gains<double>> starts) {
  Problem problem(options, context, searched);
  const nlopt_result global =
      search_globally(problem, options, problem.space().point_of(starts.front()));
  if (failed(global)) return program_fault("NLopt's ISRES: " + reason(global));
  std::string stop = "global: " + reason(global);
  const int global_evaluations = problem.evaluations;
  look_at_gains(problem, starts.subspan(1));
  AWMR_ASSIGN_OR_RETURN(const std::string local, search_near(problem, options.local_evaluations));
  stop += local;
  if (!problem.nearest.feasible()) {
    AWMR_ASSIGN_OR_RETURN(const std::string others,
                          search_from_each(problem, starts, options.local_evaluations / 2));
    stop += others;
  }
  TuneOptions quiet = options;
  quiet.progress = {};
  Problem on_all(quiet, context, all);
  const bool has_more = all.draws() > searched.draws();
  if (has_more) {
    AWMR_ASSIGN_OR_RETURN(
        const std::string finished,
        finish(on_all, searched, problem.nearest.gains, starts, options.local_evaluations));
    stop += finished;
  }
  Problem& last = has_more ? on_all : problem;
  SearchResult result{.nearest = last.nearest,
                      .evaluations = problem.evaluations + on_all.evaluations,
                      .simulated = problem.simulated + on_all.simulated,
                      .history = {.best = at_even_ranks(problem.steps),
                                  .global_evaluations = global_evaluations,
                                  .evaluations = problem.evaluations},
                      .met = problem.met,
                      .algorithm = fmt::format("NLopt GN_ISRES (population {}), then LN_COBYLA, "
                                               "over the logarithms of the gains",
                                               kPopulation),
                      .stop_reason = stop};
  if (!last.nearest.feasible()) note_broken(last, result);
  return result;
}

}  // namespace awmr
