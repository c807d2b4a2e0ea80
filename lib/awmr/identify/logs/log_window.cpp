#include "awmr/identify/logs/log_window.h"

#include <ceres/jet.h>

#include <cmath>

#include "awmr/identify/ceres_solve.h"
#include "awmr/model/plant_of.h"
#include "awmr/model/steady.h"

namespace awmr {
namespace {

template <class T>
Resistance<double> plain(const Resistance<T>& law) {
  return {value_of(law.alpha), value_of(law.beta), 0.0, value_of(law.coulomb),
          value_of(law.quadratic)};
}

/// The numbers of one evaluation as T, each with its own derivative where T has them.
template <class T>
struct Unpacked {
  ParameterValues<T> values;
  T delay = T(0.0);
  bool delayed = false;
  std::array<T, kChannelCount> bias{};
  State<T> start{};
};

/// `seed(i, x)` makes the i-th number of the evaluation: coordinates, then start components.
template <class T, class Seed>
Unpacked<T> unpack(const LogModel& model, const double* coordinates, const FitWindow& window,
                   Seed seed) {
  using std::exp;
  Unpacked<T> u{};
  for (const auto& [id, held] : model.held) u.values[static_cast<std::size_t>(id)] = T(held);
  const std::size_t n = model.quantities.size();
  for (std::size_t i = 0; i < n; ++i) {
    const FreeQuantity& quantity = model.quantities[i];
    const T x = seed(i, coordinates[i]);
    const T number = quantity.logarithmic ? T(exp(x)) : x;
    switch (quantity.kind) {
      case FreeQuantity::Kind::kParameter:
        u.values[static_cast<std::size_t>(quantity.id)] = number;
        break;
      case FreeQuantity::Kind::kDelay:
        u.delay = number;
        u.delayed = true;
        break;
      case FreeQuantity::Kind::kBias:
        u.bias[static_cast<std::size_t>(quantity.channel)] = number;
        break;
    }
  }
  const State<double>& s = window.assumed;
  u.start = {T(s.x_m),   T(s.y_m),     T(s.psi_rad),     T(s.u_mps),
             T(s.v_mps), T(s.r_radps), T(s.steering_rad)};
  T State<T>::*const members[] = {&State<T>::x_m,         &State<T>::y_m,   &State<T>::psi_rad,
                                  &State<T>::u_mps,       &State<T>::v_mps, &State<T>::r_radps,
                                  &State<T>::steering_rad};
  double State<double>::*const plain_members[] = {
      &State<double>::x_m,         &State<double>::y_m,   &State<double>::psi_rad,
      &State<double>::u_mps,       &State<double>::v_mps, &State<double>::r_radps,
      &State<double>::steering_rad};
  for (std::size_t i = 0; i < model.start.size(); ++i) {
    for (std::size_t m = 0; m < 7; ++m) {
      if (model.start[i].member == plain_members[m]) {
        u.start.*members[m] = seed(n + i, window.start[i]);
      }
    }
  }
  return u;
}

/// Model + bias - measured of every sample, in order.
template <class T>
std::vector<T> raw_residuals(const LogModel& model, const Unpacked<T>& u, const FitWindow& window) {
  Plant<T> plant = plant_of(model.vehicle, u.values);
  const double h = model.longest_step_s;
  plant.surge.rest_speed = T(rest_speed(plain(plant.surge), value_of(plant.mass_norm), h));
  plant.yaw.rest_speed = T(rest_speed(plain(plant.yaw), value_of(plant.inertia_norm), h));
  std::vector<T> residuals;
  residuals.reserve(window.samples.size());
  const DrivingLog& log = *window.window.log;
  std::size_t next = 0;
  replay(*window.signals, window.window.begin, window.window.end, plant,
         u.delayed ? &u.delay : nullptr, h, u.start, [&](std::size_t row, const State<T>& state) {
           for (; next < window.samples.size() && window.samples[next].row == row; ++next) {
             const LogChannel c = window.samples[next].channel;
             residuals.push_back(channel_of(state, c) + u.bias[static_cast<std::size_t>(c)] -
                                 log[c]->value[row]);
           }
         });
  return residuals;
}

/// (e_k - phi e_{k-1}) / (sigma sqrt(1 - phi^2)),  phi = e^(-dt/tau): white for a first-order
/// process; e/sigma for the first of a channel and for white noise.
template <class T>
std::vector<T> standardised(const LogModel& model, const FitWindow& window,
                            const std::vector<T>& raw) {
  std::array<const T*, kChannelCount> previous{};
  std::vector<T> out;
  out.reserve(raw.size());
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const Sample& sample = window.samples[i];
    const ChannelNoise& noise = model.noise.at(sample.channel);
    const T*& before = previous[static_cast<std::size_t>(sample.channel)];
    const double phi =
        before && noise.correlation_s > 0.0 ? std::exp(-sample.since_s / noise.correlation_s) : 0.0;
    const double weight = sample.weight / (noise.std * std::sqrt(1.0 - phi * phi));
    out.push_back(phi > 0.0 ? T(weight * (raw[i] - phi * *before)) : T(weight * raw[i]));
    before = &raw[i];
  }
  return out;
}

double pull(const LogModel& model, const FitWindow& window, std::size_t i) {
  const StartComponent& component = model.start[i];
  return (window.start[i] - window.assumed.*(component.member)) / component.prior_std;
}

bool evaluate_values(const LogModel& model, const double* coordinates, FitWindow& window) {
  const auto u =
      unpack<double>(model, coordinates, window, [](std::size_t, double x) { return x; });
  const std::vector<double> raw = raw_residuals(model, u, window);
  const std::vector<double> out = standardised(model, window, raw);
  const auto n = static_cast<Eigen::Index>(raw.size());
  window.raw = Eigen::Map<const Eigen::VectorXd>(raw.data(), n);
  window.residuals.resize(n + static_cast<Eigen::Index>(model.start.size()));
  window.residuals.head(n) = Eigen::Map<const Eigen::VectorXd>(out.data(), n);
  for (std::size_t i = 0; i < model.start.size(); ++i) {
    window.residuals(n + static_cast<Eigen::Index>(i)) = pull(model, window, i);
  }
  return window.residuals.allFinite();
}

template <int N>
bool evaluate_jacobian(const LogModel& model, const double* coordinates, FitWindow& window) {
  using Jet = ceres::Jet<double, N>;
  const auto u = unpack<Jet>(model, coordinates, window,
                             [](std::size_t i, double x) { return Jet(x, static_cast<int>(i)); });
  const std::vector<Jet> raw = raw_residuals(model, u, window);
  const std::vector<Jet> out = standardised(model, window, raw);
  const auto samples = static_cast<Eigen::Index>(raw.size());
  const auto starts = static_cast<Eigen::Index>(model.start.size());
  const auto columns = static_cast<Eigen::Index>(model.quantities.size()) + starts;
  window.raw.resize(samples);
  window.residuals.resize(samples + starts);
  window.jacobian.resize(samples + starts, columns);
  for (Eigen::Index i = 0; i < samples; ++i) {
    const Jet& jet = out[static_cast<std::size_t>(i)];
    window.raw(i) = raw[static_cast<std::size_t>(i)].a;
    window.residuals(i) = jet.a;
    window.jacobian.row(i) = jet.v.head(columns).transpose();
  }
  window.jacobian.bottomRows(starts).setZero();
  for (Eigen::Index i = 0; i < starts; ++i) {
    const auto at = static_cast<std::size_t>(i);
    window.residuals(samples + i) = pull(model, window, at);
    window.jacobian(samples + i, columns - starts + i) = 1.0 / model.start[at].prior_std;
  }
  return window.residuals.allFinite() && window.jacobian.allFinite();
}

}  // namespace

bool evaluate(const LogModel& model, const double* coordinates, bool with_jacobian,
              FitWindow& window) {
  if (!with_jacobian) return evaluate_values(model, coordinates, window);
  const std::size_t numbers = model.quantities.size() + model.start.size();
  if (numbers <= 12) return evaluate_jacobian<12>(model, coordinates, window);
  if (numbers <= 16) return evaluate_jacobian<16>(model, coordinates, window);
  if (numbers <= 20) return evaluate_jacobian<20>(model, coordinates, window);
  // 13 parameters, a delay, 7 biases and 7 start components are the most there are.
  static_assert(kParameterCount + 1 + kChannelCount + 7 <= 28);
  return evaluate_jacobian<28>(model, coordinates, window);
}

Plant<double> plant_at(const Vehicle& vehicle, const std::map<ParameterId, double>& values) {
  ParameterValues<double> v{};
  for (const auto& [id, number] : values) v[static_cast<std::size_t>(id)] = number;
  return plant_of(vehicle, v);
}

}  // namespace awmr
