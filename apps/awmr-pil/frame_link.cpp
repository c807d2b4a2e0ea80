#include "frame_link.h"

#include <fmt/format.h>

#include "firmware/frame.h"
#include "wire.h"

namespace awmr::pil {
namespace {

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

  ChipFigures figures() const override { return line_->figures(); }

 private:
  std::span<const std::uint8_t> payload() const { return {reader_.payload, reader_.length}; }

  /// Sends a request and waits for the answer of `length` bytes.
  Status exchange(std::uint8_t type, std::span<const std::uint8_t> bytes, std::size_t length) {
    Writer frame;
    frame.put(::pil::kFrameStart).put(type).put(static_cast<std::uint8_t>(bytes.size()));
    std::vector<std::uint8_t> whole = frame.bytes();
    whole.insert(whole.end(), bytes.begin(), bytes.end());
    const std::uint16_t crc = crc16_of(whole.data() + 1, whole.size() - 1);
    whole.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
    whole.push_back(static_cast<std::uint8_t>(crc >> 8U));
    if (auto sent = line_->send(whole); !sent) return sent;
    reader_.count = 0;
    for (;;) {
      const auto byte = line_->receive();
      if (!byte) return tl::unexpected(byte.error());
      if (!reader_.take(*byte)) continue;
      if (reader_.type == type && reader_.length == length) return {};
      return program_fault(fmt::format("the chip answered '{}' with {} bytes to a request '{}'",
                                       static_cast<char>(reader_.type), reader_.length,
                                       static_cast<char>(type)));
    }
  }

  std::unique_ptr<Line> line_;
  std::uint32_t parameters_crc_;
  ::pil::FrameReader reader_{};
};

}  // namespace

std::unique_ptr<Chip> frame_link(std::unique_ptr<Line> line, std::uint32_t parameters_crc) {
  return std::make_unique<FrameLink>(std::move(line), parameters_crc);
}

}  // namespace awmr::pil
