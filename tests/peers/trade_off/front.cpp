#include "peers/trade_off/front.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <limits>
#include <random>
#include <thread>

namespace awmr::peers {
namespace {

/// ln of lambda, mu/epsilon, mu, mu_s/epsilon_s, mu_s. For a vehicle with dry friction in yaw also
/// ln of two friction widths, in steering and in combined mode: the yaw rate, rad/s, below which
/// the heading law feeds this friction forward smoothly.
using Vector = std::array<double, 7>;
constexpr double kMinWidth_radps = 0.02;

Vector logarithms(const LawGains& k) {
  return {std::log(k.lambda),
          std::log(k.mu / k.epsilon),
          std::log(k.mu),
          std::log(k.speed_mu / k.speed_epsilon),
          std::log(k.speed_mu),
          std::log(k.friction_width_radps),
          std::log(combined_width_radps(k))};
}

LawGains gains_at(const Vector& x) {
  const double mu = std::exp(x[2]);
  const double speed_mu = std::exp(x[4]);
  return {std::exp(x[0]),
          mu,
          mu / std::exp(x[1]),
          speed_mu,
          speed_mu / std::exp(x[3]),
          std::max(std::exp(x[5]), kMinWidth_radps),
          std::max(std::exp(x[6]), kMinWidth_radps)};
}

struct Member {
  Vector x{};
  double settling_s = std::numeric_limits<double>::infinity();
};

}  // namespace

std::vector<Trial> with_noise(const Case& one, const std::vector<Body>& bodies,
                              std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Trial> trials;
  for (const Body& body : bodies) {
    Trial trial{body, {}};
    for (const Course& course : one.courses) {
      Noise noise;
      for (std::vector<double>& channel : noise) {
        channel.resize(readings_of(course, one.vehicle));
        for (double& n : channel) n = normal(random);
      }
      trial.noise.push_back(std::move(noise));
    }
    trials.push_back(std::move(trial));
  }
  return trials;
}

Means means_of(const Case& one, const std::vector<Trial>& trials, const Controls& controls,
               double step_s) {
  Means sum;
  for (const Trial& trial : trials) {
    for (const Mode mode : one.modes) {
      for (std::size_t i = 0; i < one.courses.size(); ++i) {
        const RunFigures f = drive(trial.body, one.vehicle, one.errors, controls, mode,
                                   one.courses[i], trial.noise[i], step_s);
        sum.settling_s += f.settling_s;
        sum.variation += f.variation;
        sum.overshoot_deg += f.overshoot_deg;
        sum.steering_rms_degps += f.steering_rms_degps;
        sum.speed_itae_ms += f.speed_itae_ms;
      }
    }
  }
  const auto runs = static_cast<double>(trials.size() * one.modes.size() * one.courses.size());
  return {sum.settling_s / runs, sum.variation / runs, sum.overshoot_deg / runs,
          sum.steering_rms_degps / runs, sum.speed_itae_ms / runs};
}

LawGains least_settling(const Case& one, const std::vector<Trial>& trials, const LawGains& near,
                        FedForward fed_forward, const Means& most, const FrontOptions& options) {
  std::mt19937_64 random(options.seed);
  const Vector centre = logarithms(near);
  const std::size_t dimensions = one.model.yaw.coulomb > 0.0 ? 7 : 5;
  const auto look = [&](const Vector& x) -> Member {
    const Controls c{one.model, gains_at(x), fed_forward};
    const Means m = means_of(one, trials, c);
    // Gains that exceed the permitted control variation, overshoot or error of the speed rank behind
    // all others; the larger the excess, the lower the rank.
    const double over =
        std::max({m.variation / most.variation, m.overshoot_deg / most.overshoot_deg,
                  m.speed_itae_ms / most.speed_itae_ms});
    return {x, over > 1.0 ? 1e3 * over : m.settling_s};
  };
  const auto is_admissible = [&](const Vector& x) {
    const Controls c{one.model, gains_at(x), fed_forward};
    return excess(c, one.vehicle, one.errors, one.limit_bodies, one.limits, one.examined) <= 0.0;
  };
  const auto look_at_all = [&](const std::vector<Vector>& points, std::vector<Member>& members) {
    const std::size_t threads = std::max(1U, std::thread::hardware_concurrency());
    std::vector<Member> found(points.size());
    std::vector<std::future<void>> tasks;
    for (std::size_t t = 0; t < threads; ++t) {
      tasks.push_back(std::async(std::launch::async, [&, t] {
        for (std::size_t i = t; i < points.size(); i += threads) found[i] = look(points[i]);
      }));
    }
    for (auto& task : tasks) task.get();
    members.insert(members.end(), found.begin(), found.end());
    std::ranges::sort(members, {}, &Member::settling_s);
    if (members.size() > 6) members.resize(6);
  };
  // Speed gains are varied less, because they hardly affect the heading.
  std::vector<Vector> points{centre};
  for (int tries = 0; tries < 400 * options.scattered &&
                      points.size() < static_cast<std::size_t>(options.scattered);
       ++tries) {
    Vector x = centre;
    for (std::size_t i = 0; i < dimensions; ++i) {
      const double width = std::log(i < 3 ? 30.0 : 5.0);
      x[i] += std::uniform_real_distribution<double>(-width, width)(random);
    }
    if (is_admissible(x)) points.push_back(x);
  }
  std::vector<Member> best;
  look_at_all(points, best);
  double width = 0.4;
  std::normal_distribution<double> normal;
  for (int round = 0; round < options.rounds; ++round, width *= 0.7) {
    points.clear();
    for (int tries = 0; tries < 50 * options.offspring &&
                        points.size() < static_cast<std::size_t>(options.offspring);
         ++tries) {
      Vector x = best[static_cast<std::size_t>(tries) % best.size()].x;
      for (std::size_t i = 0; i < dimensions; ++i) x[i] += width * normal(random);
      if (is_admissible(x)) points.push_back(x);
    }
    look_at_all(points, best);
  }
  return gains_at(best.front().x);
}

}  // namespace awmr::peers
