#include "awmr/identify/logs/log_sample.h"

#include <algorithm>
#include <iterator>
#include <set>

namespace awmr {

bool is_long(const LogProblem& problem) { return problem.windows.size() >= 2 * kSampleWindows; }

std::vector<std::size_t> spread(std::size_t size, std::size_t count) {
  std::vector<std::size_t> indices;
  count = std::min(count, size);
  for (std::size_t i = 0; i < count; ++i) indices.push_back(i * size / count);
  return indices;
}

LogProblem with_windows(const LogProblem& problem, const std::vector<std::size_t>& windows) {
  LogProblem part = problem;
  part.windows.clear();
  std::set<LogChannel> measured;
  for (const std::size_t w : windows) {
    part.windows.push_back(problem.windows[w]);
    for (const Sample& sample : problem.windows[w].samples()) measured.insert(sample.channel);
  }
  std::erase_if(part.model.noise,
                [&](const auto& level) { return !measured.contains(level.first); });
  return part;
}

SearchPoint with_windows(const LogProblem& problem, const SearchPoint& point,
                         const std::vector<std::size_t>& windows) {
  const auto components = static_cast<std::ptrdiff_t>(problem.model.initial.size());
  SearchPoint part{point.coordinates, {}};
  for (const std::size_t w : windows) {
    const auto first = point.initial_states.begin() + static_cast<std::ptrdiff_t>(w) * components;
    std::copy(first, first + components, std::back_inserter(part.initial_states));
  }
  return part;
}

}  // namespace awmr
