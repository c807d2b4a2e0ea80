/// Changes of the commands at uncertain times: a log has only samples of the commands. Private to
/// identify/.
///
/// A change happens at the time t + o. t is the time of its row. o is normally distributed, with a
/// mean and a standard deviation s. The residuals r are linear in all o, with the Jacobian J_o. The
/// cost of a fit is the minimum over all o, which are thus eliminated from all sums:
///
///     min over o of |r + J_o o|^2 + |(o - mean)/s|^2
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "awmr/trials/replay.h"

namespace awmr {

struct UncertainChange {
  std::size_t row;  ///< first row with the new commands
  double mean_s;    ///< expected time of the change, relative to the time of the row, s
  double std_s;     ///< standard deviation of this time, s
};

/// Changes within the window whose times are uncertain (DrivingLog::change_std_s). The first row of
/// the window does not count.
std::vector<UncertainChange> uncertain_changes(const LogWindow& window);

/// All changes within the window. The time of each is uniformly distributed between the row before
/// and its own row. Empty if the window has too many changes (kMaxChangeShare).
std::vector<UncertainChange> changes_before_rows(const LogWindow& window);

/// Largest number of changes per row of a window for which their times are estimated. If commands
/// change more often, straight lines between the rows describe them better
/// (interpolated_commands.h).
inline constexpr double kMaxChangeShare = 0.2;

/// Returns the logs with an additional row for every change of the commands, in the middle between
/// two rows. This row has the new commands, an uncertain time and no measurements. Gaps of the log
/// (kGapSteps) get no additional rows.
std::vector<DrivingLog> with_changes_between_rows(const std::vector<DrivingLog>& logs);

/// Sums without the times of m changes.
struct Marginalised {
  Eigen::MatrixXd products;  ///< [J r]^T [J r] for the cost above, without the columns J_o
  double ln_det = 0.0;       ///< ln det(I + S J_o^T J_o S), S = diag s
  /// Likeliest (o - mean)/s at the point at which the sums were computed.
  Eigen::VectorXd standardised;
  /// Amounts by which the numbers in `standardised` decrease if an unknown increases by 1,
  /// [m][columns of J].
  Eigen::MatrixXd decrease;
};
/// `products`: [J J_o r]^T [J J_o r], without the prior of the times.
Marginalised marginalised(const Eigen::MatrixXd& products,
                          const std::vector<UncertainChange>& changes);

}  // namespace awmr
