#include "frame_link.h"

#include <fmt/format.h>

#include "awmr/core/containers.h"

#include "firmware/frame.h"
#include "wire.h"

namespace awmr::pil {
namespace {

/// Maximum number of times that a request is sent. Even with a damage probability of 0.001 per bit,
/// an attempt succeeds with a probability of 0.4, and all 40 attempts fail with a probability of
/// 1e-9.
constexpr int kAttempts = 40;
/// Maximum number of times that the start request is sent. This request is short and thus rarely
/// damaged, so 10 attempts suffice; more would delay the report that a board is missing.
constexpr int kStartAttempts = 10;

/// Encodes a request as a frame.
std::vector<std::uint8_t> framed(std::uint8_t type, std::uint8_t sequence,
                                 std::span<const std::uint8_t> payload) {
  std::vector<std::uint8_t> frame{::pil::kFrameStart, type, sequence,
                                  static_cast<std::uint8_t>(payload.size())};
  append(frame, payload);
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
    AWMR_RETURN_IF_ERROR(line_->open());
    return greet();
  }

  Status reset() override { return line_->reset(); }

  Status follow(const Points& points) override {
    points_ = points;
    Writer writer;
    writer.put(points.acceptance_m);
    for (const Position<float>& point : points.points_m) writer.put(point.x_m).put(point.y_m);
    if (writer.bytes().size() > 4 + 16 * 8) {
      return input_error(ErrorCode::kTooLarge, "",
                         fmt::format("the firmware stores at most 16 waypoints, found {}; use "
                                     "fewer",
                                     points.points_m.size()));
    }
    return ask(::pil::kFollow, writer.bytes(), 0);
  }

  /// Executes one step. A chip that does not answer may have been reset; it then answers only a
  /// start request. step() therefore starts the chip again, sends its points again, and repeats the
  /// request.
  Result<Step> step(const AutopilotInput& input) override {
    const std::vector<std::uint8_t> request = pack(input);
    AWMR_ASSIGN_OR_RETURN(const bool answered, exchange(::pil::kStep, request, kStepBytes));
    if (!answered) {
      AWMR_RETURN_IF_ERROR(greet());
      if (!points_.points_m.empty()) AWMR_RETURN_IF_ERROR(follow(points_));
      AWMR_RETURN_IF_ERROR(ask(::pil::kStep, request, kStepBytes));
    }
    Reader cycles(payload().subspan(kOutputBytes));
    return Step{unpack(payload()), cycles.get<std::uint16_t>(), !answered};
  }

  ChipFigures figures() const override {
    ChipFigures figures = line_->figures();
    figures.repeats = repeats_;
    return figures;
  }

 private:
  static constexpr std::size_t kStepBytes = kOutputBytes + 2;

  /// Starts the chip and returns the fault of its start-up check.
  Result<std::uint8_t> greet() {
    AWMR_RETURN_IF_ERROR(ask(::pil::kHello, {}, 5));
    Reader reader(payload());
    const auto fault = reader.get<std::uint8_t>();
    const auto crc = reader.get<std::uint32_t>();
    if (crc != parameters_crc_) {
      return input_error(
          ErrorCode::kStaleResult, "--port",
          fmt::format("the firmware on the board has other parameters (checksum {:08X}) than this "
                      "model, gains and scenario ({:08X}): flash pil_uart.elf of --build-dir",
                      crc, parameters_crc_));
    }
    return fault;
  }

  std::span<const std::uint8_t> payload() const { return {reader_.payload(), reader_.length()}; }

  static int attempts_for(std::uint8_t type) {
    return type == ::pil::kHello ? kStartAttempts : kAttempts;
  }

  /// Like exchange(), but returns an error (refused) if the chip answers none of the attempts.
  Status ask(std::uint8_t type, std::span<const std::uint8_t> bytes, std::size_t length) {
    AWMR_ASSIGN_OR_RETURN(const bool answered, exchange(type, bytes, length));
    if (answered) return {};
    return refusal(ErrorCode::kNoAnswer,
                   fmt::format("the chip gave no complete answer to {} requests of type '{}' in a "
                               "row: check its firmware, the baud rate and the noise of the line",
                               attempts_for(type), static_cast<char>(type)));
  }

  /// Sends a request with the payload `bytes`, and repeats it while the line stays silent. Waits
  /// for the answer, whose payload must have `length` bytes. Returns false if no attempt is
  /// answered.
  Result<bool> exchange(std::uint8_t type, std::span<const std::uint8_t> bytes,
                        std::size_t length) {
    const std::vector<std::uint8_t> request = framed(type, ++sequence_, bytes);
    for (int i = 0; i < attempts_for(type); ++i) {
      if (i > 0) ++repeats_;
      AWMR_RETURN_IF_ERROR(line_->send(request));
      AWMR_ASSIGN_OR_RETURN(const bool answered, is_answered(type, length));
      if (answered) return true;
    }
    return false;
  }

  /// Reads until the answer to the current request is complete. Returns false if the line becomes
  /// silent first. Errors (fault): the payload of the answer does not have `length` bytes.
  Result<bool> is_answered(std::uint8_t type, std::size_t length) {
    const Patience patience = type == ::pil::kHello ? Patience::kStart : Patience::kAnswer;
    reader_.reset();
    for (;;) {
      AWMR_ASSIGN_OR_RETURN(const std::optional<std::uint8_t> byte, line_->receive(patience));
      if (!byte) return false;
      if (!reader_.take(*byte)) continue;
      // Ignores late answers to earlier requests: the chip answers every copy of a repeated
      // request.
      if (reader_.type() != type || reader_.sequence() != sequence_) continue;
      if (reader_.length() == length) return true;
      return program_fault(
          fmt::format("the chip answered with {} bytes, which is a wrong length for a request of "
                      "type '{}'",
                      reader_.length(), static_cast<char>(type)));
    }
  }

  std::unique_ptr<Line> line_;
  std::uint32_t parameters_crc_;
  Points points_;
  std::uint8_t sequence_ = 0;
  std::size_t repeats_ = 0;
  ::pil::FrameReader reader_{};
};

}  // namespace

std::unique_ptr<Chip> frame_link(std::unique_ptr<Line> line, std::uint32_t parameters_crc) {
  return std::make_unique<FrameLink>(std::move(line), parameters_crc);
}

}  // namespace awmr::pil
