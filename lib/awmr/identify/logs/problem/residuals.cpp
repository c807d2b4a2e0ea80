#include "awmr/identify/logs/problem/residuals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "awmr/core/index.h"
#include "awmr/identify/logs/problem/product_sums.h"
#include "awmr/identify/logs/problem/whitener.h"
#include "awmr/identify/logs/simulation/linear_replay.h"
#include "awmr/identify/logs/simulation/sensor_readings.h"

namespace awmr {
namespace {

/// Simulates the window and calls visit(row, readings, motion) at each of its rows.
template <class Visit>
void for_each_row(const LogModel& model, const FitWindow& window, const SimulatedVehicle& vehicle,
                  std::size_t columns, Visit visit) {
  const double h = model.longest_step_s;
  LinearStepper stepper(vehicle.plant, columns, vehicle.parameters, vehicle.path.terms, h,
                        vehicle.extra);
  SensorReadings readings(model, window, vehicle, columns);
  replay_linear(*window.signals, window.rows.begin, window.rows.end, vehicle.path, stepper, h,
                first_motion(model, vehicle, columns),
                [&](std::size_t row, const LinearMotion& now) {
                  readings.go_on(now);
                  visit(row, readings, now);
                });
}

/// Calls visit(i, reading, row) for every sample i in order. `reading`: simulated reading of the
/// sensor. `row`: its derivatives with respect to the columns of the fit. Only for fits in which no
/// channel is smoothed.
template <class Visit>
void for_each_reading(const LogModel& model, const FitWindow& window,
                      const SimulatedVehicle& vehicle, std::size_t columns, Visit visit) {
  const std::vector<Sample>& samples = window.samples();
  std::size_t next = 0;
  for_each_row(model, window, vehicle, columns,
               [&](std::size_t row, SensorReadings& readings, const LinearMotion& now) {
                 for (; next < samples.size() && samples[next].row == row; ++next) {
                   const double reading = readings.read(samples[next].channel, now);
                   visit(next, reading, readings.row());
                 }
               });
}

/// Does the same as for_each_reading() for fits with smoothed channels. Smoothing needs later rows,
/// so the readings of all rows are computed first.
template <class Visit>
void for_each_smoothed_reading(const LogModel& model, const FitWindow& window,
                               const SimulatedVehicle& vehicle, std::size_t columns, Visit visit) {
  std::array<ReadingSeries, kChannelCount> series;
  const std::set<LogChannel> measured = channels_of(model.noise);
  for_each_row(model, window, vehicle, columns,
               [&](std::size_t, SensorReadings& readings, const LinearMotion& now) {
                 for (const LogChannel c : measured) {
                   const double reading = readings.read(c, now);
                   series[at(c)].add(reading, readings.row());
                 }
               });
  const std::vector<Sample>& samples = window.samples();
  std::vector<double> by(columns);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const LogChannel c = samples[i].channel;
    const std::size_t place = samples[i].row - window.rows.begin;
    const double reading = series[at(c)].read(place, vehicle.sensors.smoothing[at(c)], by);
    visit(i, reading, by);
  }
}

/// Calls visit(i, error, row) for every sample i in order. `error` is model + bias - measured.
/// `row`: derivatives of the error with respect to the columns of the fit (empty if `columns` is
/// 0); `visit` may overwrite them. The model value is the output of the sensor model: with latency,
/// the state one delay earlier; with a filter, the output of the filter; with smoothing, a mean
/// over earlier and later rows.
template <class Visit>
void for_each_error(const LogModel& model, const FitWindow& window, const SimulatedVehicle& vehicle,
                    std::size_t columns, Visit visit) {
  const DrivingLog& log = *window.rows.log;
  const std::vector<Sample>& samples = window.samples();
  const auto visit_sample = [&](std::size_t i, double reading, std::vector<double>& by) {
    const LogChannel c = samples[i].channel;
    for (const auto& [channel, bias] : vehicle.sensors.biases) {
      if (channel != c) continue;
      reading += bias.value;
      if (columns > 0) by[bias.column] += 1.0;
    }
    if (columns > 0) {
      for (const auto& [first, second] : vehicle.equal_columns) by[second] = by[first];
    }
    visit(i, reading - log[c]->value[samples[i].row], by);
  };
  if (vehicle.sensors.any_smoothed()) {
    for_each_smoothed_reading(model, window, vehicle, columns, visit_sample);
  } else {
    for_each_reading(model, window, vehicle, columns, visit_sample);
  }
}

/// Residual of the weak prior that keeps a component of a window's initial state near its measured
/// value.
double pull(const InitialComponent& component, const FitWindow& window, double initial) {
  return (initial - channel_of(window.measured, component.channel)) / component.prior_std;
}

/// Whitening filters for the errors of one channel, and for the derivatives of these errors with
/// respect to the columns of the fit.
struct RowWhitener {
  RowWhitener(const ChannelNoise& noise, std::size_t columns)
      : gains(noise), states(noise.is_white() ? 0 : columns) {}

