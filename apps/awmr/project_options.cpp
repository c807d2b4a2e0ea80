#include "project_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>

#include "awmr/core/json/json_document.h"
#include "awmr/core/option_text.h"

namespace awmr::cli {
namespace {

/// An option of a command, and the key of project.json that has the same effect (for the command
/// `tune`: the key of tune.json).
struct ProjectKey {
  std::string_view command;
  std::string_view option;
  std::string_view key;
};
constexpr ProjectKey kKeys[] = {
    {"identify", "as-is", "identify/as_is"},
    {"identify", "coastdown", "trials/coastdown"},
    {"identify", "column", "columns"},
    {"identify", "exclude", "identify/exclude"},
    {"identify", "family", "identify/family"},
    {"identify", "fit", "identify/fit"},
    {"identify", "from", "identify/from_s"},
    {"identify", "joint", "identify/joint"},
    {"identify", "log", "trials/logs"},
    {"identify", "loss", "identify/loss"},
    {"identify", "method", "identify/method"},
    {"identify", "noise", "identify/noise"},
    {"identify", "surge", "trials/surge"},
    {"identify", "turning", "trials/turning"},
    {"identify", "until", "identify/until_s"},
    {"tune", "allow-unsettled", "allow_unsettled"},
    {"tune", "baseline", "baseline"},
    {"tune", "draws", "draws"},
    {"tune", "mode", "mode"},
    {"tune", "nominal", "nominal"},
    {"tune", "no-observer", "no_observer"},
    {"tune", "observer", "observer"},
    {"tune", "one-set", "one_set"},
    {"validate", "column", "columns"},
    {"validate", "log", "trials/logs"},
    {"emit", "as-is", "identify/as_is"},
    {"compare", "heading-rate-limit", "compare/heading_rate_limit"},
    {"compare", "samples", "compare/samples"},
    {"compare", "scenario", "compare/scenarios"},
};

/// Keys whose value is a list of texts.
constexpr std::string_view kLists[] = {"identify/family", "identify/fit", "identify/exclude",
                                       "compare/scenarios"};

/// Removes quotes around the whole text.
std::string_view without_quotes(std::string_view text, char quote) {
  if (text.size() < 2 || text.front() != quote || text.back() != quote) return text;
  const std::string_view inside = text.substr(1, text.size() - 2);
  return inside.find(quote) == std::string_view::npos ? inside : text;
}

/// The value of a key as JSON. A mapping of a column, NAME=EXPRESSION, becomes an object. Numbers,
/// and texts that stand for a number ("S", a time in s), are not quoted.
std::string value_as_json(std::string_view key, std::string_view value) {
  value = without_quotes(value, '\'');
  if (key == "columns") {
    const std::size_t equals = std::min(value.find('='), value.size());
    const std::string_view source =
        equals < value.size() ? value.substr(equals + 1) : std::string_view("EXPRESSION");
    return fmt::format("{{{}: {}}}", Json(value.substr(0, equals)).dump(),
                       Json(without_quotes(source, '"')).dump());
  }
  if (std::ranges::find(kLists, key) != std::end(kLists)) return Json::array({value}).dump();
  return key.ends_with("_s") || Json::accept(value) ? std::string(value) : Json(value).dump();
}

/// A key, such as "identify/family", with its value, as it stands in the JSON file:
/// `"identify": {"family": ["auto"]}`.
std::string json_member(std::string_view key, std::string_view value) {
  const std::size_t slash = key.find('/');
  const std::string_view last = key.substr(slash == std::string_view::npos ? 0 : slash + 1);
  const std::string member = fmt::format("{}: {}", Json(last).dump(), value_as_json(key, value));
  if (slash == std::string_view::npos) return member;
  return fmt::format("{}: {{{}}}", Json(key.substr(0, slash)).dump(), member);
}

/// Returns the text that replaces an option in messages to a user of project.json: the key with the
/// same effect, and its file. An option with a value becomes the JSON to write into the file. If
/// there is no such key, it is the command with the option. `option`: name of the option, possibly
/// followed by its value ("family surge=..."), as given to option_text().
std::string project_text(std::string_view command, std::string_view option) {
  std::string name(option.substr(0, option.find(' ')));
  std::ranges::replace(name, '_', '-');
  const std::string value(option.substr(name.size()));
  const auto* const key = std::ranges::find_if(
      kKeys, [&](const ProjectKey& k) { return k.command == command && k.option == name; });
  if (key == std::end(kKeys)) return fmt::format("awmr {} --{}{}", command, name, value);
  const char* const file = command == "tune" ? "tune.json" : "project.json";
  if (value.empty()) return fmt::format("`{}` of {}", key->key, file);
  return fmt::format("`{}` in {}", json_member(key->key, value.substr(1)), file);
}

}  // namespace

Result<Outcome> for_project(std::string_view command, Result<Outcome> step) {
  const auto replace = [command](std::string& text) {
    text = replace_options(
        text, [command](std::string_view option) { return project_text(command, option); });
  };
  if (step) {
    for (Finding& finding : step->findings) replace(finding.message);
  } else {
    for (Fault& fault : step.error().faults) {
      replace(fault.place);
      replace(fault.message);
    }
  }
  return step;
}

}  // namespace awmr::cli
