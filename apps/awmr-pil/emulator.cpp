#include "emulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstdarg>

extern "C" {
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
#include <simavr/sim_irq.h>
}

#include "awmr/emit/emit.h"

namespace awmr::pil {
namespace {

constexpr std::uint32_t kRamOffset = 0x800000;  ///< offset of RAM addresses in an ELF file
/// Pattern of paint_stack(). A byte that no longer has it was used by the stack.
constexpr std::uint8_t kPaint = 0xC5;
/// Maximum number of cycles that simavr executes per call. By default simavr returns after every
/// instruction, which is slower. Timers and interrupts stay exact: simavr returns earlier if a
/// timer or an interrupt is due.
constexpr avr_cycle_count_t kRunCycles = 1000;

/// Pointer to the only Emulator object. simavr 1.6 passes no user data to the callback sleep(), so
/// this callback needs the pointer.
Emulator* the_emulator = nullptr;

void no_log(avr_t*, int, const char*, va_list) {}

}  // namespace

Result<std::unique_ptr<Emulator>> Emulator::load(const std::filesystem::path& elf) {
  assert(the_emulator == nullptr);
  avr_global_logger_set(no_log);
  elf_firmware_t firmware{};
  if (elf_read_firmware(elf.c_str(), &firmware) != 0) {
    return input_error(
        ErrorCode::kWrongFile, elf.string(),
        "is not AVR firmware in ELF format; give pil_uart.elf of awmr pil --build-dir");
  }
  std::unique_ptr<Emulator> emulator(new Emulator);
  emulator->avr_ = avr_make_mcu_by_name("atmega2560");
  if (emulator->avr_ == nullptr) return program_fault("libsimavr does not support the atmega2560");
  avr_t* avr = emulator->avr_;
  avr_init(avr);
  avr->log = LOG_NONE;
  avr->run_cycle_limit = kRunCycles;
  avr->frequency = static_cast<std::uint32_t>(kChipClock_Hz);
  avr_load_firmware(avr, &firmware);
  avr->sleep = [](avr_t* chip, avr_cycle_count_t cycles) { Emulator::sleep(chip, cycles); };
  emulator->flash_bytes_ = firmware.flashsize;
  emulator->ram_bytes_ = firmware.datasize + firmware.bsssize;
  for (std::uint32_t i = 0; i < firmware.symbolcount; ++i) {
    emulator->symbols_[firmware.symbol[i]->symbol] = firmware.symbol[i]->addr;
  }
  the_emulator = emulator.get();
  return emulator;
}

Emulator::~Emulator() {
  if (avr_ != nullptr) avr_terminate(avr_);
  the_emulator = nullptr;
}

std::span<std::uint8_t> Emulator::ram(const std::string& symbol, std::size_t size) {
  const std::uint32_t address = symbols_.at(symbol);
  assert(address >= kRamOffset);
  return {avr_->data + (address - kRamOffset), size};
}

std::span<std::uint8_t> Emulator::flash(const std::string& symbol, std::size_t size) {
  return {avr_->flash + symbols_.at(symbol), size};
}

std::uint64_t Emulator::cycles() const { return avr_->cycle; }

/// Called by simavr when the chip goes to sleep, instead of simavr's own function, which would wait
/// in real time. Records the sleep, and the number of cycles since the interrupt that woke the
/// chip.
void Emulator::sleep(avr_t* avr, std::uint64_t) {
  Emulator& self = *the_emulator;
  if (self.entered_at_ != 0) {
    self.last_interrupt_cycles_ =
        static_cast<unsigned>(avr->cycle - self.entered_at_) + kInterruptEntryCycles;
    self.entered_at_ = 0;
  }
  self.asleep_ = true;
}

/// Corrects a deviation of simavr 1.6 from the chip. If an interrupt is raised between `sei` and
/// `sleep`, the chip serves it before the instruction after `sleep` [ATmega2560 data sheet, 7.7].
/// simavr executes the instruction after `sleep` first and, if this instruction is `cli`, never
/// serves the interrupt.
void Emulator::serve_interrupt_after_sleep() {
  constexpr unsigned kSleep = 0x9588;  // opcode of sleep
  if (avr_->state != cpu_Running || avr_->sreg[S_I] == 0 || avr_->pc < 2) return;
  const unsigned executed = avr_->flash[avr_->pc - 2] | avr_->flash[avr_->pc - 1] << 8U;
  if (executed != kSleep || avr_has_pending_interrupts(avr_) == 0) return;
  avr_->interrupt_state = 1;
  avr_service_interrupts(avr_);
  entered_at_ = avr_->cycle;
}

Status Emulator::run_once() {
  serve_interrupt_after_sleep();
  const bool was_asleep = avr_->state == cpu_Sleeping || asleep_;
  asleep_ = false;
  const int state = avr_run(avr_);
  if (state == cpu_Done || state == cpu_Crashed) {
    return program_fault(fmt::format("the emulated chip stopped at address {:#x}", avr_->pc));
  }
  // If an interrupt woke the chip, the program counter is at the interrupt's vector. There are 57
  // vectors of 4 bytes; vector 0 is the reset.
  const bool at_vector = avr_->pc > 0 && avr_->pc < 57 * 4 && avr_->pc % 4 == 0;
  if (was_asleep && at_vector && state == cpu_Running && !asleep_) entered_at_ = avr_->cycle;
  if (asleep_ && at_vector && avr_->state == cpu_Running) entered_at_ = avr_->cycle;
  return {};
}

Status Emulator::run_until(const std::function<bool()>& done, std::uint64_t cycle_limit) {
  const std::uint64_t end = avr_->cycle + cycle_limit;
  while (!done()) {
    if (auto run = run_once(); !run) return run;
    if (avr_->cycle > end) {
      return program_fault(
          fmt::format("the emulated chip gave no answer within {} cycles", cycle_limit));
    }
  }
  return {};
}

void Emulator::reset() {
  avr_reset(avr_);
  asleep_ = false;
  entered_at_ = 0;
  to_send_.clear();
  sent_ = 0;
  uart_ready_ = true;
}

Status Emulator::run_to_sleep(std::uint64_t cycle_limit) {
  asleep_ = false;
  return run_until([this] { return asleep_; }, cycle_limit);
}

void Emulator::paint_stack() {
  const std::size_t from = symbols_.at("_end") - kRamOffset;
  const std::size_t pointer = avr_->data[R_SPL] | avr_->data[R_SPH] << 8;
  std::fill(avr_->data + from, avr_->data + pointer, kPaint);
}

unsigned Emulator::stack_bytes() const {
  const std::size_t from = symbols_.at("_end") - kRamOffset;
  const std::uint8_t* end = avr_->data + avr_->ramend + 1;
  const std::uint8_t* lowest = std::find_if(avr_->data + from, avr_->data + avr_->ramend + 1,
                                            [](std::uint8_t byte) { return byte != kPaint; });
  return static_cast<unsigned>(end - lowest);
}

void Emulator::connect_uart() {
  std::uint32_t flags = 0;
  avr_ioctl(avr_, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
  const auto irq = [&](int which) {
    return avr_io_getirq(avr_, AVR_IOCTL_UART_GETIRQ('0'), which);
  };
  uart_input_ = irq(UART_IRQ_INPUT);
  avr_irq_register_notify(
      irq(UART_IRQ_OUTPUT),
      [](avr_irq_t*, std::uint32_t value, void* self) {
        static_cast<Emulator*>(self)->receive_(static_cast<std::uint8_t>(value));
      },
      this);
  avr_irq_register_notify(
      irq(UART_IRQ_OUT_XON),
      [](avr_irq_t*, std::uint32_t, void* self) {
        static_cast<Emulator*>(self)->uart_ready_ = true;
        static_cast<Emulator*>(self)->feed_uart();
      },
      this);
  avr_irq_register_notify(
      irq(UART_IRQ_OUT_XOFF),
      [](avr_irq_t*, std::uint32_t, void* self) {
        static_cast<Emulator*>(self)->uart_ready_ = false;
      },
      this);
}

void Emulator::feed_uart() {
  while (uart_ready_ && sent_ < to_send_.size()) {
    avr_raise_irq(uart_input_, static_cast<std::uint8_t>(to_send_[sent_++]));
  }
}

void Emulator::send_to_uart(std::span<const std::uint8_t> bytes) {
  to_send_.erase(0, sent_);
  sent_ = 0;
  to_send_.append(bytes.begin(), bytes.end());
  feed_uart();
}

}  // namespace awmr::pil
