#include "awmr/tune/certificate.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>

#include "awmr/core/parallel.h"
#include "awmr/core/random.h"
#include "awmr/core/statistics/distributions.h"
#include "awmr/core/units.h"
#include "awmr/tune/objective.h"

namespace awmr {
namespace {

constexpr ParameterId kLoopParameters[] = {ParameterId::kYawAlpha, ParameterId::kYawBeta,
                                           ParameterId::kYawQuadratic, ParameterId::kInertiaNorm,
                                           ParameterId::kSteeringTimeConstant};

/// A point in the search for the worst case. Its last coordinate, in [0, 1], is the position of
/// ln(yaw rate) in the examined range: 0 is the lowest, 1 the highest rate. The coordinates before
/// it are a point of the unit ball and select the plant (ConfidenceSet::plant_at()).
using SetPoint = std::vector<double>;

/// Moves a point into the search region: its plant coordinates into the unit ball, by shortening
/// them to the surface, and its yaw-rate coordinate into [0, 1].
SetPoint inside(SetPoint point) {
  double square = 0.0;
  for (std::size_t i = 0; i + 1 < point.size(); ++i) square += point[i] * point[i];
  const double shrink = square > 1.0 ? 1.0 / std::sqrt(square) : 1.0;
  for (std::size_t i = 0; i + 1 < point.size(); ++i) point[i] *= shrink;
  point.back() = std::clamp(point.back(), 0.0, 1.0);
  return point;
}

SetPoint random_direction(std::size_t size, Random& random) {
  SetPoint direction(size);
  double square = 0.0;
  for (double& x : direction) {
    x = random.normal();
    square += x * x;
  }
  for (double& x : direction) x /= std::sqrt(square);
  return direction;
}

/// Points with which the search for the worst case begins: the centre of the unit ball, the ends of
/// its axes and the corners, each at kPlaces yaw rates; then random points in the ball and on its
/// surface.
std::vector<SetPoint> first_points(std::size_t dimension, Random& random) {
  constexpr int kPlaces = 5;
  constexpr int kRandomPoints = 500;
  std::vector<SetPoint> in_ball{SetPoint(dimension, 0.0)};
  for (std::size_t i = 0; i < dimension; ++i) {
    for (const double end : {-1.0, 1.0}) {
      in_ball.emplace_back(dimension, 0.0);
      in_ball.back()[i] = end;
    }
  }
  for (unsigned corner = 0; dimension > 1 && corner < 1U << dimension; ++corner) {
    SetPoint& point = in_ball.emplace_back(dimension, 0.0);
    for (std::size_t i = 0; i < dimension; ++i) {
      point[i] = ((corner >> i & 1U) != 0 ? 1.0 : -1.0) / std::sqrt(static_cast<double>(dimension));
    }
  }
  std::vector<SetPoint> points;
  for (const SetPoint& point : in_ball) {
    for (int i = 0; i < kPlaces; ++i) {
      points.push_back(point);
      points.back().push_back(i / (kPlaces - 1.0));
    }
  }
  for (int i = 0; i < kRandomPoints; ++i) {
    SetPoint point = random_direction(dimension, random);
    const double radius = std::pow(random.uniform(), 1.0 / (static_cast<double>(dimension) + 1.0));
    for (double& x : point) x *= i % 2 == 0 ? 1.0 : radius;
    point.push_back(random.uniform());
    points.push_back(std::move(point));
  }
  return points;
}

struct ValuedPoint {
  SetPoint point;
  double value;
};
using PointFunction = std::function<double(const SetPoint&)>;

/// Pattern search for the minimum of `value`, from the point `best`. Tries steps along the axes and
/// along as many random directions. If no step decreases the value, the step length is halved.
ValuedPoint search_by_pattern(ValuedPoint best, const PointFunction& value, Random& random) {
  constexpr double kFirstPatternStep = 0.25;
  constexpr double kLastPatternStep = 5e-4;
  const std::size_t size = best.point.size();
  for (double step = kFirstPatternStep; step > kLastPatternStep;) {
    std::vector<SetPoint> directions;
    for (std::size_t i = 0; i < size; ++i) {
      directions.emplace_back(size, 0.0);
      directions.back()[i] = 1.0;
      directions.push_back(random_direction(size, random));
    }
    bool has_fallen = false;
    for (const SetPoint& direction : directions) {
      for (const double by : {-step, step}) {
        SetPoint point = best.point;
        for (std::size_t i = 0; i < size; ++i) point[i] += by * direction[i];
        point = inside(std::move(point));
        const double there = value(point);
        if (!(there < best.value)) continue;
        best = {std::move(point), there};
        has_fallen = true;
      }
    }
    if (!has_fallen) step *= 0.5;
  }
  return best;
}

/// Returns the point with the smallest value in each orthant of the ball (all points whose
/// coordinates have the same signs). The pattern search starts from each of these points, because
/// the function can have several local minima.
std::map<unsigned, ValuedPoint> best_by_orthant(std::vector<ValuedPoint> points) {
  std::map<unsigned, ValuedPoint> best;
  for (ValuedPoint& one : points) {
    unsigned orthant = 0;
    for (std::size_t i = 0; i + 1 < one.point.size(); ++i) {
      if (one.point[i] > 0.0) orthant |= 1U << i;
    }
    const auto [place, is_new] = best.try_emplace(orthant, one);
    if (!is_new && one.value < place->second.value) place->second = std::move(one);
  }
  return best;
}

ValuedPoint least_over_set(std::size_t dimension, const PointFunction& value) {
  constexpr std::uint64_t kPatternSeed = 1;
  Random random(kPatternSeed, 0);
  std::vector<ValuedPoint> points;
  for (SetPoint& point : first_points(dimension, random)) {
    const double there = value(point);
    points.push_back({std::move(point), there});
  }
  const std::map<unsigned, ValuedPoint> starts = best_by_orthant(std::move(points));
  ValuedPoint least = starts.begin()->second;
  for (const auto& [orthant, start] : starts) {
    ValuedPoint found = search_by_pattern(start, value, random);
    if (found.value < least.value) least = std::move(found);
  }
  return least;
}

/// Returns the model's parameters on which the heading loop depends, with their values in `plant`.
std::vector<std::pair<ParameterId, double>> loop_parameters(const Model& model,
                                                            const Plant<double>& plant) {
  std::vector<std::pair<ParameterId, double>> values;
  const double all[] = {plant.yaw.alpha, plant.yaw.beta, plant.yaw.quadratic, plant.inertia_norm,
                        plant.steering_time_constant_s};
  for (std::size_t i = 0; i < std::size(all); ++i) {
    const ParameterId id = kLoopParameters[i];
    if (has(model.vehicle, id) && !is_absent_term(model, id)) values.emplace_back(id, all[i]);
  }
  return values;
}

/// Inputs that define the heading loops of certify(): a confidence set of plants, and the factors
/// of their mass.
struct CertifiedLoops {
  const Model& model;
  const ConstraintContext& context;
  const Gains<double>& gains;
  const ConfidenceSet& set;
  std::vector<double> mass_factors;

