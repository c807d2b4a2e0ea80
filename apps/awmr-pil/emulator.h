// An ATmega2560, emulated in this process by libsimavr.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "awmr/core/result.h"

struct avr_irq_t;
struct avr_t;

namespace awmr::pil {

/// Clock cycles from an interrupt to the first instruction of its vector, on a chip with a 3-byte
/// program counter. simavr 1.6 does not count these cycles. [ATmega2560 data sheet, 7.7.1]
inline constexpr unsigned kInterruptEntryCycles = 5;

class Emulator {
 public:
  /// Loads firmware. Only one emulator may exist at a time. Errors (input): the file cannot be read
  /// as firmware for an AVR; (fault) libsimavr does not support the ATmega2560.
  static Result<std::unique_ptr<Emulator>> load(const std::filesystem::path& elf);
  ~Emulator();
  Emulator(const Emulator&) = delete;
  Emulator& operator=(const Emulator&) = delete;

  /// Use of flash (.text and .data) and of RAM (.data and .bss, without the stack).
  unsigned flash_bytes() const { return flash_bytes_; }
  unsigned ram_bytes() const { return ram_bytes_; }

  /// Returns the `size` bytes of a variable in RAM, by its symbol. Writing to them changes the
  /// chip's memory. Precondition: the firmware defines the symbol.
  std::span<std::uint8_t> ram(const std::string& symbol, std::size_t size);
  /// Returns the `size` bytes of a constant in flash, by its symbol; otherwise like ram().
  std::span<std::uint8_t> flash(const std::string& symbol, std::size_t size);

  /// Resets the chip as its reset pin does: RAM keeps its content, and the count of cycles goes on.
  void reset();
  /// Runs until the chip sleeps. Errors (fault): the program crashed or ended, or the chip is still
  /// awake after `cycle_limit` cycles.
  Status run_to_sleep(std::uint64_t cycle_limit);
  /// Runs until `done` returns true. `done` is called before each batch of instructions, at most
  /// 1000 cycles long. Errors (fault): the program crashed or ended, or `done` is still false after
  /// `cycle_limit` cycles.
  Status run_until(const std::function<bool()>& done, std::uint64_t cycle_limit);
  /// Returns the clock cycles from the entry (included) of the last interrupt that woke the chip to
  /// the next sleep.
  unsigned last_interrupt_cycles() const { return last_interrupt_cycles_; }
  std::uint64_t cycles() const;

  /// Fills the RAM between the variables and the stack with a pattern, to measure the stack.
  /// Precondition: the chip sleeps.
  void paint_stack();
  /// Returns the largest use of the stack since paint_stack(), bytes. It is measured from the top
  /// of RAM down to the lowest address that was overwritten.
  unsigned stack_bytes() const;

  /// Sets the callback for the bytes that USART0 sends.
  void on_uart_output(std::function<void(std::uint8_t)> receive) { receive_ = std::move(receive); }
  /// Connects USART0 to the callback and to send_to_uart(). Call once, after load().
  void connect_uart();
  /// Queues bytes for USART0. Each byte is delivered as soon as USART0 accepts it.
  void send_to_uart(std::span<const std::uint8_t> bytes);

 private:
  Emulator() = default;
  Status run_once();
  void serve_interrupt_after_sleep();
  static void sleep(avr_t* avr, std::uint64_t cycles);
  void feed_uart();

  avr_t* avr_ = nullptr;
  avr_irq_t* uart_input_ = nullptr;  ///< set by connect_uart()
  std::map<std::string, std::uint32_t> symbols_;
  unsigned flash_bytes_ = 0;
  unsigned ram_bytes_ = 0;
  bool asleep_ = false;
  std::uint64_t entered_at_ = 0;
  unsigned last_interrupt_cycles_ = 0;
  std::function<void(std::uint8_t)> receive_;
  std::string to_send_;
  std::size_t sent_ = 0;
  bool uart_ready_ = true;
};

}  // namespace awmr::pil
