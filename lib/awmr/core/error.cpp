#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "awmr/core/option_text.h"
#include "awmr/core/result.h"
#include "awmr/core/text.h"

namespace awmr {
namespace {

constexpr std::size_t kMaxFaultsShown = 20;
/// Maximum number of faults with the same cause that are listed one by one.
constexpr std::size_t kMaxAlike = 3;

/// Place of a fault without line and column, or without array indices in the JSON pointer.
std::string file_and_keys(const std::string& place) {
  std::string text = place;
  const std::size_t pointer = place.find(":/");
  if (pointer != std::string::npos) {
    text.erase(
        std::remove_if(text.begin() + static_cast<std::ptrdiff_t>(pointer), text.end(), is_digit),
        text.end());
    return text;
  }
  const std::size_t end = text.find_last_not_of("0123456789:");
  return text.substr(0, end == std::string::npos ? 0 : end + 1);
}

/// Text that is the same for all faults with one cause: the file and the message, without numbers
/// and quoted values.
std::string cause_of(const Fault& fault) {
  std::string cause = file_and_keys(fault.place) + '\n';
  bool is_quoted = false;
  for (const char c : fault.message) {
    if (c == '"') is_quoted = !is_quoted;
    const bool is_value = is_digit(c) || c == '.' || c == ',' || c == '-' || c == '+';
    if (!is_quoted && !is_value) cause += c;
  }
  return cause;
}

/// If more than kMaxAlike faults have the same cause, keeps only the first fault and adds the
/// number of the omitted faults to its message.
std::vector<Fault> without_repeats(const std::vector<Fault>& faults) {
  std::map<std::string, std::size_t> counts;
  for (const Fault& fault : faults) ++counts[cause_of(fault)];
  std::vector<Fault> first_ones;
  for (const Fault& fault : faults) {
    std::size_t& count = counts[cause_of(fault)];
    if (count == 0) continue;
    first_ones.push_back(fault);
    if (count <= kMaxAlike || fault.place.empty()) continue;
    first_ones.back().message +=
        fmt::format("; {}{} more faults in this file have the same cause",
                    faults.size() >= kMaxFaults ? "at least " : "", count - 1);
    count = 0;
  }
  return first_ones;
}

}  // namespace

tl::unexpected<Error> input_error(ErrorCode code, std::string place, std::string message) {
  return tl::unexpected(Error{ErrorKind::kInput, {{code, std::move(place), std::move(message)}}});
}

tl::unexpected<Error> refusal(ErrorCode code, std::string message) {
  return tl::unexpected(Error{ErrorKind::kRefused, {{code, "", std::move(message)}}});
}

tl::unexpected<Error> program_fault(std::string message) {
  return tl::unexpected(Error{ErrorKind::kFault, {{ErrorCode::kInternal, "", std::move(message)}}});
}

tl::unexpected<Error> input_errors(std::vector<Fault> faults) {
  return tl::unexpected(Error{ErrorKind::kInput, std::move(faults)});
}

std::vector<Fault> shown_faults(const std::vector<Fault>& all) {
  const std::vector<Fault> faults = without_repeats(all);
  if (faults.size() <= kMaxFaultsShown) return faults;
  std::vector<Fault> shown(faults.begin(), faults.begin() + kMaxFaultsShown);
  const std::size_t left = faults.size() - kMaxFaultsShown;
  shown.push_back({ErrorCode::kMoreFaults, "",
                   fmt::format("{} more fault{} not shown", left, left == 1 ? " is" : "s are")});
  return shown;
}

std::string to_text(const Fault& fault, std::string_view prefix) {
  const std::string message = printable(shortened(spell_options(fault.message, prefix)));
  const std::string place = printable(shortened(spell_options(fault.place, prefix)));
  return fmt::format("{}{}{} [{}]", place, place.empty() ? "" : ": ", message,
                     name_in(kErrorCodeNames, fault.code));
}

std::string to_text(const Error& error, std::string_view prefix) {
  std::string text;
  for (const Fault& fault : shown_faults(error.faults)) {
    text += fmt::format("error: {}\n", to_text(fault, prefix));
  }
  return text;
}

int exit_code(const Error& error) {
  switch (error.kind) {
    case ErrorKind::kInput:
      return 2;
    case ErrorKind::kRefused:
      return 1;
    case ErrorKind::kFault:
      return 3;
  }
  return 3;
}

}  // namespace awmr
