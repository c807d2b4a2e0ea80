/// The report: one file, no external resources, not affected by the content of its inputs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "awmr/model/model.h"
#include "awmr/model/model_file.h"
#include "awmr/report/report.h"
#include "support/paper_vehicle.h"
#include "support/scratch_file.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Model some_model(const std::string& name) {
  Model model;
  model.vehicle = paper_vehicle();
  model.vehicle.name = name;
  model.record.provenance.command = "identify";
  return model;
}

/// A model with all parameters, so that the vehicle can turn.
Model whole_model() {
  Model model = some_model("robot");
  for (Estimate& estimate : model.estimates) estimate.value = estimate.value.value_or(0.5);
  model[ParameterId::kInertiaNorm].value =
      *model[ParameterId::kMassNorm].value * model.vehicle.inertia_kgm2() / model.vehicle.mass_kg;
  model[ParameterId::kWheelDeadZone].value = 0.01;
  return model;
}

Result<std::string> html_of(const std::filesystem::path& directory) {
  return report_page(directory).map([](const ReportPage& page) { return page.html; });
}

Result<std::string> report_of(const std::string& model_json) {
  const ScratchFile file("model.json", model_json);
  return html_of(file.path().parent_path());
}

TEST(Report, IsTheSameBytesFromTheSameFiles) {
  const std::string text = model_text(some_model("robot"));
  const auto first = report_of(text);
  const auto second = report_of(text);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(*first, *second);
}

TEST(Report, LoadsNothingFromOutside) {
  const auto html = report_of(model_text(some_model("robot")));
  ASSERT_TRUE(html);
  for (const char* loading :
       {"src=\"http", "href=\"http", "src='http", "@import", "<link", "fetch("}) {
    EXPECT_THAT(*html, Not(HasSubstr(loading))) << loading;
  }
}

TEST(Report, EscapesNamesInsideTheScript) {
  const std::string hostile = "</script><script>alert(1)</script><!-- @js@ @data@";
  const auto html = report_of(model_text(some_model(hostile)));
  ASSERT_TRUE(html);
  EXPECT_THAT(*html, Not(HasSubstr("</script><script>alert(1)")));
  EXPECT_THAT(*html, Not(HasSubstr("<script>alert(1)")));
  // The page contains the hostile name in escaped form and thus shows it unchanged.
  EXPECT_THAT(*html, HasSubstr("alert(1)"));
}

TEST(Report, NamesThePlaceOfAFault) {
  const auto syntax = report_of("{\"schema\": \"awmr.model/1\",\n  oops}");
  ASSERT_FALSE(syntax);
  EXPECT_THAT(syntax.error().faults.front().place, HasSubstr("model.json:2:"));
  const auto keys = report_of("{\"schema\": \"awmr.model/1\"}");
  ASSERT_FALSE(keys);
  EXPECT_THAT(to_text(keys.error()), HasSubstr("/vehicle"));
  EXPECT_EQ(exit_code(keys.error()), 2);
}

TEST(Report, NeedsAModelAndRefusesABrokenCompanion) {
  const ScratchFile other("notes.txt", "no model here");
  EXPECT_FALSE(html_of(other.path().parent_path()));
  const ScratchFile model("model.json", model_text(some_model("robot")));
  std::ofstream(model.path().parent_path() / "gains.json") << "{";
  const auto broken = html_of(model.path().parent_path());
  ASSERT_FALSE(broken);
  EXPECT_THAT(broken.error().faults.front().place, HasSubstr("gains.json"));
}

// The report's live part (sliders) also reads draws, noise and constraints from gains.json.
TEST(Report, NamesThePlaceWhereGainsDoNotSayHowTheyWereTuned) {
  const ScratchFile model("model.json", model_text(whole_model()));
  const std::string gains = R"({"schema": "awmr.gains/1",
    "heading": {"lambda": 3, "mu": 50, "epsilon": 12}, "speed": {"mu": 5, "epsilon": 1.2})";
  const auto report_with = [&](const std::string& more) {
    std::ofstream(model.path().parent_path() / "gains.json") << gains << more << "}";
    return html_of(model.path().parent_path());
  };
  ASSERT_TRUE(report_with(""));
  if (report_with("")->find("id=\"wasm\"></script>") != std::string::npos) GTEST_SKIP();
  for (const char* more :
       {R"(, "robust": {"draws": "many"})", R"(, "robust": [])", R"(, "constraints": [3])",
        R"(, "constraints": [{"name": 1, "required": true, "limit": 2}])",
        R"(, "robust": {"draws": 2, "seed": 1, "noise": {"heading_deg": 1}, "latency":
           {"heading_s": 1e9, "yaw_rate_s": 0}, "motor_time_constant_s": 0})"}) {
    const auto report = report_with(more);
    ASSERT_FALSE(report) << more;
    EXPECT_THAT(report.error().faults.front().place, HasSubstr("gains.json:/")) << more;
    EXPECT_EQ(exit_code(report.error()), 2);
  }
}

}  // namespace
}  // namespace awmr::testing
