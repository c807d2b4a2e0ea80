/// awmr_params.h in compilers: as C and C++, on the host and for the ATmega2560, with warnings as
/// errors. Its values are read back from the compiled object, and its checks fail when they should.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <iterator>
#include <limits>
#include <ostream>
#include <vector>

#include "emit/paper_robot.h"
#include "support/toolchain.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;

struct Compiler {
  const char* name;
  const char* program;
  const char* standard;
  bool is_cxx;
  bool is_avr;
};

void PrintTo(const Compiler& compiler, std::ostream* out) { *out << compiler.name; }

constexpr Compiler kCompilers[] = {
    {"GccC89", kGcc, "c89", false, false},          {"GccC99", kGcc, "c99", false, false},
    {"GccC17", kGcc, "c17", false, false},          {"ClangC89", kClang, "c89", false, false},
    {"ClangC99", kClang, "c99", false, false},      {"GccCxx98", kGxx, "c++98", true, false},
    {"GccCxx11", kGxx, "c++11", true, false},       {"GccCxx14", kGxx, "c++14", true, false},
    {"GccCxx20", kGxx, "c++20", true, false},       {"ClangCxx14", kClangxx, "c++14", true, false},
    {"ClangCxx20", kClangxx, "c++20", true, false}, {"AvrC89", kAvrGcc, "c89", false, true},
    {"AvrC99", kAvrGcc, "c99", false, true},        {"AvrCxx11", kAvrGxx, "c++11", true, true},
    {"AvrCxx14", kAvrGxx, "c++14", true, true},
};

/// Model with values that are hard to write as float literals: ends of the range, whole numbers
/// above 2^24, values whose ninth digit matters, values with an exponent.
Model strained_robot() {
  Model model = paper_robot();
  using Limits = std::numeric_limits<float>;
  model[ParameterId::kSurgeAlpha].value = static_cast<double>(Limits::max());
  model[ParameterId::kSurgeBeta].value = 0.0;
  model[ParameterId::kYawAlpha].value = static_cast<double>(Limits::min());
  model[ParameterId::kYawBeta].value = 1.0 / 3.0;
  model[ParameterId::kSwayAlpha].value = 16777217.0;  // 2^24 + 1 is not a float
  model[ParameterId::kMassNorm].value = 1e9;
  model[ParameterId::kInertiaNorm].value = 1.00000012;  // nearly 1 + 2^-23
  model.vehicle.wheel_force = {-0.1, 0.1};
  model.vehicle.name = "/* strained */ \?\?/";
  return model;
}

class CompiledHeader : public ::testing::TestWithParam<Compiler> {
 protected:
  void SetUp() override {
    const std::string program = GetParam().program;
    const bool is_clang = program == kClang || program == kClangxx;
    if (is_clang && !found(program)) GTEST_SKIP() << "clang is not installed (scripts/setup ci)";
    ASSERT_TRUE(found(program));
  }

  void write_header(const std::string& header) const {
    write_all(directory_.path() / "awmr_params.h", header);
  }

  ProcessResult compile(const std::string& source, const std::string& options) const {
    const Compiler& compiler = GetParam();
    const std::string file = compiler.is_cxx ? "use.cpp" : "use.c";
    write_all(directory_.path() / file, source);
    return run_process(std::string("'") + compiler.program + "' -std=" + compiler.standard +
                           (compiler.is_avr ? " -mmcu=atmega2560" : "") +
                           " -Wall -Wextra -Wpedantic -pedantic-errors -Wconversion -Wshadow "
                           "-Werror " +
                           options + " " + file,
                       directory_.path());
  }

  std::vector<float> compiled_values(const std::vector<std::string>& names) const;

  TemporaryDirectory directory_;
};

std::string comma_separated(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += "  " + name + ",\n";
  return text.substr(0, text.size() - 2) + "\n";
}

/// Compiles an array of the macros' values into its own section, which objcopy extracts from the
/// object file. This gives the bits that the compiler made without executing the program. Host and
/// AVR are both little-endian IEEE 754.
std::vector<float> CompiledHeader::compiled_values(const std::vector<std::string>& names) const {
  const std::string source =
      "#include \"awmr_params.h\"\n#include \"awmr_params.h\"\n"
      "extern const float awmr_values[" +
      std::to_string(names.size()) +
      "];\n"
      "const float awmr_values[] __attribute__((section(\".awmr_values\"))) = {\n" +
      comma_separated(names) + "};\n";
  const ProcessResult compiled = compile(source, "-c -o use.o");
  EXPECT_TRUE(succeeded(compiled));
  EXPECT_EQ(compiled.err, "");
  const std::string objcopy = GetParam().is_avr ? kAvrObjcopy : kObjcopy;
  EXPECT_TRUE(found(objcopy));
  EXPECT_TRUE(succeeded(run_process("'" + objcopy + "' -O binary -j .awmr_values use.o values.bin",
                                    directory_.path())));
  const std::string bytes = read_all(directory_.path() / "values.bin");
  std::vector<float> values;
  for (std::size_t at = 0; at + 4 <= bytes.size(); at += 4) {
    std::uint32_t bits = 0;
    for (std::size_t i = 4; i-- > 0;) bits = bits << 8U | static_cast<std::uint8_t>(bytes[at + i]);
    values.push_back(std::bit_cast<float>(bits));
  }
  return values;
}