  /// Replaces each number of the row (the error or one of its derivatives) by its innovation,
  /// divided by the standard deviation of the innovation and multiplied by `weight`.
  void next(double since_s, double weight, std::vector<double>& row) {
    const WhitenerGains::Step& step = gains.next(since_s);
    const double scale = weight / std::sqrt(step.variance);
    for (std::size_t c = 0; c < states.size(); ++c) row[c] = states[c].next(row[c], gains, step);
    for (double& x : row) x *= scale;
  }

  WhitenerGains gains;
  std::vector<WhitenerState> states;
};

const ChannelNoise& noise_of(const LogModel& model, const FitWindow& window, LogChannel channel) {
  return sensor_in(model.noise, channel, window.rows.log->number).second;
}

class Blocks {
 public:
  Blocks(const FitWindow& window, double block_s)
      : t_s_(window.rows.log->t_s), from_s_(t_s_[window.rows.begin]), block_s_(block_s) {}
  bool ends_before(const Sample& sample) {
    if (!(block_s_ > 0.0) || t_s_[sample.row] - from_s_ < block_s_) return false;
    from_s_ = t_s_[sample.row];
    return true;
  }

 private:
  const std::vector<double>& t_s_;
  double from_s_;
  double block_s_;
};

/// Errors of a window and their derivatives with respect to the times of its m changes: one row
/// [J_o r] per sample.
struct ErrorRows {
  Eigen::MatrixXd raw;           ///< not whitened
  Eigen::MatrixXd standardised;  ///< whitened, divided by the standard deviation and weighted
};

ErrorRows error_rows(const LogModel& model, const FitWindow& window, const double* coordinates,
                     const double* initial_state) {
  const std::vector<Sample>& samples = window.samples();
  const SimulatedVehicle vehicle = vehicle_at(model, window, coordinates, initial_state);
  const std::size_t first = vehicle.path.first_change_column;
  const std::size_t m = window.changes.size();
  const Eigen::Index columns = eigen_index(m + 1);
  ErrorRows rows{Eigen::MatrixXd(rows_of(samples), columns),
                 Eigen::MatrixXd(rows_of(samples), columns)};
  std::array<std::optional<RowWhitener>, kChannelCount> whiteners;
  std::vector<double> row(m + 1);
  for_each_error(model, window, vehicle, ProductSums(first + m + 1).columns(),
                 [&](std::size_t i, double error, const std::vector<double>& by) {
                   std::copy_n(by.begin() + static_cast<std::ptrdiff_t>(first), m, row.begin());
                   row[m] = error;
                   const Eigen::Map<const Eigen::RowVectorXd> numbers(row.data(), columns);
                   rows.raw.row(eigen_index(i)) = numbers;
                   auto& whitener = whiteners[at(samples[i].channel)];
                   if (!whitener)
                     whitener.emplace(noise_of(model, window, samples[i].channel), m + 1);
                   whitener->next(samples[i].since_s, window.weight(i), row);
                   rows.standardised.row(eigen_index(i)) = numbers;
                 });
  return rows;
}

/// errors_of() for a window with changes of the commands at uncertain times.
WindowErrors errors_at_likeliest_times(const LogModel& model, const FitWindow& window,
                                       const double* coordinates, const double* initial_state) {
  const ErrorRows rows = error_rows(model, window, coordinates, initial_state);
  const Marginalised times =
      marginalised(rows.standardised.transpose() * rows.standardised, window.changes);
  const Eigen::Index m = rows_of(window.changes);
  Eigen::VectorXd with_one(m + 1);  // [o 1]
  for (Eigen::Index i = 0; i < m; ++i) {
    const UncertainChange& change = window.changes[at(i)];
    with_one(i) = change.mean_s + change.std_s * times.standardised(i);
  }
  with_one(m) = 1.0;
  WindowErrors result{.raw = rows.raw * with_one,
                      .standardised = rows.standardised * with_one,
                      .change_cost = times.standardised.squaredNorm() + times.ln_det,
                      .change_times = times.standardised};
  result.finite = result.standardised.allFinite();
  return result;
}

/// Eliminates the times of the window's changes from the sums. `products`: [J J_o r]^T [J J_o r].
void eliminate_times(const FitWindow& window, const Eigen::MatrixXd& products, WindowSums& sums) {
  const Marginalised times = marginalised(products, window.changes);
  const Eigen::Index m = rows_of(window.changes);
  const Eigen::Index n = products.rows() - 1 - m;
  sums.products_at_known_times.resize(n + 1, n + 1);
  sums.products_at_known_times << products.topLeftCorner(n, n), products.block(0, n + m, n, 1),
      products.block(n + m, 0, 1, n), products(n + m, n + m);
  sums.products = times.products;
  sums.change_cost = times.ln_det;
  sums.change_times.resize(m, n + 1);
  sums.change_times << times.decrease, times.standardised;
  for (Eigen::VectorXd& gradient : sums.block_gradients) {
    for (Eigen::Index i = 0; i < m; ++i) gradient(n + i) *= window.changes[at(i)].std_s;
    gradient = (gradient.head(n) - times.decrease.transpose() * gradient.tail(m)).eval();
  }
}

}  // namespace

