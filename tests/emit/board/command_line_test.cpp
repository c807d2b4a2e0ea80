/// Commands as lines and frames: accepted, rejected, and STOP always acts.
#include "awmr/emit/board/command_line.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace awmr::testing {
namespace {

struct Heard {
  CommandVerdict verdict;
  CommandWord word;
  float value;
};

/// Reads the characters and returns each verdict.
std::vector<Heard> hear(CommandReader& reader, const std::string& text) {
  std::vector<Heard> heard;
  for (const char c : text) {
    const CommandVerdict verdict = reader.take(c);
    if (verdict != CommandVerdict::kNone) heard.push_back({verdict, reader.word, reader.value});
  }
  return heard;
}

std::string frame(const std::string& covered) {
  const std::uint16_t crc =
      crc16_of(reinterpret_cast<const std::uint8_t*>(covered.data()), covered.size());
  return fmt::format("#{}*{:04X}\n", covered, crc);
}

CommandVerdict only_verdict(CommandReader& reader, const std::string& text) {
  const auto heard = hear(reader, text);
  EXPECT_EQ(heard.size(), 1U) << text;
  return heard.empty() ? CommandVerdict::kNone : heard[0].verdict;
}

TEST(CommandLine, TakesWholeLines) {
  struct Line {
    const char* text;
    CommandWord word;
    float value;
  };
  for (const Line& line :
       {Line{"ARM\n", CommandWord::kArm, 0.0F}, Line{"arm\r\n", CommandWord::kArm, 0.0F},
        Line{"KEEP\n", CommandWord::kKeep, 0.0F}, Line{"K\n", CommandWord::kKeep, 0.0F},
        Line{"G\n", CommandWord::kGo, 0.0F}, Line{"S 0\n", CommandWord::kSpeed, 0.0F},
        Line{"S -0.25\n", CommandWord::kSpeed, -0.25F},
        Line{"H +30.5\n", CommandWord::kHeading, 30.5F}, Line{"M 2\n", CommandWord::kMode, 2.0F}}) {
    CommandReader reader;
    const auto heard = hear(reader, line.text);
    ASSERT_EQ(heard.size(), 1U) << line.text;
    EXPECT_EQ(heard[0].verdict, CommandVerdict::kTaken) << line.text;
    EXPECT_EQ(heard[0].word, line.word) << line.text;
    EXPECT_EQ(heard[0].value, line.value) << line.text;
  }
}

TEST(CommandLine, RefusesInvalidCommands) {
  for (const char* text :
       {"....S 0\n", "S\n",    "S \n",     "S 1e9\n", "S nan\n",   "S 1 2\n",
        "S1\n",      "S  1\n", "S -\n",    "S .\n",   "S 1.2.3\n", "S 123456789\n",
        "H\n",       "G 1\n",  "ARMED\n",  "AR\n",    "X\n",       " ARM\n",
        "ARM \n",    "S 1;\n", "\x01RM\n", "\xff\n"}) {
    CommandReader reader;
    EXPECT_EQ(only_verdict(reader, text), CommandVerdict::kUnknown) << text;
  }
  CommandReader reader;
  EXPECT_TRUE(hear(reader, "\n\r\n\n").empty());
  EXPECT_EQ(only_verdict(reader, std::string(32, 'K') + "\n"), CommandVerdict::kTooLong);
  EXPECT_EQ(only_verdict(reader, std::string(300, 'K') + "\n"), CommandVerdict::kTooLong);
  EXPECT_EQ(only_verdict(reader, "K\n"), CommandVerdict::kTaken);
}

TEST(CommandLine, StopActsAtItsLastLetterAnywhereInALine) {
  for (const std::string& before : {std::string(), std::string("...."), std::string("S 1 S"),
                                    std::string("SS"), std::string("STO"), std::string(200, 'x'),
                                    std::string("#7 "), std::string("\xff\x00", 2)}) {
    for (const char* stop : {"STOP", "stop", "Stop"}) {
      CommandReader reader;
      const auto heard = hear(reader, before + stop);
      ASSERT_EQ(heard.size(), 1U) << before;
      EXPECT_EQ(heard[0].word, CommandWord::kStop);
      // The rest of the line is not a command, the next line is.
      EXPECT_TRUE(hear(reader, " and S 1\n").empty());
      EXPECT_EQ(only_verdict(reader, "K\n"), CommandVerdict::kTaken);
    }
  }
  CommandReader reader;
  EXPECT_EQ(only_verdict(reader, "ST OP\n"), CommandVerdict::kUnknown);
}

TEST(CommandFrame, TakesEachSequenceNumberOnce) {
  CommandReader reader;
  EXPECT_EQ(only_verdict(reader, frame("250 ARM")), CommandVerdict::kTaken);
  EXPECT_TRUE(reader.is_framed);
  EXPECT_EQ(reader.sequence, 250);
  EXPECT_EQ(only_verdict(reader, frame("250 ARM")), CommandVerdict::kRepeated);
  EXPECT_EQ(only_verdict(reader, frame("249 KEEP")), CommandVerdict::kRepeated);
  EXPECT_EQ(only_verdict(reader, frame("1 S 0.5")), CommandVerdict::kTaken);
  EXPECT_EQ(reader.value, 0.5F);
  EXPECT_EQ(only_verdict(reader, frame("127 X")), CommandVerdict::kUnknown);
  EXPECT_EQ(only_verdict(reader, frame("127 KEEP")), CommandVerdict::kRepeated);
}

TEST(CommandFrame, RefusesARecordingOfLessThan130Frames) {
  for (const int count : {20, 129, 130}) {
    CommandReader reader;
    for (int i = 0; i < count; ++i) {
      ASSERT_EQ(only_verdict(reader, frame(std::to_string(i) + " K")), CommandVerdict::kTaken);
    }
    for (int i = 0; i < count; ++i) {
      EXPECT_EQ(only_verdict(reader, frame(std::to_string(i) + " K")),
                count < 130 ? CommandVerdict::kRepeated : CommandVerdict::kTaken)
          << count << " " << i;
    }
  }
}

TEST(CommandFrame, RefusesDamageAndTextAfterIt) {
  CommandReader reader;
  const std::string good = frame("1 S 0.5");
  for (std::size_t i = 0; i + 1 < good.size(); ++i) {
    for (unsigned bit = 0; bit < 7; ++bit) {
      std::string bad = good;
      bad[i] = static_cast<char>(bad[i] ^ (1U << bit));
      CommandReader fresh;
      for (const Heard& heard : hear(fresh, bad)) {
        // A flipped bit may change only the case of a letter, also in the checksum. Case is
        // ignored, so the frame is then still accepted.
        if (heard.verdict != CommandVerdict::kTaken) continue;
        EXPECT_EQ(heard.word, CommandWord::kSpeed) << bad;
        EXPECT_EQ(heard.value, 0.5F) << bad;
      }
    }
  }
  for (const char* text : {"#\n", "#*\n", "#1 K\n", "#1 K*\n", "#1 K*12\n", "#1 K*0000\n"}) {
    EXPECT_EQ(only_verdict(reader, text), CommandVerdict::kDamaged) << text;
  }
  EXPECT_EQ(only_verdict(reader, frame("256 KEEP")), CommandVerdict::kDamaged);
  EXPECT_EQ(only_verdict(reader, frame("x KEEP")), CommandVerdict::kDamaged);
  EXPECT_EQ(only_verdict(reader, "K\n"), CommandVerdict::kTaken);
  EXPECT_EQ(only_verdict(reader, good), CommandVerdict::kTaken);
  EXPECT_EQ(only_verdict(reader, "K\n"), CommandVerdict::kTextLocked);
  EXPECT_EQ(hear(reader, "STOP\n").at(0).word, CommandWord::kStop);
}

}  // namespace
}  // namespace awmr::testing
