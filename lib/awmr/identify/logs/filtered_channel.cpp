#include "awmr/identify/logs/filtered_channel.h"

#include <cmath>

namespace awmr {

void FilteredChannel::next(double u, const double* by, double h_s, std::size_t columns) {
  if (has_before_) move(u, by, h_s, columns);
  has_before_ = true;
  u_before_ = u;
  if (columns > 0) by_before_.assign(by, by + columns);
}

void FilteredChannel::move(double u, const double* by, double h_s, std::size_t columns) {
  const double lag_s = filter_.lag.delay_s;
  const double e = lag_s > 0.0 ? std::exp(-h_s / lag_s) : 0.0;
  const double q = filter_.is_at_rows ? e : lag_s / h_s * (1.0 - e);
  const double behind = y_ - u_before_;
  for (std::size_t c = 0; c < columns; ++c) {
    by_column_[c] = (1.0 - q) * by[c] + (q - e) * by_before_[c] + e * by_column_[c];
  }
  if (columns > 0) {
    const double e_by_lag = lag_s > 0.0 ? e * h_s / (lag_s * lag_s) : 0.0;
    const double q_by_lag =
        filter_.is_at_rows ? e_by_lag : (1.0 - e) / h_s - (lag_s > 0.0 ? e / lag_s : 0.0);
    by_column_[filter_.lag.column] += behind * e_by_lag - q_by_lag * (u - u_before_);
  }
  y_ = u - q * (u - u_before_) + e * behind;
}

}  // namespace awmr
