/// A model and its gains as other programs' parameter files: ROS 2, MATLAB, Python, CSV, and those of
/// the autopilots that rovers carry.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "awmr/core/name_table.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/model/gains.h"
#include "awmr/model/model.h"

namespace awmr {

enum class ExportFormat {
  kRos2,       ///< parameter file for any node, YAML
  kMatlab,     ///< script that fills a struct
  kPython,     ///< module of constants
  kCsv,        ///< name,value,unit,std_error,ci95_lo,ci95_hi,source
  kArduPilot,  ///< Rover's .param: NAME,VALUE
  kPx4,        ///< rover's .params, as QGroundControl reads it
};
inline constexpr NameTable<ExportFormat, 6> kExportFormatNames{
    {{"ros2", ExportFormat::kRos2},
     {"matlab", ExportFormat::kMatlab},
     {"python", ExportFormat::kPython},
     {"csv", ExportFormat::kCsv},
     {"ardupilot", ExportFormat::kArduPilot},
     {"px4", ExportFormat::kPx4}}};

/// What a file is made from.
struct ExportSource {
  const Model& model;
  std::optional<Gains<double>> gains = {};
  std::span<const InputFile> inputs = {};  ///< of the model and the gains, named in the file's head
};

/// The bytes of the file: ASCII, every value with its unit, 95 % interval and origin. What the model
/// does not know is left out; the autopilots' files say in comments what was left out and why.
/// Errors (input), of the autopilots: the model lacks the surge law.
Result<std::string> export_text(const ExportSource& source, ExportFormat format);

}  // namespace awmr
