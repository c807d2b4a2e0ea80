/// Every command with a model from surge runs and a coast-down: accepted if straight motion
/// suffices, else refused by name.
#include <gmock/gmock.h>

#include <filesystem>

#include "cli/program.h"

namespace awmr::testing::partial_model_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class PartialModelCommands : public ::testing::Test {
 protected:
  PartialModelCommands() {
    write_all(path("gains.json"), R"({"heading": {"lambda": 3, "mu": 50, "epsilon": 12},
                                      "speed": {"mu": 5, "epsilon": 1.2}})");
    write_all(path("straight.json"), scenario(0.0));
    write_all(path("turn.json"), scenario(0.1));
    const ProcessResult identified = awmr(
        "identify --vehicle configs/paper/vehicle.json --surge datasets/paper/surge.csv "
        "--coastdown datasets/paper/coastdown.csv -o " +
        path("model.json"));
    if (identified.exit_code != 0) throw std::runtime_error(identified.err);
  }
  std::string path(const std::string& name) const { return (directory_.path() / name).string(); }
  static std::string scenario(double tau_turn) {
    return R"({"schema": "awmr.scenario/1", "name": "open", "duration_s": 3, "speed_mps": 0,
               "initial": {"x_m": 0, "y_m": 0, "psi_deg": 0, "u_mps": 0, "v_mps": 0, "r_degps": 0},
               "guidance": {"type": "open_loop", "tau_speed": 1, "tau_turn": )" +
           std::to_string(tau_turn) + "}}";
  }
  ProcessResult run(const std::string& command) {
    return awmr(command + " --model " + path("model.json"));
  }
  TemporaryDirectory directory_;
};

TEST_F(PartialModelCommands, RunForStraightMotion) {
  for (const std::string& command :
       {"simulate --mode combined --scenario " + path("straight.json") + " -o " + path("run.csv"),
        "validate -o " + path("validation.json"), "recover --runs 5 -o " + path("recover.json"),
        "suggest -o " + path("suggest.json")}) {
    const ProcessResult result = run(command);
    EXPECT_EQ(result.exit_code, 0) << command << "\n" << result.err;
  }
  for (const char* name : {"run.csv", "validation.json", "recover.json", "suggest.json"}) {
    EXPECT_TRUE(std::filesystem::exists(path(name))) << name;
  }
}

TEST_F(PartialModelCommands, NameTheMissingParameterAndItsTrialForTurns) {
  const std::string gains = " --gains " + path("gains.json");
  const std::string turn = " --scenario " + path("turn.json");
  for (const std::string& command :
       {"simulate --mode combined" + turn, std::string("validate --claims"), "validate" + gains,
        std::string("validate --log datasets/synthetic/drive_1.csv"), std::string("tune"),
        "compare" + gains + turn, "emit" + gains, "suggest" + gains + turn,
        std::string("suggest --parameter yaw.alpha")}) {
    const ProcessResult result = run(command + " -o " + path("out"));
    EXPECT_EQ(result.exit_code, 2) << command;
    EXPECT_THAT(result.err, AllOf(HasSubstr("yaw.alpha"), HasSubstr("a turning trial"))) << command;
    EXPECT_FALSE(std::filesystem::exists(path("out"))) << command;
  }
}

}  // namespace
}  // namespace awmr::testing::partial_model_test
