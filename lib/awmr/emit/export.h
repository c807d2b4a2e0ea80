/// Exports a model and its gains as parameter files of other programs: ROS 2, MATLAB, Python, CSV,
/// and rover autopilots.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "awmr/core/name_table.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/model/gains.h"
#include "awmr/model/mode_gains.h"
#include "awmr/model/model.h"

namespace awmr {

enum class ExportFormat {
  kRos2,       ///< ROS 2 parameter file (YAML) for nodes of any name
  kMatlab,     ///< MATLAB script that assigns the values to the struct `awmr`
  kPython,     ///< Python module that defines the values as constants
  kCsv,        ///< table: name,value,unit,std_error,ci95_lo,ci95_hi,source
  kArduPilot,  ///< parameter file of ArduPilot Rover (.param): NAME,VALUE
  kPx4,        ///< parameter file of PX4's rovers (.params), as QGroundControl reads it
};
inline constexpr NameTable<ExportFormat, 6> kExportFormatNames{
    {{"ros2", ExportFormat::kRos2},
     {"matlab", ExportFormat::kMatlab},
     {"python", ExportFormat::kPython},
     {"csv", ExportFormat::kCsv},
     {"ardupilot", ExportFormat::kArduPilot},
     {"px4", ExportFormat::kPx4}}};

/// Inputs of an exported file.
struct ExportSource {
  const Model& model;
  std::optional<ModeGains> gains = {};
  std::span<const InputFile> inputs = {};  ///< files of model and gains, named with their hashes
};

/// Returns the text of the file in ASCII: every value with its unit, 95 % interval and origin.
/// Unknown quantities are left out; files for autopilots give a reason for each. Errors (input),
/// only for autopilots: the model lacks the surge law or has back-EMF; not all four wheels are
/// driven.
Result<std::string> export_text(const ExportSource& source, ExportFormat format);

/// A warning (`autopilot-range`) if values of an autopilot's file are outside of the ranges in the
/// autopilot's manual. Empty for other formats. Errors: those of export_text().
Result<std::vector<Finding>> export_findings(const ExportSource& source, ExportFormat format);

}  // namespace awmr
