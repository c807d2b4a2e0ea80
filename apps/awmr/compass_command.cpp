#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "awmr/core/file.h"
#include "awmr/core/json/json.h"
#include "awmr/core/units.h"
#include "awmr/emit/compass_header.h"
#include "awmr/identify/compass/compass.h"
#include "commands.h"
#include "inputs.h"
#include "option_values.h"

namespace awmr::cli {
namespace {

struct CompassCommand {
  fs::path file;
  double declination_deg = 0.0;
  ColumnWords columns = {};
  fs::path output;
};

std::string line_of(const char* name, const WithInterval& value, const char* meaning) {
  return fmt::format("  {:<12} {:>12.6g}  [{:.6g}, {:.6g}]  {}\n", name, value.value, value.ci95.lo,
                     value.ci95.hi, meaning);
}

std::string summary_of(const CompassCalibration& c) {
  return line_of("centre ahead", c.centre_ahead, "hard iron, in the unit of the field") +
         line_of("centre left", c.centre_left, "") +
         line_of("gain ahead", c.gain_ahead, "soft iron") +
         line_of("gain cross", c.gain_cross, "") + line_of("gain left", c.gain_left, "") +
         line_of("field", c.field, "strength of the horizontal field") +
         fmt::format(
             "  turned {:.0f} deg; largest angle without a measurement {:.1f} deg\n"
             "  heading error of the fit {:.2f} deg (95 %); residuals {:.2f} % of the "
             "field (standard deviation), {:.2f} deg\n",
             c.turned_deg, c.largest_gap_deg, c.heading_error_deg, 100.0 * c.residual,
             degrees(c.residual));
}

Json to_json(const WithInterval& value) {
  return {{"value", value.value}, {"ci95", {value.ci95.lo, value.ci95.hi}}};
}

std::string document_of(const CompassCalibration& c) {
  Json json;
  json["centre_ahead"] = to_json(c.centre_ahead);
  json["centre_left"] = to_json(c.centre_left);
  json["gain_ahead"] = to_json(c.gain_ahead);
  json["gain_cross"] = to_json(c.gain_cross);
  json["gain_left"] = to_json(c.gain_left);
  json["field"] = to_json(c.field);
  json["residual"] = c.residual;
  json["heading_error_deg"] = c.heading_error_deg;
  json["turned_deg"] = c.turned_deg;
  json["largest_gap_deg"] = c.largest_gap_deg;
  json["declination_deg"] = c.declination_deg;
  return awmr::to_text(json);
}

Result<Outcome> execute(const CompassCommand& command) {
  AWMR_RETURN_IF_ERROR(check_output(command.output, {{command.file}}));
  AWMR_ASSIGN_OR_RETURN(const auto columns, column_mappings(command.columns));
  AWMR_ASSIGN_OR_RETURN(const FieldRecord record, read_field(command.file, columns));
  AWMR_ASSIGN_OR_RETURN(const CompassFit fit, fit_compass(record, command.declination_deg));
  AWMR_ASSIGN_OR_RETURN(const auto inputs, input_files({command.file}));
  AWMR_ASSIGN_OR_RETURN(const std::string header, compass_header(fit.calibration, inputs.front()));
  AWMR_RETURN_IF_ERROR(write_file(command.output, header));
  Outcome outcome{.summary = summary_of(fit.calibration),
                  .closing = fmt::format("wrote {}\n", command.output.string()),
                  .findings = fit.findings,
                  .document = document_of(fit.calibration),
                  .written = {command.output}};
  put_findings_into_document(outcome);
  return outcome;
}

}  // namespace

void add_compass(CLI::App& app, Session& session) {
  auto command = std::make_shared<CompassCommand>();
  CLI::App* sub =
      add_command(app, session, "compass",
                  "Calibrate a compass (hard and soft iron) from a record of two "
                  "full turns of the vehicle",
                  "awmr compass datasets/synthetic/field.csv --declination 4.5 -o awmr_compass.h",
                  [command] { return execute(*command); });
  add_file(*sub, "FILE", command->file,
           "CSV with t_s, field_ahead, field_left and yaw_rate_radps (optional, to check the "
           "signs), as the sketch CompassCalibration records it")
      ->required();
  sub->add_option("--declination", command->declination_deg,
                  "Angle from true north to magnetic north at this place, deg, east positive "
                  "(default 0: headings are relative to magnetic north)")
      ->check(within(-180.0, 180.0));
  sub->add_option("--column", command->columns.columns, kColumnHelp);
  add_output(*sub, command->output, "Header to write: FIRMWARE/src/awmr_compass.h");
}

}  // namespace awmr::cli
