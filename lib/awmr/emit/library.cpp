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
  const auto parameters = autopilot_parameters(model, gains, inputs, options);
  if (!parameters) return tl::unexpected(parameters.error());
  const auto header = params_header(model, gains, inputs);
  if (!header) return tl::unexpected(header.error());
  std::vector<EmittedFile> files{
      {"awmr_params.h", *header},
      {"library.properties", fmt::format(kProperties, version(), params_sha256(inputs))},
      {"src/awmr_autopilot_params.h", autopilot_header(*parameters)}};
  for (const EmbeddedFile& file : embedded_files()) {
    files.push_back({std::string(file.path), std::string(file.bytes)});
  }
  return files;
}

}  // namespace awmr