TEST_P(CompiledHeader, HoldsEveryValueBitForBit) {
  for (const Model& model : {paper_robot(), strained_robot()}) {
    write_header(params_header(model, kPaperGains, paper_inputs()).value());
    std::vector<std::string> names;
    std::vector<std::uint32_t> expected;
    for (const auto& [name, value] : expected_macros(model, kPaperGains)) {
      names.push_back(name);
      expected.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
    }
    const std::vector<float> values = compiled_values(names);
    ASSERT_EQ(values.size(), expected.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      EXPECT_EQ(std::bit_cast<std::uint32_t>(values[i]), expected[i])
          << names[i] << " " << values[i];
    }
  }
}

class HostProgram : public CompiledHeader {};

TEST_P(HostProgram, PrintsTheSameNumbers) {
  write_header(params_header(paper_robot(), kPaperGains, paper_inputs()).value());
  std::string source = "#include \"awmr_params.h\"\n#include <stdio.h>\nint main(void) {\n";
  std::string expected;
  for (const auto& [name, value] : expected_macros(paper_robot(), kPaperGains)) {
    source += "  printf(\"%.17g\\n\", (double)" + name + ");\n";
    char line[64];
    std::snprintf(line, sizeof line, "%.17g\n", static_cast<double>(static_cast<float>(value)));
    expected += line;
  }
  source += "  printf(\"%s\\n\", AWMR_PARAMS_SHA256);\n  return 0;\n}\n";
  expected += params_sha256(paper_inputs()) + "\n";
  ASSERT_TRUE(succeeded(compile(source, "-o use")));
  const ProcessResult run = run_process("./use", directory_.path());
  ASSERT_TRUE(succeeded(run));
  EXPECT_EQ(run.out, expected);
}

constexpr const char* kUse = "#include \"awmr_params.h\"\nint main(void) { return 0; }\n";

TEST_P(CompiledHeader, DoesNotCompileWhenEditedToAValueThatIsNotPositive) {
  const std::string header = params_header(paper_robot(), kPaperGains, paper_inputs()).value();
  for (const char* literal : {"0.0f", "(-1e-30f)"}) {
    std::string edited = header;
    std::vector<std::string> checks;
    for (const auto& [name, value] : expected_macros(paper_robot(), kPaperGains)) {
      if (name == "AWMR_WHEEL_FORCE_MIN" || name.ends_with("_BETA")) continue;
      edited = with_macro(edited, name, literal);
      checks.push_back(name + "_IS_POSITIVE");
    }
    write_header(edited);
    // The compiler's message must name the check, so that the failure of another check does not
    // count.
    const bool is_clang = std::string(GetParam().name).starts_with("Clang");
    const ProcessResult result =
        compile(kUse, is_clang ? "-fsyntax-only -ferror-limit=0" : "-fsyntax-only");
    EXPECT_NE(result.exit_code, 0);
    for (const std::string& check : checks) EXPECT_THAT(result.err, HasSubstr(check));
  }
}

struct Edit {
  const char* check;
  std::vector<std::pair<const char*, const char*>> macros;
};

TEST_P(CompiledHeader, DoesNotCompileWhenEditedAgainstARelation) {
  const std::vector<Edit> edits = {
      // violated: T2 = 100/(2*50) = 1 s is above T1 = 1/3 s
      {"AWMR_T2_IS_BELOW_T1", {{"AWMR_HEADING_EPSILON", "100.0f"}}},
      // violated: T2 = 12/(2*18) = 1/3 s equals T1
      {"AWMR_T2_IS_BELOW_T1", {{"AWMR_HEADING_MU", "18.0f"}}},
      {"AWMR_T2_IS_BELOW_T1", {{"AWMR_HEADING_LAMBDA", "8.34f"}}},
      {"AWMR_WHEEL_FORCE_MIN_IS_BELOW_MAX", {{"AWMR_WHEEL_FORCE_MIN", "1.0f"}}},
      {"AWMR_STEERING_MAX_RAD_IS_BELOW_HALF_PI", {{"AWMR_STEERING_MAX_RAD", "20.0f"}}},
      {"AWMR_SURGE_BETA_IS_NOT_NEGATIVE", {{"AWMR_SURGE_BETA", "(-0.1f)"}}},
      {"AWMR_YAW_BETA_IS_NOT_NEGATIVE", {{"AWMR_YAW_BETA", "(-0.1f)"}}},
  };
  const std::string header = params_header(paper_robot(), kPaperGains, paper_inputs()).value();
  for (const Edit& edit : edits) {
    std::string edited = header;
    for (const auto& [name, literal] : edit.macros) edited = with_macro(edited, name, literal);
    write_header(edited);
    const ProcessResult result = compile(kUse, "-fsyntax-only");
    EXPECT_NE(result.exit_code, 0) << edit.check;
    EXPECT_THAT(result.err, HasSubstr(edit.check));
  }
}

TEST_P(CompiledHeader, CompilesJustInsideTheLimit) {
  // T2 < T1 = 1/3 s holds for mu > 18, so the next float above 18 is accepted.
  const std::string header = params_header(paper_robot(), kPaperGains, paper_inputs()).value();
  write_header(with_macro(header, "AWMR_HEADING_MU", "18.0000019f"));
  EXPECT_TRUE(succeeded(compile(kUse, "-fsyntax-only")));
}

constexpr auto kName = [](const auto& test) { return std::string(test.param.name); };

INSTANTIATE_TEST_SUITE_P(, CompiledHeader, ::testing::ValuesIn(kCompilers), kName);

std::vector<Compiler> host_compilers() {
  std::vector<Compiler> compilers(std::begin(kCompilers), std::end(kCompilers));
  std::erase_if(compilers, [](const Compiler& compiler) { return compiler.is_avr; });
  return compilers;
}

INSTANTIATE_TEST_SUITE_P(, HostProgram, ::testing::ValuesIn(host_compilers()), kName);

}  // namespace
}  // namespace awmr::testing
