/// Converts errors to text, for matchers.
#pragma once

#include <string>
#include <vector>

#include "awmr/core/result.h"

namespace awmr::testing {

/// Returns `PLACE: MESSAGE` of each fault of an error, the place without the directory of its file;
/// empty for a value.
template <class T>
std::vector<std::string> faults_of(const Result<T>& result) {
  std::vector<std::string> texts;
  if (result) return texts;
  for (const Fault& fault : result.error().faults) {
    texts.push_back(fault.place.substr(fault.place.rfind("a.") == std::string::npos
                                           ? 0
                                           : fault.place.rfind("a.")) +
                    ": " + fault.message);
  }
  return texts;
}

}  // namespace awmr::testing
