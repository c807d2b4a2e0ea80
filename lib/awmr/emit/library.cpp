#include <fmt/format.h>

#include "awmr/emit/emit.h"
#include "library_files.h"

namespace awmr {
namespace {

/// The Arduino library specification's metadata; PlatformIO reads it too.
constexpr std::string_view kProperties = R"(name=awmr
version={}
author=awmr
maintainer=awmr
sentence=Heading, speed and waypoint control of a four-wheel robot, tuned for one vehicle.
paragraph=Written by awmr emit from an identified model and tuned gains. Parameters SHA-256 {}.
category=Device Control
url=
architectures=*
includes=awmr.h
)";

}  // namespace

Result<std::vector<EmittedFile>> firmware_library(const Model& model, const Gains<double>& gains,
                                                  const EmitInputs& inputs,
                                                  const EmitOptions& options) {
  AWMR_ASSIGN_OR_RETURN(const AutopilotParameters parameters,
                        autopilot_parameters(model, gains, inputs, options));
  AWMR_ASSIGN_OR_RETURN(std::string header, params_header(model, gains, inputs));
  std::vector<EmittedFile> files{
      {"awmr_params.h", std::move(header)},
      {"library.properties", fmt::format(kProperties, version(), params_sha256(inputs))},
      {"src/awmr_autopilot_params.h", autopilot_header(parameters)}};
  for (const EmbeddedFile& file : embedded_files()) {
    files.push_back({std::string(file.path), std::string(file.bytes)});
  }
  return files;
}

}  // namespace awmr
