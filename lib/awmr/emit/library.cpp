#include <fmt/format.h>

#include "awmr/emit/emit.h"
#include "library_files.h"

namespace awmr {
namespace {

/// Text of library.properties, which the Arduino IDE requires. Gets the version and the SHA-256 of
/// the parameters.
constexpr std::string_view kProperties = R"(name=awmr
version={}
author=awmr
maintainer=awmr
sentence=Heading, speed and waypoint control of a four-wheel robot, tuned for one vehicle.
paragraph=Written by awmr emit from an identified model and tuned gains. Parameters SHA-256 {}.
category=Device Control
architectures=*
includes=awmr.h
)";

/// Text of library.json, the metadata for PlatformIO. Without this file, PlatformIO would offer the
/// library only for Arduino boards, although it runs on any chip.
constexpr std::string_view kLibraryJson = R"({{
  "name": "awmr",
  "version": "{}",
  "description": "Heading, speed and waypoint control of a four-wheel robot, tuned for one vehicle. Parameters SHA-256 {}.",
  "keywords": ["robot", "rover", "autopilot", "sliding mode control"],
  "license": "BSD-3-Clause",
  "frameworks": "*",
  "platforms": "*",
  "headers": "awmr.h",
  "examples": ["examples/*/*.ino"]
}}
)";

}  // namespace

Result<std::vector<EmittedFile>> firmware_library(const Model& model, const ModeGains& gains,
                                                  const EmitInputs& inputs,
                                                  const EmitOptions& options) {
  AWMR_ASSIGN_OR_RETURN(const AutopilotParameters parameters,
                        autopilot_parameters(model, gains, inputs, options));
  AWMR_ASSIGN_OR_RETURN(std::string header, params_header(model, gains, inputs));
  std::vector<EmittedFile> files{
      {"awmr_params.h", std::move(header)},
      {"library.properties", fmt::format(kProperties, version(), params_sha256(inputs))},
      {"library.json", fmt::format(kLibraryJson, version(), params_sha256(inputs))},
      {"src/awmr_autopilot_params.h", autopilot_header(parameters)}};
  for (const EmbeddedFile& file : embedded_files()) {
    files.push_back({std::string(file.path), std::string(file.bytes)});
  }
  return files;
}

}  // namespace awmr
