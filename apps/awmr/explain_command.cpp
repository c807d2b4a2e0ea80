#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <sstream>

#include "awmr/core/json/json.h"
#include "awmr/core/nearest.h"
#include "awmr/core/text.h"
#include "commands.h"
#include "embedded_files.h"

namespace awmr::cli {
namespace {

struct ExplainCommand {
  std::optional<std::string> code;
};

/// Explanation of the code of a finding or an error, from a row of FINDINGS.md.
struct Explanation {
  std::string code;
  std::string group;     ///< heading of its table
  std::string severity;  ///< "note", "note or warning"
  std::string meaning;
  std::string remedy;
};

/// Returns the cells of a row of a Markdown table, without backticks.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::string cell;
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (line[i] == '\\' && i + 1 < line.size()) {
      cell += line[++i];
    } else if (line[i] == '|') {
      const std::size_t begin = cell.find_first_not_of(' ');
      cells.push_back(begin == std::string::npos
                          ? ""
                          : cell.substr(begin, cell.find_last_not_of(' ') + 1 - begin));
      cell.clear();
    } else if (line[i] != '`') {
      cell += line[i];
    }
  }
  return cells;
}

/// Splits a list "a, b" at its commas.
std::vector<std::string> parts_of(const std::string& list) {
  std::vector<std::string> parts;
  std::istringstream words(list);
  for (std::string part; std::getline(words >> std::ws, part, ',');) parts.push_back(part);
  return parts;
}

/// Reads the rows of FINDINGS.md, which have the columns codes, severity, meaning and remedy. A row
/// has one severity for all its codes, or one for each code (tests/cli/findings.py checks this).
std::vector<Explanation> explanations() {
  std::vector<Explanation> all;
  std::string group;
  std::istringstream lines(std::string(findings_file().front().bytes));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("## ")) group = line.substr(3);
    if (!line.starts_with("| `")) continue;
    const std::vector<std::string> cells = cells_of(line);
    const std::vector<std::string> codes = parts_of(cells.at(0));
    const std::vector<std::string> severities = parts_of(cells.at(1));
    for (std::size_t i = 0; i < codes.size(); ++i) {
      all.push_back({codes[i], group, severities.at(severities.size() == 1 ? 0 : i), cells.at(2),
                     cells.at(3)});
    }
  }
  return all;
}

constexpr std::size_t kWidth = 100;

std::string text_of(const Explanation& one) {
  constexpr std::size_t kIndent = 11;
  return fmt::format("{}\n  severity {}\n  in       {}\n  meaning  {}\n  remedy   {}\n", one.code,
                     one.severity, one.group, wrapped(one.meaning, kIndent, kWidth),
                     wrapped(one.remedy, kIndent, kWidth));
}

/// All codes with their meanings, by group.
std::string list_of(const std::vector<Explanation>& all) {
  std::size_t longest = 0;
  for (const Explanation& one : all) longest = std::max(longest, one.code.size());
  std::string text, group;
  for (const Explanation& one : all) {
    if (one.group != group) text += fmt::format("{}{}\n", group.empty() ? "" : "\n", one.group);
    group = one.group;
    text +=
        fmt::format("  {:<{}}  {}\n", one.code, longest, wrapped(one.meaning, longest + 4, kWidth));
  }
  return text;
}

/// Returns at most five codes that the user may have meant by a misspelt or shortened code. Codes
/// of similar spelling come first, then those that contain the text.
std::vector<std::string> near_codes(const std::string& code, std::vector<std::string> codes) {
  constexpr std::size_t kShortest = 3, kMax = 5;
  std::vector<std::string> near;
  if (std::string found = nearest(code, codes); !found.empty()) near.push_back(std::move(found));
  for (std::string& one : codes) {
    const bool contains = code.size() >= kShortest && one.find(code) != std::string::npos;
    if (!contains || near.size() == kMax) continue;
    if (std::ranges::find(near, one) == near.end()) near.push_back(std::move(one));
  }
  return near;
}

tl::unexpected<Error> unknown_code(const std::string& code, const std::vector<std::string>& codes) {
  const std::vector<std::string> near = near_codes(code, codes);
  return input_error(
      ErrorCode::kUnknownName, "CODE",
      fmt::format("no finding or error has the code '{}'; {}", shortened(code),
                  near.empty() ? "awmr explain lists all codes"
                               : fmt::format("did you mean '{}'?", fmt::join(near, "', '"))));
}

Json to_json(const std::vector<Explanation>& all) {
  Json json = Json::array();
  for (const Explanation& one : all) {
    json.push_back({{"code", one.code},
                    {"group", one.group},
                    {"severity", one.severity},
                    {"meaning", one.meaning},
                    {"remedy", one.remedy}});
  }
  return json;
}

Result<Outcome> execute(const ExplainCommand& command) {
  std::vector<Explanation> all = explanations();
  if (!command.code) {
    return Outcome{.summary = list_of(all), .document = awmr::to_text(to_json(all))};
  }
  std::vector<std::string> codes;
  for (const Explanation& one : all) codes.push_back(one.code);
  std::erase_if(all, [&](const Explanation& one) { return one.code != command.code; });
  if (all.empty()) return unknown_code(*command.code, codes);
  Outcome outcome{.document = awmr::to_text(to_json(all))};
  for (const Explanation& one : all) outcome.summary += text_of(one);
  return outcome;
}

}  // namespace

void add_explain(CLI::App& app, Session& session) {
  auto command = std::make_shared<ExplainCommand>();
  CLI::App* sub = add_command(
      app, session, "explain", "Print what the code of a finding or an error means and what to do",
      "awmr explain not-identifiable", [command] { return execute(*command); });
  sub->add_option(
      "CODE", command->code,
      "Code of a finding or an error, printed in brackets; without it, all codes are listed");
}

}  // namespace awmr::cli
