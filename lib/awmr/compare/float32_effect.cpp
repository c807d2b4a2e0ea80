#include "awmr/compare/float32_effect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "awmr/core/option_text.h"

namespace awmr {
namespace {

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

/// s = sqrt(sum (x - mean)^2 / (n - 1)), n >= 2. Exactly 0 where all are the same, as at a corner
/// of the parameters: their mean is rounded.
double standard_deviation(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  if (!(*least < *most)) return 0.0;
  const double mean = mean_of(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

/// `a` in float32 and `b` in double are the same runs.
Float32Effect effect_on(const MetricColumn& metric, const ModeRows& a, const ModeRows& b,
                        double relevance) {
  Float32Effect effect;
  effect.contender = a.contender;
  effect.metric = metric.id;
  std::vector<double> all, drawn;
  double squares = 0.0;
  for (std::size_t i = 0; i < b.rows.size(); ++i) {
    const auto in_float32 = metric.value(a.rows[i].metrics);
    const auto in_double = metric.value(b.rows[i].metrics);
    if (in_double) all.push_back(*in_double);
    if (in_double && i > 0) drawn.push_back(*in_double);
    if (in_float32.has_value() != in_double.has_value()) ++effect.lost;
    if (!in_float32 || !in_double) continue;
    const double size = std::abs(*in_float32 - *in_double);
    squares += size * size;
    ++effect.count;
    if (size > effect.largest) {
      effect.largest = size;
      effect.largest_sample = b.rows[i].sample;
    }
  }
  if (effect.count > 0) effect.rms = std::sqrt(squares / static_cast<double>(effect.count));
  if (drawn.size() >= 2) effect.spread = standard_deviation(drawn);
  effect.margin = std::max(metric.ranking_floor, relevance * std::abs(mean_of(all)));
  return effect;
}

/// The comparison's rows of the checked samples; empty where not all of them were also run in
/// double.
Comparison checked_part(const Comparison& comparison) {
  Comparison part = judged_part(comparison);
  part.whole_samples = std::min(part.whole_samples, kCheckedSamples);
  std::erase_if(part.rows,
                [&](const ComparisonRow& row) { return row.sample >= part.whole_samples; });
  const bool is_checked = !part.rows.empty() && part.rows.size() == comparison.in_double.size();
  return is_checked ? part : Comparison{};
}

void add_effects(const ScenarioRows& in_float32, const ScenarioRows& in_double, double relevance,
                 Float32Check& check) {
  for (std::size_t m = 0; m < in_double.modes.size(); ++m) {
    const ModeRows& a = in_float32.modes[m];
    const ModeRows& b = in_double.modes[m];
    for (std::size_t i = 0; i < b.rows.size(); ++i) {
      if (a.rows[i].metrics.completed != b.rows[i].metrics.completed) ++check.completed_otherwise;
    }
    for (const MetricColumn& metric : kMetricColumns) {
      Float32Effect effect = effect_on(metric, a, b, relevance);
      if (effect.count + effect.lost == 0) continue;
      effect.scenario = in_double.scenario;
      check.effects.push_back(std::move(effect));
    }
  }
}

void add_changed(const ScenarioRows& in_float32, const ScenarioRows& in_double,
                 const CompareOptions& options, Float32Check& check) {
  const auto a = paired_differences(in_float32, options.preferences, options.seed);
  const auto b = paired_differences(in_double, options.preferences, options.seed);
  for (std::size_t i = 0; i < b.size(); ++i) {
    if (a[i].conclusion == b[i].conclusion) continue;
    check.changed.push_back({in_double.scenario, b[i].first, b[i].second, b[i].metric,
                             a[i].conclusion, b[i].conclusion});
  }
}

/// Of each metric the effect that is largest for what is looked at, the largest first.
std::vector<const Float32Effect*> worst_by_metric(const Float32Check& check) {
  std::vector<const Float32Effect*> worst(kMetricColumns.size(), nullptr);
  for (const Float32Effect& effect : check.effects) {
    const Float32Effect*& one = worst[at(effect.metric)];
    if (one == nullptr || effect.size() > one->size()) one = &effect;
  }
  std::erase(worst, nullptr);
  std::stable_sort(worst.begin(), worst.end(),
                   [](const auto* a, const auto* b) { return a->size() > b->size(); });
  return worst;
}

std::string run_of(const Float32Effect& effect) {
  return fmt::format("{}, {}", effect.scenario, effect.contender.label());
}

std::string effect_line(const Float32Effect& effect) {
  const MetricColumn& metric = column_of(effect.metric);
  const auto share = effect.of_spread(effect.rms);
  return fmt::format("  {:<20} {:>6} {:>9.2g} {:>9.2g} {:>10} {}\n", metric.name, metric.unit,
                     effect.largest, effect.rms,
                     share ? fmt::format("{:.2g} %", 100.0 * *share) : "-", run_of(effect));
}

/// Of each metric, where float32 changes it most for its spread, or for what matters.
std::string lines_of(std::span<const Float32Effect* const> effects) {
  std::string text = fmt::format("  {:<20} {:>6} {:>9} {:>9} {:>10} {}\n", "metric", "unit",
                                 "largest", "rms", "of spread", "in");
  for (const Float32Effect* effect : effects) text += effect_line(*effect);
  return text;
}

std::string conclusion_text(const std::optional<Conclusion>& conclusion) {
  return std::string(conclusion ? name_in(kConclusionNames, *conclusion) : "none");
}

Finding finding(Severity severity, const char* code, std::string message) {
  return {.file = {}, .line = 0, .severity = severity, .code = code, .message = std::move(message)};
}

}  // namespace

std::optional<double> Float32Effect::of_spread(double value) const {
  if (!spread || !(*spread > 0.0)) return std::nullopt;
  return value / *spread;
}

double Float32Effect::size() const {
  const double scale = std::max(spread.value_or(0.0), margin);
  return scale > 0.0 ? rms / scale : 0.0;
}

bool Float32Effect::matters() const { return lost > 0 || size() > kSmallShare; }

Float32Check check_of(const Comparison& comparison, const CompareOptions& options) {
  Float32Check check;
  check.in_double =
      static_cast<std::size_t>(std::count_if(comparison.rows.begin(), comparison.rows.end(),
                                             [](const auto& row) { return !row.took_float32; }));
  const Comparison part = checked_part(comparison);
  if (part.rows.empty()) return check;
  check.samples = part.whole_samples;
  Comparison other;
  other.rows = comparison.in_double;
  other.whole_samples = part.whole_samples;
  const std::vector<ScenarioRows> in_float32 = group(part);
  const std::vector<ScenarioRows> in_double = group(other);
  for (std::size_t i = 0; i < in_double.size(); ++i) {
    add_effects(in_float32[i], in_double[i], options.preferences.relevance, check);
    add_changed(in_float32[i], in_double[i], options, check);
  }
  return check;
}

std::string float32_table(const Float32Check& check) {
  constexpr std::size_t kLines = 4;
  std::string text;
  if (check.samples == 0) {
    text = "float32: stopped before its effect was measured\n";
  } else {
    const auto worst = worst_by_metric(check);
    text = fmt::format("float32 against double, over {} sample(s) of each scenario and mode\n",
                       check.samples) +
           lines_of(std::span(worst).first(std::min(kLines, worst.size())));
    if (worst.size() > kLines) {
      text += fmt::format("  and {} more metrics, less: comparison.json, /float32/effects\n",
                          worst.size() - kLines);
    }
  }
  if (check.in_double > 0) {
    text +=
        fmt::format("  {} run(s) in double, as float32 could not follow them\n", check.in_double);
  }
  return text;
}

std::string float32_details(const Comparison& comparison, const CompareOptions& options) {
  if (!comparison.is_float32()) return "";
  return "float32 against double, every metric\n" +
         lines_of(worst_by_metric(check_of(comparison, options)));
}

std::vector<Finding> float32_findings(const Comparison& comparison, const CompareOptions& options) {
  std::vector<Finding> findings;
  if (!comparison.is_float32()) return findings;
  const Float32Check check = check_of(comparison, options);
  const std::string advice = fmt::format("leave out {} to be sure", option_text("float32"));
  for (const Float32Effect* effect : worst_by_metric(check)) {
    if (!effect->matters()) continue;
    const MetricColumn& metric = column_of(effect->metric);
    findings.push_back(finding(
        Severity::kWarning, "float32-effect",
        fmt::format("{}: float32 changes {} by {:.2g} {} (rms), up to {:.2g}, and its spread is "
                    "{:.2g}; {} run(s) have it in one of float32 and double alone: {}",
                    run_of(*effect), metric.name, effect->rms, metric.unit, effect->largest,
                    effect->spread.value_or(0.0), effect->lost, advice)));
  }
  if (check.completed_otherwise > 0) {
    findings.push_back(finding(
        Severity::kWarning, "float32-effect",
        fmt::format("{} of the checked runs complete in one of float32 and double alone: {}",
                    check.completed_otherwise, advice)));
  }
  for (const ChangedConclusion& one : check.changed) {
    findings.push_back(
        finding(Severity::kWarning, "float32-effect",
                fmt::format("{}: of {} against {}, {}, float32 concludes '{}' and double '{}' over "
                            "the same {} sample(s): {}",
                            one.scenario, one.first.label(), one.second.label(),
                            column_of(one.metric).name, conclusion_text(one.in_float32),
                            conclusion_text(one.in_double), check.samples, advice)));
  }
  if (check.in_double > 0) {
    findings.push_back(finding(
        Severity::kNote, "float32-in-double",
        fmt::format("{} run(s) were driven in double, as float32 could not follow them: those with "
                    "0 under float32 in comparison.csv",
                    check.in_double)));
  }
  return findings;
}

}  // namespace awmr
