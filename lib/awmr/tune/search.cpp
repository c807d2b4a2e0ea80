#include "awmr/tune/search.h"

#include <fmt/format.h>
#include <nlopt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>

#include "awmr/core/random.h"

namespace awmr {
namespace {

constexpr unsigned kDimension = 5;
/// ISRES individuals per generation. NLopt's default of 20 (n + 1) would spend the budget on two
/// generations.
constexpr unsigned kPopulation = 40;
/// First step and smallest step of the local search, in ln(gain): 20 % and 0.1 %.
constexpr double kFirstStep = 0.2;
constexpr double kLastStep = 1e-3;
/// A local search that improves the objective by less is the last one.
constexpr double kWorthwhile = 1e-4;
/// What the global search sees for a point that breaks a constraint: worse than any objective that
/// matters.
constexpr double kRejected = 1e3;
/// Starts of the feasibility search beside the baseline and the middle of the bounds, and steps of
/// each.
constexpr int kRandomStarts = 30;
constexpr int kStartEvaluations = 300;

using Point = std::array<double, kDimension>;
using Optimizer = std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)>;

std::array<Interval, kDimension> intervals(const GainBounds& b) {
  return {b.lambda, b.mu, b.epsilon, b.speed_mu, b.speed_epsilon};
}

/// exp of the logarithms, held inside the bounds against rounding.
Gains<double> gains_at(const double* x, const GainBounds& bounds) {
  const auto range = intervals(bounds);
  Point g{};
  for (unsigned i = 0; i < kDimension; ++i) {
    g[i] = std::clamp(std::exp(x[i]), range[i].lo, range[i].hi);
  }
  return {{g[0], g[1], g[2]}, {g[3], g[4]}};
}

Point lower(const GainBounds& bounds) {
  Point x{};
  for (unsigned i = 0; i < kDimension; ++i) x[i] = std::log(intervals(bounds)[i].lo);
  return x;
}

Point upper(const GainBounds& bounds) {
  Point x{};
  for (unsigned i = 0; i < kDimension; ++i) x[i] = std::log(intervals(bounds)[i].hi);
  return x;
}

Point point_of(const Gains<double>& g, const GainBounds& bounds) {
  Point x{std::log(g.heading.lambda), std::log(g.heading.mu), std::log(g.heading.epsilon),
          std::log(g.speed.mu), std::log(g.speed.epsilon)};
  for (unsigned i = 0; i < kDimension; ++i) {
    x[i] = std::clamp(x[i], lower(bounds)[i], upper(bounds)[i]);
  }
  return x;
}

Optimizer optimizer(nlopt_algorithm algorithm, const GainBounds& bounds, int evaluations) {
  Optimizer opt(nlopt_create(algorithm, kDimension), &nlopt_destroy);
  nlopt_set_lower_bounds(opt.get(), lower(bounds).data());
  nlopt_set_upper_bounds(opt.get(), upper(bounds).data());
  nlopt_set_maxeval(opt.get(), evaluations);
  return opt;
}

/// What NLopt's callbacks share: the problem, the last point, the best one. NLopt asks for the
/// objective and for the constraints of a point one after the other, and hands on a single pointer:
/// the last point is kept so that it is simulated once.
class Problem {
 public:
  Problem(const TuneOptions& options, const ConstraintContext& context, const Objective& objective)
      : options_(options), context_(context), objective_(objective) {
    nearest.violation = std::numeric_limits<double>::infinity();
  }

  /// Number of constraints: the required ones, then one per mode.
  unsigned constraints() const { return constraints_; }
  bool simulate_all = false;  ///< also points that break a constraint, as a local model needs
  Candidate nearest;
  int evaluations = 0;
  int simulated = 0;
  std::vector<SearchStep> steps;

  double objective(const double* x) {
    look_at(x);
    ++evaluations;
    if (options_.progress) {
      options_.progress(static_cast<std::size_t>(evaluations),
                        static_cast<std::size_t>(options_.global_evaluations) +
                            static_cast<std::size_t>(options_.local_evaluations));
    }
    return last_.simulated && last_.valid ? last_.objective : kRejected + last_.violation;
  }

  void residuals(const double* x, double* result) {
    look_at(x);
    std::copy(residuals_.begin(), residuals_.end(), result);
  }

 private:
  void look_at(const double* x);

