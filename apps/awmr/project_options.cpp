#include "project_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

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

/// Returns the text that replaces an option in messages to a user of project.json: the key with the
/// same effect, and its file. If there is no such key, it is the command with the option. `option`:
/// name of the option, possibly followed by its value ("family surge=..."), as given to
/// option_text().
std::string project_text(std::string_view command, std::string_view option) {
  std::string name(option.substr(0, option.find(' ')));
  std::ranges::replace(name, '_', '-');
  const std::string value(option.substr(name.size()));
  const auto* const key = std::ranges::find_if(
      kKeys, [&](const ProjectKey& k) { return k.command == command && k.option == name; });
  if (key == std::end(kKeys)) return fmt::format("awmr {} --{}{}", command, name, value);
  return fmt::format("`{}`{} of {}", key->key, value,
                     command == "tune" ? "tune.json" : "project.json");
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
