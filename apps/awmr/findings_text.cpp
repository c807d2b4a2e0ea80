#include "findings_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "awmr/core/option_text.h"
#include "awmr/core/text.h"
#include "awmr/model/finding_rank.h"

namespace awmr::cli {
namespace {

constexpr std::size_t kShown = 3;

std::string severity_text(Severity severity, const Style& style) {
  switch (severity) {
    case Severity::kError:
      return style.error("error:");
    case Severity::kWarning:
      return style.warning("warning:");
    case Severity::kNote:
      return style.note("note:");
  }
  return {};
}

/// Counts the findings by code in order of first occurrence: "2 tau-turn-mismatch, 1 outlier".
std::string counted(std::span<const Finding* const> findings) {
  std::vector<std::pair<std::string, int>> counts;
  for (const Finding* finding : findings) {
    const auto known = std::find_if(counts.begin(), counts.end(), [&](const auto& count) {
      return count.first == finding->code;
    });
    if (known == counts.end()) {
      counts.emplace_back(finding->code, 1);
    } else {
      ++known->second;
    }
  }
  std::string text;
  for (const auto& [code, count] : counts) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, code);
  }
  return text;
}

}  // namespace

std::string to_text(const Finding& finding, const Style& style) {
  std::string place;
  if (!finding.file.empty()) place = finding.file + ":";
  if (finding.line > 0) place += fmt::format("{}:", finding.line);
  if (!place.empty()) place += " ";
  return fmt::format("{} {}{} {}", severity_text(finding.severity, style),
                     printable(shortened(place)),
                     printable(shortened(spell_options(finding.message, "--"))),
                     style.faint(fmt::format("[{}]", finding.code)));
}

std::string findings_text(const std::vector<Finding>& findings, const Style& style) {
  const std::vector<const Finding*> order = by_effect(findings);
  const auto errors = static_cast<std::size_t>(
      std::count_if(findings.begin(), findings.end(),
                    [](const Finding& finding) { return finding.severity == Severity::kError; }));
  std::size_t shown = std::max(errors, kShown);
  if (findings.size() <= shown + 1) shown = findings.size();
  std::string text;
  for (std::size_t i = 0; i < shown; ++i) text += to_text(*order[i], style) + "\n";
  if (shown == findings.size()) return text;
  const std::string rest = counted(std::span(order).subspan(shown));
  return text +
         style.faint(fmt::format("and {} more (--verbose): {}", findings.size() - shown, rest)) +
         "\n";
}

}  // namespace awmr::cli
