#include "frame_link.h"

#include <fmt/format.h>

#include "firmware/frame.h"
#include "wire.h"

namespace awmr::pil {
namespace {

/// At one bit in a thousand damaged, four exchanges of ten succeed: 40 in a row fail once in 1e9.
constexpr int kAttempts = 40;
/// The first request is short, and nobody may be there to answer.
constexpr int kStartAttempts = 10;

/// A request as it goes over the line.
std::vector<std::uint8_t> framed(std::uint8_t type, std::uint8_t sequence,
                                 std::span<const std::uint8_t> payload) {
  std::vector<std::uint8_t> frame{::pil::kFrameStart, type, sequence,
                                  static_cast<std::uint8_t>(payload.size())};
  frame.insert(frame.end(), payload.begin(), payload.end());
  const std::uint16_t crc = crc16_of(frame.data() + 1, frame.size() - 1);
  frame.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8U));
  return frame;
}

class FrameLink : public Chip {
 public:
  FrameLink(std::unique_ptr<Line> line, std::uint32_t parameters_crc)
      : line_(std::move(line)), parameters_crc_(parameters_crc) {}

  Result<std::uint8_t> start() override {
    if (auto open = line_->open(); !open) return tl::unexpected(open.error());
    if (auto answered = exchange(::pil::kHello, {}, 5); !answered) {
      return tl::unexpected(answered.error());
    }
    Reader reader(payload());
    const auto fault = reader.get<std::uint8_t>();
    const auto crc = reader.get<std::uint32_t>();
    if (crc != parameters_crc_) {
      return input_error(
          "--port",
          fmt::format("the board holds other parameters (check sum {:08X}) than this model "
                      "and these gains give ({:08X}): flash pil_uart.elf of --build-dir",
                      crc, parameters_crc_));
    }
    return fault;
  }

  Status follow(const Points& points) override {
    Writer writer;
    writer.put(points.acceptance_m);
    for (const Position<float>& point : points.points_m) writer.put(point.x_m).put(point.y_m);
    if (writer.bytes().size() > 4 + 16 * 8) {
      return input_error("", fmt::format("the firmware has room for 16 waypoints, there are {}",
                                         points.points_m.size()));
    }
    return exchange(::pil::kFollow, writer.bytes(), 0);
  }

  Result<Step> step(const AutopilotInput& input) override {
    if (auto answered = exchange(::pil::kStep, pack(input), kOutputBytes + 2); !answered) {
      return tl::unexpected(answered.error());
    }
    Reader cycles(payload().subspan(kOutputBytes));
    return Step{unpack(payload()), cycles.get<std::uint16_t>()};
  }

  ChipFigures figures() const override {
    ChipFigures figures = line_->figures();
    figures.repeats = repeats_;
    return figures;
  }

 private:
  std::span<const std::uint8_t> payload() const { return {reader_.payload(), reader_.length()}; }

  /// Sends a request, again where the line stays silent, and waits for the answer of `length`
  /// bytes.
  Status exchange(std::uint8_t type, std::span<const std::uint8_t> bytes, std::size_t length) {
    const std::vector<std::uint8_t> request = framed(type, ++sequence_, bytes);
    const int attempts = type == ::pil::kHello ? kStartAttempts : kAttempts;
    for (int i = 0; i < attempts; ++i) {
      if (i > 0) ++repeats_;
      AWMR_RETURN_IF_ERROR(line_->send(request));
      AWMR_ASSIGN_OR_RETURN(const bool answered, is_answered(type, length));
      if (answered) return {};
    }
    return refusal(
        fmt::format("the chip gave no whole answer to {} requests '{}' in a row: is it "
                    "flashed with this firmware, the baud right, the line too noisy?",
                    attempts, static_cast<char>(type)));
  }

  /// Reads until the answer to the present request is there; false: the line fell silent before.
  Result<bool> is_answered(std::uint8_t type, std::size_t length) {
    const Patience patience = type == ::pil::kHello ? Patience::kStart : Patience::kAnswer;
    reader_.reset();
    for (;;) {
      AWMR_ASSIGN_OR_RETURN(const std::optional<std::uint8_t> byte, line_->receive(patience));
      if (!byte) return false;
      if (!reader_.take(*byte)) continue;
      // An answer to a request before this one, which was repeated, is late and no longer wanted.
      if (reader_.type() != type || reader_.sequence() != sequence_) continue;
      if (reader_.length() == length) return true;
      return program_fault(fmt::format("the chip answered with {} bytes to a request '{}'",
                                       reader_.length(), static_cast<char>(type)));
    }
  }

  std::unique_ptr<Line> line_;
  std::uint32_t parameters_crc_;
  std::uint8_t sequence_ = 0;
  std::size_t repeats_ = 0;
  ::pil::FrameReader reader_{};
};

}  // namespace

std::unique_ptr<Chip> frame_link(std::unique_ptr<Line> line, std::uint32_t parameters_crc) {
  return std::make_unique<FrameLink>(std::move(line), parameters_crc);
}

}  // namespace awmr::pil
