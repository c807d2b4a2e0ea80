#include "identify_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "awmr/core/containers.h"
#include "awmr/core/csv/csv_cell.h"
#include "awmr/core/nearest.h"

namespace awmr::cli {
namespace {

std::string text_of(const FamilyChoice& choice) {
  return choice.family ? std::string(name_of(*choice.family)) : std::string("auto");
}

tl::unexpected<Error> dead_zone_of_yaw(std::string_view name) {
  return input_error(
      ErrorCode::kConflict, "--family",
      fmt::format("a dead zone is a property of the motors, not of the yaw resistance: use "
                  "surge={}, which also corrects the turning",
                  name));
}

}  // namespace

Status add_family(std::string_view text, IdentifyOptions& options) {
  const std::size_t equals = text.find('=');
  const std::string_view subject = equals == std::string_view::npos ? "" : text.substr(0, equals);
  const std::string_view name = equals == std::string_view::npos ? text : text.substr(equals + 1);
  FamilyChoice choice{.family = std::nullopt, .requested = true};
  if (name != "auto") {
    choice.family = value_in(kFamilyNames, name);
    if (!choice.family) {
      return input_error(ErrorCode::kUnknownName, "--family",
                         fmt::format("no family is called '{}'; the names are {}, auto", name,
                                     fmt::join(names_in(kFamilyNames), ", ")));
    }
  }
  const bool again = (subject != "yaw" && options.surge_family.requested) ||
                     (subject != "surge" && options.yaw_family.requested);
  if (again) {
    return input_error(ErrorCode::kGivenTwice, "--family",
                       fmt::format("'{}' selects a second family for the same resistance; give "
                                   "one family for surge and one for yaw",
                                   text));
  }
  if (subject.empty()) {
    options.surge_family = options.yaw_family = choice;
  } else if (subject == "surge") {
    options.surge_family = choice;
  } else if (subject == "yaw") {
    if (choice.family && terms_of(*choice.family).dead_zone) return dead_zone_of_yaw(name);
    options.yaw_family = choice;
  } else {
    return input_error(
        ErrorCode::kUnknownName, "--family",
        fmt::format("'{}' is neither surge nor yaw; give surge=NAME or yaw=NAME", subject));
  }
  return {};
}

namespace {

/// Returns the error for a name that --fit does not accept. `names`: all names that --fit accepts.
tl::unexpected<Error> unknown_request(std::string_view name,
                                      const std::vector<std::string>& names) {
  const std::vector<std::string> automatic = automatic_terms();
  if (contains(automatic, name)) {
    return input_error(ErrorCode::kUnknownName, "--fit",
                       fmt::format("'{}' cannot be requested: a fit of logs estimates it by "
                                   "itself if the logs indicate it; leave it out",
                                   name));
  }
  const auto id = parameter_by_name(name);
  if (id) {
    return input_error(
        ErrorCode::kUnknownName, "--fit",
        fmt::format("'{}' is a term of a resistance family; request it by --family", name));
  }
  const std::string near = nearest(name, names);
  const std::string remedy = near.empty() ? fmt::format("the names are {}", fmt::join(names, ", "))
                                          : fmt::format("did you mean '{}'?", near);
  return input_error(ErrorCode::kUnknownName, "--fit",
                     fmt::format("no parameter is called '{}'; {}", name, remedy));
}

}  // namespace

Status add_requested(std::string_view name, IdentifyOptions& options) {
  if (name == "all") {
    options.requested_all = true;
    for (const ParameterInfo& parameter : parameter_table()) {
      if (!parameter.term) options.requested.push_back(parameter.id);
    }
    return {};
  }
  std::vector<std::string> names;
  for (const ParameterInfo& p : parameter_table()) {
    if (can_be_requested(p)) names.emplace_back(p.name);
  }
  names.emplace_back("all");
  for (const LogChannel channel : kChannels) {
    const std::string bias = fmt::format("{}{}", kBiasPrefix, info(channel).name);
    if (name == bias) {
      options.biases.push_back(channel);
      return {};
    }
    names.push_back(bias);
  }
  for (const std::string& term : requestable_terms()) {
    if (name == term) {
      options.terms.push_back(term);
      return {};
    }
    names.push_back(term);
  }
  const auto id = parameter_by_name(name);
  if (!id || !can_be_requested(info(*id))) return unknown_request(name, names);
  options.requested.push_back(*id);
  return {};
}

Status add_excluded(std::string_view text, TrialOptions& trials) {
  const std::size_t colon = text.find(':');
  const auto from_s = number_from_text(text.substr(0, colon));
  const auto until_s =
      number_from_text(colon == std::string_view::npos ? "" : text.substr(colon + 1));
  if (!from_s || !until_s || !(*from_s < *until_s)) {
    return input_error(
        ErrorCode::kOutOfRange, "--exclude",
        fmt::format("'{}' is not a span of time: give A:B in s, A before B, such as 12.5:40",
                    text));
  }
  trials.excluded_s.push_back({*from_s, *until_s});
  return {};
}

Status check_used(const TrialOptions& trials) {
  if (trials.used_s.lo < trials.used_s.hi) return {};
  return input_error(ErrorCode::kWrongOrder, "--until",
                     fmt::format("{:g} s is not after --from {:g} s; give a later time",
                                 trials.used_s.hi, trials.used_s.lo));
}

Status use_parts(const std::vector<std::string>& excluded, TrialOptions& trials) {
  AWMR_RETURN_IF_ERROR(check_used(trials));
  for (const std::string& span : excluded) AWMR_RETURN_IF_ERROR(add_excluded(span, trials));
  return {};
}

NamedOptions described(const IdentifyOptions& options) {
  NamedOptions words{
      {"method",
       std::string(options.method ? name_in(kMethodNames, *options.method) : "by the data")},
      {"noise",
       std::string(options.noise ? name_in(kErrorModelNames, *options.noise) : "as measured")},
      {"family",
       fmt::format("surge={} yaw={}", text_of(options.surge_family), text_of(options.yaw_family))},
      {"loss", std::string(name_in(kLossNames, options.loss))}};
  if (options.joint) words.emplace_back("joint", "true");
  for (const ParameterId id : options.requested) words.emplace_back("fit", info(id).name);
  for (const std::string& term : options.terms) words.emplace_back("fit", term);
  for (const LogChannel channel : options.biases) {
    words.emplace_back("fit", fmt::format("{}{}", kBiasPrefix, info(channel).name));
  }
  words.emplace_back("seed", std::to_string(options.seed));
  words.emplace_back("starts", std::to_string(options.starts));
  if (options.time_limit_s > 0.0) {
    words.emplace_back("time_limit_s", fmt::format("{:g}", options.time_limit_s));
  }
  words.emplace_back("bootstrap", std::to_string(options.bootstrap));
  return words;
}

void describe_parts(const TrialOptions& trials, NamedOptions& words) {
  const TrialOptions whole;
  if (trials.used_s.lo > whole.used_s.lo) {
    words.emplace_back("from", fmt::format("{}", trials.used_s.lo));
  }
  if (trials.used_s.hi < whole.used_s.hi) {
    words.emplace_back("until", fmt::format("{}", trials.used_s.hi));
  }
  for (const Interval& span : trials.excluded_s) {
    words.emplace_back("exclude", fmt::format("{}:{}", span.lo, span.hi));
  }
}

void describe_reading(const TrialFiles& trials, NamedOptions& words) {
  const TrialOptions& options = trials.options;
  words.emplace_back("prefer", name_in(kPreferenceNames, options.preference));
  if (options.as_is) words.emplace_back("as-is", "true");
  describe_parts(options, words);
  if (trials.steady_from_logs) words.emplace_back("steady_from_logs", "true");
  for (const ColumnMapping& mapping : options.columns) {
    words.emplace_back("column", text_of(mapping));
  }
}

}  // namespace awmr::cli