  const TuneOptions& options_;
  const ConstraintContext& context_;
  const Objective& objective_;
  /// Those of the runs: a mode's objective, and unless nominal its activity.
  std::size_t simulated_constraints_ =
      (options_.nominal ? 1 : 2) * objective_.baseline().mode_objective.size();
  unsigned constraints_ = static_cast<unsigned>(
      awmr::residuals(constraints_of(Gains<double>{{1.0, 1.0, 1.0}, {1.0, 1.0}}, context_)).size() +
      simulated_constraints_);
  std::optional<Point> point_;
  Candidate last_;
  std::vector<double> residuals_;
};

void Problem::look_at(const double* x) {
  Point point{};
  std::copy(x, x + kDimension, point.begin());
  if (point_ == point) return;
  point_ = point;
  last_ = Candidate{.gains = gains_at(x, options_.bounds)};
  residuals_ = awmr::residuals(constraints_of(last_.gains, context_));
  last_.violation = *std::max_element(residuals_.begin(), residuals_.end());
  residuals_.resize(constraints_, 0.0);
  if (last_.violation <= 0.0 || simulate_all) {
    const Evaluation e = objective_(last_.gains);
    ++simulated;
    last_.simulated = true;
    last_.valid = e.valid;
    last_.objective = e.objective;
    const std::size_t modes = e.mode_objective.size();
    const std::size_t first = residuals_.size() - simulated_constraints_;
    for (std::size_t i = 0; i < simulated_constraints_; ++i) {
      const double broken = i < modes ? e.mode_objective[i] - 1.0
                                      : e.mode_activity[i - modes] / options_.activity_max - 1.0;
      residuals_[first + i] = e.valid ? broken : 1.0;
      last_.violation = std::max(last_.violation, residuals_[first + i]);
    }
  }
  if (!better(last_, nearest)) return;
  nearest = last_;
  if (!nearest.feasible()) return;
  // Asked for their constraints alone, points belong to the evaluation that comes next.
  if (!steps.empty() && steps.back().evaluation > evaluations) steps.pop_back();
  steps.push_back({evaluations + 1, nearest.objective});
}

double objective_callback(unsigned, const double* x, double*, void* data) {
  return static_cast<Problem*>(data)->objective(x);
}

void constraints_callback(unsigned, double* result, unsigned, const double* x, double*,
                          void* data) {
  static_cast<Problem*>(data)->residuals(x, result);
}

/// Why NLopt stopped, in words.
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

nlopt_result run(nlopt_algorithm algorithm, Problem& problem, const TuneOptions& options,
                 const Point& start, int evaluations) {
  Optimizer opt = optimizer(algorithm, options.bounds, evaluations);
  const std::vector<double> tolerances(problem.constraints(), 0.0);
  nlopt_set_min_objective(opt.get(), objective_callback, &problem);
  nlopt_add_inequality_mconstraint(opt.get(), problem.constraints(), constraints_callback, &problem,
                                   tolerances.data());
  if (algorithm == NLOPT_GN_ISRES) {
    nlopt_set_population(opt.get(), kPopulation);
    nlopt_srand(static_cast<unsigned long>((options.seed ^ (options.seed >> 32)) & 0xffffffffULL));
  } else {
    nlopt_set_initial_step1(opt.get(), kFirstStep);
    nlopt_set_xtol_abs1(opt.get(), kLastStep);
  }
  Point x = start;
  double value = 0.0;
  return nlopt_optimize(opt.get(), x.data(), &value);
}

bool failed(nlopt_result code) { return code < 0 && code != NLOPT_ROUNDOFF_LIMITED; }

/// COBYLA again and again from the best point met, each time with the first step anew, until a
/// search gains less than kWorthwhile or the budget is spent. Returns why it stopped.
Result<std::string> search_locally(Problem& problem, const TuneOptions& options) {
  const int budget = problem.evaluations + options.local_evaluations;
  std::string stop;
  for (int searches = 1; problem.evaluations < budget; ++searches) {
    const Candidate before = problem.nearest;
    const nlopt_result code =
        run(NLOPT_LN_COBYLA, problem, options, point_of(before.gains, options.bounds),
            budget - problem.evaluations);
    if (failed(code)) return program_fault("NLopt's COBYLA: " + reason(code));
    stop = fmt::format("; local, {} searches: {}", searches, reason(code));
    const Candidate& after = problem.nearest;
    if (after.feasible() == before.feasible() && before.objective - after.objective < kWorthwhile) {
      break;
    }
  }
  return stop;
}

/// What the callback of feasible_start() shares: it looks at the largest residual alone.
struct Feasibility {
  const TuneOptions& options;
  const ConstraintContext& context;
  Candidate best;

