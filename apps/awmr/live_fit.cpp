#include "live_fit.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "awmr/core/file.h"
#include "awmr/identify/planning/precision.h"
#include "awmr/identify/planning/suggest.h"

namespace awmr::cli {
namespace {

/// Smallest number of rows in a fit: while a recording has fewer rows, it is not fitted yet.
constexpr std::size_t kMinRows = 10;

}  // namespace

std::string next_manoeuvre(const Model& model) {
  const auto suggestion = suggest(model, {.repeats = 1});
  if (!suggestion) return {};
  if (!suggestion->missing.empty()) {
    const MissingParameter& first = suggestion->missing.front();
    return fmt::format("for {}: {}", info(first.id).name, first.trial);
  }
  if (suggestion->trials.empty()) return {};
  return suggestion->trials.front().settings;
}

bool has_enough(const LiveUpdate& update) {
  return update.model && update.faults.empty() &&
         is_enough(precision_of(*update.model, update.requested), update.enough);
}

LiveFit::LiveFit(const LiveCommand& command, Vehicle vehicle)
    : vehicle_(std::move(vehicle)),
      files_(command.identify.trials),
      options_(command.identify.identify),
      enough_(command.enough) {
  // To save time, diagnostics that do not change the estimates are left out here. The final fit
  // computes them.
  options_.time_limit_s = command.budget_s;
  options_.bootstrap = 0;
  options_.side_by_side = false;
}

LiveUpdate LiveFit::update(const Recording& recording) const {
  LiveUpdate update{.rows = recording.rows(),
                    .set_aside = recording.set_aside(),
                    .enough = enough_,
                    .requested = options_.requested};
  if (const Status written = write_file(files_.logs.front(), recording.text()); !written) {
    update.faults = written.error().faults;
    return update;
  }
  if (!recording.has_header() || recording.rows() < kMinRows) return update;
  fit(update);
  return update;
}

void LiveFit::fit(LiveUpdate& update) const {
  const auto trials = load_trials(vehicle_, files_);
  if (!trials) {
    update.faults = trials.error().faults;
    return;
  }
  for (const DrivingLog& run : trials->data.logs) update.span_s += run.t_s.back() - run.t_s.front();
  const auto begin = std::chrono::steady_clock::now();
  auto identified = identify(*trials, options_);
  if (!identified) {
    update.faults = identified.error().faults;
    return;
  }
  const double took_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  update.out_of_time = !identified->refused.empty() && took_s >= options_.time_limit_s;
  if (update.out_of_time) return;
  update.model = std::move(identified->model);
  if (!has_enough(update)) update.next = next_manoeuvre(*update.model);
}

}  // namespace awmr::cli
