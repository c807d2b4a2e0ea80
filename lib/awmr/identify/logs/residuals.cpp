#include "awmr/identify/logs/residuals.h"

#include <ceres/jet.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "awmr/core/index.h"
#include "awmr/identify/ceres_solve.h"
#include "awmr/identify/logs/whitener.h"
#include "awmr/model/rest.h"

namespace awmr {
namespace {

/// The numbers of one evaluation as T, each with its own derivative where T has them.
template <class T>
struct Unpacked {
  ParameterValues<T> values{};
  T delay = T(0.0);
  bool delayed = false;
  std::array<T, kChannelCount> bias{};
  std::array<std::optional<T>, kChannelCount> sensor_delay{};
  State<T> initial{};
};

/// `seed(i, x)` makes the i-th number of the evaluation: coordinates, then the initial state.
template <class T, class Seed>
Unpacked<T> unpack(const LogModel& model, const FitWindow& window, const double* coordinates,
                   const double* initial_state, Seed seed) {
  Unpacked<T> u{};
  for (std::size_t i = 0; i < kParameterCount; ++i) u.values[i] = T(model.held[i]);
  const std::size_t n = model.quantities.size();
  for (std::size_t i = 0; i < n; ++i) {
    const FreeQuantity& quantity = model.quantities[i];
    const T number = from_coordinate<T>(quantity.scale, seed(i, coordinates[i]));
    switch (quantity.kind) {
      case FreeQuantity::Kind::kParameter:
        u.values[at(quantity.id)] = number;
        break;
      case FreeQuantity::Kind::kDelay:
        u.delay = number;
        u.delayed = true;
        break;
      case FreeQuantity::Kind::kSensorDelay:
        u.sensor_delay[at(quantity.channel)] = number;
        if (quantity.channel == LogChannel::kX) u.sensor_delay[at(LogChannel::kY)] = number;
        break;
      case FreeQuantity::Kind::kBias:
        u.bias[at(quantity.channel)] = number;
        break;
    }
  }
  for (const LogChannel channel : kChannels) {
    channel_of(u.initial, channel) = T(channel_of(window.measured, channel));
  }
  for (std::size_t i = 0; i < model.initial.size(); ++i) {
    channel_of(u.initial, model.initial[i].channel) = seed(n + i, initial_state[i]);
  }
  return u;
}

/// Model + bias - measured of every sample, in order; a late sensor is compared with what was so its
/// delay before.
template <class T>
std::vector<T> raw_residuals(const LogModel& model, const Unpacked<T>& u, const FitWindow& window) {
  const double h = model.longest_step_s;
  const Plant<T> plant = resolved_at_rest(plant_of(model.vehicle, u.values), h);
  std::vector<T> residuals;
  residuals.reserve(window.samples.size());
  const DrivingLog& log = *window.rows.log;
  const bool any_late =
      std::ranges::any_of(u.sensor_delay, [](const auto& d) { return d.has_value(); });
  std::vector<State<T>> states;  // by row, where a sensor is late
  std::size_t next = 0;
  replay(*window.signals, window.rows.begin, window.rows.end, plant, u.delayed ? &u.delay : nullptr,
         h, u.initial, [&](std::size_t row, const State<T>& state) {
           if (any_late) states.push_back(state);
           for (; next < window.samples.size() && window.samples[next].row == row; ++next) {
             const LogChannel c = window.samples[next].channel;
             const std::optional<T>& late = u.sensor_delay[at(c)];
             const T is = late ? channel_of(earlier_state(*window.signals, window.rows.begin,
                                                          states, plant, *late, h),
                                            c)
                               : channel_of(state, c);
             residuals.push_back(is + u.bias[at(c)] - log[c]->value[row]);
           }
         });
  return residuals;
}

/// What is new in each residual over its standard deviation: white where the noise is as the model
/// of the channel says.
template <class T>
std::vector<T> standardised(const LogModel& model, const FitWindow& window,
                            const std::vector<T>& raw) {
  std::array<std::optional<Whitener<T>>, kChannelCount> whiteners;
  std::vector<T> out;
  out.reserve(raw.size());
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const Sample& sample = window.samples[i];
    auto& whitener = whiteners[at(sample.channel)];
    if (!whitener) whitener.emplace(model.noise.at(sample.channel));
    const auto [value, variance] = whitener->next(raw[i], sample.since_s);
    out.push_back(T((sample.weight / std::sqrt(variance)) * value));
  }
  return out;
}

/// The weak pull of a component of the initial state to what was measured.
double pull(const InitialComponent& component, const FitWindow& window, double initial) {
  return (initial - channel_of(window.measured, component.channel)) / component.prior_std;
}

WindowResiduals evaluate_values(const LogModel& model, const FitWindow& window,
                                const double* coordinates, const double* initial_state) {
  const auto u = unpack<double>(model, window, coordinates, initial_state,
                                [](std::size_t, double x) { return x; });
  const std::vector<double> raw = raw_residuals(model, u, window);
  const std::vector<double> out = standardised(model, window, raw);
  const Eigen::Index n = rows_of(raw);
  const Eigen::Index k = rows_of(model.initial);
  WindowResiduals result;
  result.raw = Eigen::Map<const Eigen::VectorXd>(raw.data(), n);
  result.residuals.resize(n + k);
  result.residuals.head(n) = Eigen::Map<const Eigen::VectorXd>(out.data(), n);
  for (Eigen::Index i = 0; i < k; ++i) {
    result.residuals(n + i) = pull(model.initial[at(i)], window, initial_state[i]);
  }
  result.finite = result.residuals.allFinite();
  return result;
}

template <int N>
WindowResiduals evaluate_jacobian(const LogModel& model, const FitWindow& window,
                                  const double* coordinates, const double* initial_state) {
  using Jet = ceres::Jet<double, N>;
  const auto u = unpack<Jet>(model, window, coordinates, initial_state,
                             [](std::size_t i, double x) { return Jet(x, static_cast<int>(i)); });
  const std::vector<Jet> raw = raw_residuals(model, u, window);
  const std::vector<Jet> out = standardised(model, window, raw);
  const Eigen::Index n = rows_of(raw);
  const Eigen::Index k = rows_of(model.initial);
  const Eigen::Index columns = rows_of(model.quantities) + k;
  WindowResiduals result;
  result.raw.resize(n);
  result.residuals.resize(n + k);
  result.jacobian.resize(n + k, columns);
  for (Eigen::Index i = 0; i < n; ++i) {
    result.raw(i) = raw[at(i)].a;
    result.residuals(i) = out[at(i)].a;
    result.jacobian.row(i) = out[at(i)].v.head(columns).transpose();
  }
  result.jacobian.bottomRows(k).setZero();
  for (Eigen::Index i = 0; i < k; ++i) {
    result.residuals(n + i) = pull(model.initial[at(i)], window, initial_state[i]);
    result.jacobian(n + i, columns - k + i) = 1.0 / model.initial[at(i)].prior_std;
  }
  result.finite = result.residuals.allFinite() && result.jacobian.allFinite();
  return result;
}

}  // namespace

WindowResiduals evaluate(const LogModel& model, const FitWindow& window, const double* coordinates,
                         const double* initial_state, bool with_jacobian) {
  if (!with_jacobian) return evaluate_values(model, window, coordinates, initial_state);
  // A jet of a fixed size costs as much as all its derivatives: the smallest that holds them.
  const std::size_t numbers = model.quantities.size() + model.initial.size();
  if (numbers <= 12) return evaluate_jacobian<12>(model, window, coordinates, initial_state);
  if (numbers <= 16) return evaluate_jacobian<16>(model, window, coordinates, initial_state);
  if (numbers <= 20) return evaluate_jacobian<20>(model, window, coordinates, initial_state);
  if (numbers <= 28) return evaluate_jacobian<28>(model, window, coordinates, initial_state);
  // 13 parameters, a delay, 7 biases, 6 late sensors and 7 components of the initial state are the
  // most there are.
  static_assert(kParameterCount + 1 + 3 * kChannelCount <= 36);
  return evaluate_jacobian<36>(model, window, coordinates, initial_state);
}

}  // namespace awmr
