#include "awmr/compare/preferences.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "awmr/compare/metric_columns.h"
#include "awmr/compare/scoring.h"
#include "awmr/core/nearest.h"
#include "awmr/core/option_text.h"

namespace awmr {
namespace {

Result<double> weight_in(std::string_view text, const std::string& place) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool number = error == std::errc{} && end == text.data() + text.size();
  if (number && value >= 0.0 && value <= kMaximumWeight) return value;
  return input_error(
      ErrorCode::kOutOfRange, place,
      fmt::format("'{}' is not a weight; give a number from 0 to {}", text, kMaximumWeight));
}

std::vector<std::string_view> weighable_metrics() {
  std::vector<std::string_view> names;
  for (const MetricColumn& metric : kMetricColumns) {
    if (metric.can_rank()) names.push_back(metric.name);
  }
  return names;
}

Status check_metric(std::string_view name, const std::string& place) {
  const std::vector<std::string_view> known = weighable_metrics();
  if (std::find(known.begin(), known.end(), name) != known.end()) return {};
  const std::string hint = did_you_mean(name, std::vector<std::string>(known.begin(), known.end()));
  return input_error(ErrorCode::kUnknownName, place,
                     fmt::format("'{}' is not a metric that ranks modes{}; available: {}", name,
                                 hint, fmt::join(known, ", ")));
}

}  // namespace

std::optional<Fault> relevance_fault(double relevance) {
  if (allows(kRelevance, relevance)) return std::nullopt;
  return Fault{ErrorCode::kOutOfRange, option_text("relevance"),
               fmt::format("is {:g}; give a number from {:g} to {:g}", relevance, kRelevance.min,
                           kRelevance.max)};
}

Result<Preferences> preferences_of(const std::vector<std::string>& weights, double relevance) {
  const std::string place = option_text("weight");
  if (auto fault = relevance_fault(relevance)) return input_errors({*std::move(fault)});
  Preferences preferences;
  preferences.relevance = relevance;
  for (const std::string& text : weights) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
      return input_error(ErrorCode::kWrongType, place,
                         fmt::format("'{}' is not NAME=WEIGHT, such as finish_time_s=2", text));
    }
    const std::string name = text.substr(0, equals);
    AWMR_RETURN_IF_ERROR(check_metric(name, place));
    AWMR_ASSIGN_OR_RETURN(const double weight,
                          weight_in(std::string_view(text).substr(equals + 1), place));
    if (!preferences.weights.emplace(name, weight).second) {
      return input_error(ErrorCode::kGivenTwice, place,
                         fmt::format("'{}' has two weights; give one", name));
    }
  }
  if (std::none_of(kMetricColumns.begin(), kMetricColumns.end(), [&](const MetricColumn& metric) {
        return weight_of(metric, preferences) > 0.0;
      })) {
    return input_error(ErrorCode::kOutOfRange, place,
                       "sets every metric's weight to 0; give at least one above 0");
  }
  return preferences;
}

}  // namespace awmr