WindowErrors errors_of(const LogModel& model, const FitWindow& window, const double* coordinates,
                       const double* initial_state) {
  if (!window.changes.empty()) {
    return errors_at_likeliest_times(model, window, coordinates, initial_state);
  }
  const std::vector<Sample>& samples = window.samples();
  WindowErrors result;
  result.raw.resize(rows_of(samples));
  result.standardised.resize(rows_of(samples));
  std::array<std::optional<Whitener>, kChannelCount> whiteners;
  for_each_error(model, window, vehicle_at(model, window, coordinates, initial_state), 0,
                 [&](std::size_t i, double error, const std::vector<double>&) {
                   auto& whitener = whiteners[at(samples[i].channel)];
                   if (!whitener) whitener.emplace(noise_of(model, window, samples[i].channel));
                   const auto [value, variance] = whitener->next(error, samples[i].since_s);
                   result.raw(eigen_index(i)) = error;
                   result.standardised(eigen_index(i)) =
                       window.weight(i) / std::sqrt(variance) * value;
                 });
  result.finite = result.standardised.allFinite();
  return result;
}

WindowSums sums_of(const LogModel& model, const FitWindow& window, const double* coordinates,
                   const double* initial_state, double block_s) {
  const std::size_t q = model.quantities.size();
  const std::size_t k = model.initial.size();
  const std::vector<Sample>& samples = window.samples();
  const std::size_t last = q + k + window.changes.size();  // column of the residuals
  ProductSums sums(last + 1);
  Blocks blocks(window, block_s);
  WindowSums result;
  std::array<std::optional<RowWhitener>, kChannelCount> whiteners;
  for_each_error(model, window, vehicle_at(model, window, coordinates, initial_state),
                 sums.columns(), [&](std::size_t i, double error, std::vector<double>& row) {
                   const Sample& sample = samples[i];
                   if (blocks.ends_before(sample)) {
                     result.block_gradients.push_back(sums.take_gradient());
                   }
                   auto& whitener = whiteners[at(sample.channel)];
                   if (!whitener) {
                     whitener.emplace(noise_of(model, window, sample.channel), sums.columns());
                   }
                   row[last] = error;
                   whitener->next(sample.since_s, window.weight(i), row);
                   sums.add(row.data());
                 });
  if (block_s > 0.0) result.block_gradients.push_back(sums.take_gradient());
  for (std::size_t i = 0; i < k; ++i) {
    std::vector<double> row(sums.columns(), 0.0);
    row[q + i] = 1.0 / model.initial[i].prior_std;
    row[last] = pull(model.initial[i], window, initial_state[i]);
    sums.add(row.data());
  }
  if (window.changes.empty()) {
    result.products = sums.products();
  } else {
    eliminate_times(window, sums.products(), result);
  }
  result.finite = result.products.allFinite();
  return result;
}

}  // namespace awmr