  std::optional<Plant<double>> plant_at(const SetPoint& point, double mass_factor) const {
    auto plant = set.plant_at(std::span(point).first(point.size() - 1));
    if (plant) plant->inertia_norm *= mass_factor;
    return plant;
  }
};

/// Smallest value of `measure` (damping ratio or delay margin) over the heading loops in this mode.
WorstCase worst_case(const CertifiedLoops& loops, const ModeCertificate& mode,
                     double (*measure)(const SampledHeadingLoop&)) {
  const auto rate_at = [&rates = mode.yaw_rate_radps](const SetPoint& point) {
    return rates.lo * std::pow(rates.hi / rates.lo, point.back());
  };
  WorstCase worst{.value = std::numeric_limits<double>::infinity()};
  for (const double mass_factor : loops.mass_factors) {
    const ValuedPoint least = least_over_set(loops.set.dimension(), [&](const SetPoint& point) {
      const auto plant = loops.plant_at(point, mass_factor);
      if (!plant) return std::numeric_limits<double>::infinity();
      return measure(certified_loop(loops.gains, loops.context, *plant, rate_at(point), mode.mode));
    });
    if (least.value >= worst.value && !worst.parameters.empty()) continue;
    const Plant<double> plant = loops.plant_at(least.point, mass_factor).value();
    worst = {.value = least.value,
             .yaw_rate_radps = rate_at(least.point),
             .parameters = loop_parameters(loops.model, plant)};
  }
  return worst;
}

/// The yaw rates to examine in a mode: examined_rates_radps(), and up to the highest yaw rate in
/// its runs. A run that broke off does not count.
Interval rates_in(YawMode mode, const ConstraintContext& context, std::span<const ModeScore> runs) {
  Interval rates = examined_rates_radps(context);
  for (const ModeScore& run : runs) {
    if (run.mode != mode || run.has_failed) continue;
    rates.hi = std::max(rates.hi, radians(run.metrics.yaw_rate_max_degps));
  }
  return rates;
}

}  // namespace

double Certificate::damping_min() const {
  return std::ranges::min(modes, {}, [](const ModeCertificate& m) { return m.damping.value; })
      .damping.value;
}

double Certificate::delay_margin_s() const {
  return std::ranges::min(modes, {},
                          [](const ModeCertificate& m) { return m.delay_margin_s.value; })
      .delay_margin_s.value;
}

Interval Certificate::yaw_rate_radps() const {
  Interval all = modes.front().yaw_rate_radps;
  for (const ModeCertificate& one : modes) {
    all.lo = std::min(all.lo, one.yaw_rate_radps.lo);
    all.hi = std::max(all.hi, one.yaw_rate_radps.hi);
  }
  return all;
}

Result<ConfidenceSet> ConfidenceSet::make(const Model& model) {
  ConfidenceSet set;
  AWMR_ASSIGN_OR_RETURN(set.own_, model.plant());
  if (model.covariance.parameters.empty()) return set;
  // The sampler copies the model for each plant. Without the trials, the copy is fast.
  Model bare = model;
  bare.record = {};
  AWMR_ASSIGN_OR_RETURN(set.sampler_, PlantSampler::make(bare));
  set.parameters_ = static_cast<int>(model.covariance.parameters.size());
  set.directions_ = set.sampler_->directions_of(kLoopParameters);
  set.radius_ = std::sqrt(chi_squared_quantile(kCertifiedShare, set.sampler_->rank()));
  return set;
}

std::optional<Plant<double>> ConfidenceSet::plant_at(std::span<const double> point) const {
  if (directions_.empty()) return own_;
  std::vector<double> normals(directions_.front().size(), 0.0);
  for (std::size_t j = 0; j < directions_.size(); ++j) {
    for (std::size_t i = 0; i < normals.size(); ++i) {
      normals[i] += radius_ * point[j] * directions_[j][i];
    }
  }
  return sampler_->plant_at(normals);
}

SampledHeadingLoop certified_loop(const Gains<double>& gains, const ConstraintContext& context,
                                  const Plant<double>& plant, double rate_radps, YawMode mode) {
  SampledHeadingLoop loop = heading_loop(gains, context, plant, rate_radps, mode);
  loop.motor_time_constant_s = context.motor_time_constant_s;
  loop.command_delay_s = context.latency_s;
  return loop;
}

Result<Certificate> certify(const Model& model, const ConstraintContext& context,
                            const UnmodelledVariation& open, const Gains<double>& gains,
                            std::span<const ModeScore> runs) {
  AWMR_ASSIGN_OR_RETURN(const ConfidenceSet set, ConfidenceSet::make(model));
  Certificate certificate{.parameters = set.parameters(),
                          .degrees_of_freedom = set.rank(),
                          .latency_s = context.latency_s,
                          .motor_time_constant_s = context.motor_time_constant_s,
                          .modes = {}};
  for (const YawMode mode : tuned_modes(model.vehicle, context.mode)) {
    certificate.modes.push_back({.mode = mode, .yaw_rate_radps = rates_in(mode, context, runs)});
  }
  const CertifiedLoops loops{
      .model = model,
      .context = context,
      .gains = gains,
      .set = set,
      .mass_factors = open.mass_factors.empty() ? std::vector<double>{1.0} : open.mass_factors};
  parallel_for(2 * certificate.modes.size(), 0, [&](std::size_t i) {
    ModeCertificate& one = certificate.modes[i / 2];
    if (i % 2 == 0) {
      one.damping = worst_case(loops, one, damping_ratio);
    } else {
      one.delay_margin_s = worst_case(loops, one, delay_margin_s);
    }
  });
  return certificate;
}

}  // namespace awmr
