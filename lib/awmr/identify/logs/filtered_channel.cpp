#include "awmr/identify/logs/filtered_channel.h"

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
  const bool has_lag = lag_s_ != Scalar(0.0);
  const Scalar e = has_lag ? std::exp(-h_s / lag_s_) : Scalar(0.0);
  const Scalar q = is_at_rows_ ? e : lag_s_ / h_s * (1.0 - e);
  const Scalar behind = y_ - u_before_;
  for (std::size_t c = 0; c < columns; ++c) {
    by_column_[c] = (1.0 - q) * by[c] + (q - e) * by_before_[c] + e * by_column_[c];
  }
  if (columns > 0) {
    const Scalar e_by_lag = has_lag ? e * h_s / (lag_s_ * lag_s_) : Scalar(0.0);
    const Scalar q_by_lag =
        is_at_rows_ ? e_by_lag : (1.0 - e) / h_s - (has_lag ? e / lag_s_ : Scalar(0.0));
    by_column_[column_] += direction_ * (behind * e_by_lag - q_by_lag * (u - u_before_));
  }
  y_ = u - q * (u - u_before_) + e * behind;
}

void FilteredChannel::next(double u, const double* by, double h_s, std::size_t columns) {
  if (filter_.damping > 0.0) {
    next_of_pair(u, by, h_s, columns);
    return;
  }
  if (!single_) single_.emplace(filter_, 1.0, y_, by_column_);
  single_->next(u, by, h_s, columns);
  y_ = single_->value();
  by_column_ = single_->by_column();
}

/// Starts the two stages of a filter of second order, with the time constants T_1 and T_2. If the
/// input u rises at a constant rate a, the output of the first stage is below u by T_1 a, and that
/// of the second stage by (T_1 + T_2) a. The output y_1 of the first stage then follows from u and
/// y, the first reading:
///
///     y_1 = u - T_1/(T_1 + T_2) (u - y)
void FilteredChannel::start_pair(double u, const std::vector<Complex>& by) {
  const Complex first(filter_.damping, std::sqrt(1.0 - filter_.damping * filter_.damping));
  const Complex share = first / (2.0 * filter_.damping);
  std::vector<Complex> by_first(by.size());
  for (std::size_t c = 0; c < by.size(); ++c) by_first[c] = (1.0 - share) * by[c];
  pair_.emplace_back(filter_, first, u - share * (u - y_), std::move(by_first));
  pair_.emplace_back(filter_, std::conj(first), Complex(y_), std::vector<Complex>(by.size()));
}

void FilteredChannel::next_of_pair(double u, const double* by, double h_s, std::size_t columns) {
  const std::vector<Complex> by_input(by, by + columns);
  if (pair_.empty()) start_pair(u, by_input);
  pair_[0].next(u, by_input.data(), h_s, columns);
  pair_[1].next(pair_[0].value(), pair_[0].by_column().data(), h_s, columns);
  y_ = pair_[1].value().real();
  for (std::size_t c = 0; c < columns; ++c) by_column_[c] = pair_[1].by_column()[c].real();
}

}  // namespace awmr
