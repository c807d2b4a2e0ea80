#include "awmr/identify/logs/simulation/filtered_channel.h"

#include <cmath>

namespace awmr {

template <class Scalar>
void FilterStage<Scalar>::next(Scalar u, const Scalar* by, double h_s, std::size_t columns) {
  if (has_before_) move(u, by, h_s, columns);
  has_before_ = true;
  u_before_ = u;
  if (columns > 0) by_before_.assign(by, by + columns);
}

template <class Scalar>
void FilterStage<Scalar>::move(Scalar u, const Scalar* by, double h_s, std::size_t columns) {
  const Scalar lag_s = lag_.lag_s;
  const bool has_lag = lag_s != Scalar(0.0);
  const Scalar e = has_lag ? std::exp(-h_s / lag_s) : Scalar(0.0);
  const Scalar q = filter_.is_at_rows ? e : lag_s / h_s * (1.0 - e);
  const Scalar behind = y_ - u_before_;
  for (std::size_t c = 0; c < columns; ++c) {
    by_column_[c] = (1.0 - q) * by[c] + (q - e) * by_before_[c] + e * by_column_[c];
  }
  if (columns > 0) {
    const Scalar e_by_lag = has_lag ? e * h_s / (lag_s * lag_s) : Scalar(0.0);
    const Scalar q_by_lag =
        filter_.is_at_rows ? e_by_lag : (1.0 - e) / h_s - (has_lag ? e / lag_s : Scalar(0.0));
    const Scalar y_by_lag = behind * e_by_lag - q_by_lag * (u - u_before_);
    by_column_[filter_.lag.column] += lag_.by_lag * y_by_lag;
    if (filter_.damping) by_column_[filter_.damping->column] += lag_.by_damping * y_by_lag;
  }
  y_ = u - q * (u - u_before_) + e * behind;
}

void FilteredChannel::next(double u, const double* by, double h_s, std::size_t columns) {
  if (filter_.damping) {
    next_of_pair(u, by, h_s, columns);
    return;
  }
  if (!single_) {
    single_.emplace(filter_, StageLag<double>{filter_.lag.value, 1.0, 0.0}, y_, by_column_);
  }
  single_->next(u, by, h_s, columns);
  y_ = single_->value();
  by_column_ = single_->by_column();
}

/// Starts the two stages of a filter of second order, with the time constants T_1 and T_2. If the
/// input u rises at a constant rate a, the output of the first stage is below u by T_1 a, and that
/// of the second stage by (T_1 + T_2) a. The output y_1 of the first stage then follows from u and
/// y, the first reading:
///
///     y_1 = u - T_1/(T_1 + T_2) (u - y),   T_1/(T_1 + T_2) = (1 + i sqrt(1 - zeta^2)/zeta)/2
void FilteredChannel::start_pair(double u, const std::vector<Complex>& by) {
  // At zeta = 1, the derivatives of T_1 and T_2 are infinite; only their sum is finite. The error
  // of T_1 T_2 by this limit is below rounding of the readings.
  constexpr double kLeastRoot = 1e-4;
  const double zeta = filter_.damping->value;
  const double lag_s = filter_.lag.value;
  const Complex exact = Complex(0.0, 1.0) * std::sqrt(Complex(1.0 - zeta * zeta));
  const Complex root = std::abs(exact) < kLeastRoot ? Complex(0.0, kLeastRoot) : exact;
  const Complex root_by = zeta / root;  // because root^2 = zeta^2 - 1
  const Complex share = 0.5 * (1.0 + root / zeta);
  const Complex share_by = 0.5 * (root_by / zeta - root / (zeta * zeta));
  std::vector<Complex> by_first(by.size());
  for (std::size_t c = 0; c < by.size(); ++c) by_first[c] = (1.0 - share) * by[c];
  if (!by.empty()) by_first[filter_.damping->column] -= share_by * (u - y_);
  pair_.emplace_back(filter_,
                     StageLag<Complex>{lag_s * (zeta + root), zeta + root, lag_s * (1.0 + root_by)},
                     u - share * (u - y_), std::move(by_first));
  pair_.emplace_back(filter_,
                     StageLag<Complex>{lag_s * (zeta - root), zeta - root, lag_s * (1.0 - root_by)},
                     Complex(y_), std::vector<Complex>(by.size()));
}

void FilteredChannel::next_of_pair(double u, const double* by, double h_s, std::size_t columns) {
  const std::vector<Complex> by_now(by, by + columns);
  std::vector<Complex> by_input = by_now;
  double input = u;
  if (pair_.empty()) {
    start_pair(u, by_now);
  } else if (filter_.is_at_rows) {
    input = 0.5 * (input_ + u);
    for (std::size_t c = 0; c < columns; ++c) by_input[c] = 0.5 * (by_input_[c] + by_now[c]);
  }
  input_ = u;
  by_input_ = by_now;
  pair_[0].next(input, by_input.data(), h_s, columns);
  pair_[1].next(pair_[0].value(), pair_[0].by_column().data(), h_s, columns);
  y_ = pair_[1].value().real();
  for (std::size_t c = 0; c < columns; ++c) by_column_[c] = pair_[1].by_column()[c].real();
}

}  // namespace awmr
