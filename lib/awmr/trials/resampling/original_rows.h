/// Recovers the rows of a log whose columns a program interpolated onto more rows. Private to trials/.
#pragma once

#include <cstddef>
#include <vector>

#include "awmr/trials/log.h"

namespace awmr {

/// Column of a measured channel.
struct ChannelColumn {
  LogChannel channel;
  std::vector<double> value;         ///< by row, SI
  std::vector<std::size_t> present;  ///< rows in which the file has a value
  double rounding = 0.0;             ///< smallest_step(), SI; not set in joined logs
};

/// If `columns` or commands of the log are interpolated (interpolated_readings.h), changes log and
/// columns, which then have a row for each reading (note `interpolated-readings`):
///   - an interpolated channel has a value only at its readings;
///   - an interpolated command is held from each of its values until the next; a command that was
///     held between the same readings changes at these, and not in the next row;
///   - other rows stay only if they have another measurement or a change of another command.
/// A steering_deg without steering_cmd_deg stays as it is, and then all rows stay. Changes nothing
/// in a joined log. Precondition: the log has its times and commands.
void recover_original_rows(DrivingLog& log, std::vector<ChannelColumn>& columns,
                           std::vector<Finding>& findings);

}  // namespace awmr