  double look_at(const double* x) {
    Candidate c{.gains = gains_at(x, options.bounds)};
    const std::vector<double> r = residuals(constraints_of(c.gains, context));
    c.violation = *std::max_element(r.begin(), r.end());
    if (better(c, best)) best = c;
    return c.violation;
  }
};

double feasibility_callback(unsigned, const double* x, double*, void* data) {
  return static_cast<Feasibility*>(data)->look_at(x);
}

/// The baseline, the middle of the bounds, then random ones.
Point start_point(int index, const TuneOptions& options, const Gains<double>& baseline) {
  if (index == 0) return point_of(baseline, options.bounds);
  const Point lo = lower(options.bounds);
  const Point hi = upper(options.bounds);
  Random random(options.seed, static_cast<std::uint64_t>(index));
  Point x{};
  for (unsigned i = 0; i < kDimension; ++i) {
    x[i] = lo[i] + (hi[i] - lo[i]) * (index == 1 ? 0.5 : random.uniform());
  }
  return x;
}

/// At most kMostHistorySteps of the steps.
std::vector<SearchStep> at_even_ranks(const std::vector<SearchStep>& steps) {
  if (steps.size() <= kMostHistorySteps) return steps;
  std::vector<SearchStep> kept;
  for (std::size_t i = 0; i < kMostHistorySteps; ++i) {
    kept.push_back(steps[i * (steps.size() - 1) / (kMostHistorySteps - 1)]);
  }
  return kept;
}

}  // namespace

bool better(const Candidate& a, const Candidate& b) {
  if (a.feasible() != b.feasible()) return a.feasible();
  return a.feasible() ? a.objective < b.objective : a.violation < b.violation;
}

Candidate feasible_start(const TuneOptions& options, const ConstraintContext& context,
                         const Gains<double>& baseline) {
  Feasibility problem{.options = options, .context = context, .best = {}};
  problem.best.violation = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 2 + kRandomStarts && problem.best.violation > 0.0; ++i) {
    Point x = start_point(i, options, baseline);
    Optimizer opt = optimizer(NLOPT_LN_COBYLA, options.bounds, kStartEvaluations);
    nlopt_set_min_objective(opt.get(), feasibility_callback, &problem);
    nlopt_set_initial_step1(opt.get(), kFirstStep);
    nlopt_set_xtol_abs1(opt.get(), kLastStep);
    nlopt_set_stopval(opt.get(), 0.0);
    double value = 0.0;
    nlopt_optimize(opt.get(), x.data(), &value);
  }
  return problem.best;
}

Result<SearchResult> search(const TuneOptions& options, const ConstraintContext& context,
                            const Objective& objective, const Gains<double>& start) {
  Problem problem(options, context, objective);
  nlopt_result global = NLOPT_FAILURE;
  {
    // NLopt's random generator is one per process.
    static std::mutex generator;
    const std::lock_guard<std::mutex> turn(generator);
    global = run(NLOPT_GN_ISRES, problem, options, point_of(start, options.bounds),
                 options.global_evaluations);
  }
  if (failed(global)) return program_fault("NLopt's ISRES: " + reason(global));
  std::string stop = "global: " + reason(global);
  const int global_evaluations = problem.evaluations;
  problem.simulate_all = true;
  AWMR_ASSIGN_OR_RETURN(const std::string local, search_locally(problem, options));
  stop += local;
  SearchResult result{
      .best = std::nullopt,
      .nearest = problem.nearest,
      .evaluations = problem.evaluations,
      .simulated = problem.simulated,
      .history = {.best = at_even_ranks(problem.steps),
                  .global_evaluations = global_evaluations,
                  .evaluations = problem.evaluations},
      .algorithm = fmt::format("NLopt GN_ISRES (population {}), then LN_COBYLA, over "
                               "the logarithms of the gains",
                               kPopulation),
      .stop_reason = stop};
  if (problem.nearest.feasible()) result.best = problem.nearest;
  return result;
}

}  // namespace awmr
