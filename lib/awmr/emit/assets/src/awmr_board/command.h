/* Commands over Serial, 115200 baud: the lines of awmr/emit/board/command_line.h. The sketch's
   receive() reads them in the timer interrupt. loop() prints the answers: printing waits when the
   port is full, which would delay the control step. */
#ifndef AWMR_BOARD_COMMAND_H
#define AWMR_BOARD_COMMAND_H

#include "../awmr/emit/board/command_line.h"

namespace awmr_board {

enum Answer {
  kOk,
  kUnknown,     /* the answers from here to kTextLocked have the order of awmr::CommandVerdict */
  kTooLong,
  kDamaged,
  kRepeated,
  kTextLocked,
  kOutOfRange,
  kNotArmed,    /* the command needs an armed vehicle */
  kArmRefused,  /* a sensor or the autopilot has a fault */
  kArmed,
  kDisarmed
};

class Command {
 public:
  awmr::CommandWord word = awmr::CommandWord::kNone;
  float value = 0.0f;    /* 0 if the command has none */
  uint32_t heard_ms = 0; /* time of the last complete command, valid once has_heard */
  bool has_heard = false;

  /* Reads the characters that have arrived; never waits. True: a command was received, see word and
     value. An invalid line gets an answer with the reason, and does not reset the time-out. */
  bool read() {
    while (Serial.available() > 0) {
      const awmr::CommandVerdict verdict = reader_.take(static_cast<char>(Serial.read()));
      if (verdict == awmr::CommandVerdict::kNone) continue;
      if (verdict != awmr::CommandVerdict::kTaken) {
        answer(static_cast<Answer>(kUnknown + static_cast<uint8_t>(verdict) -
                                   static_cast<uint8_t>(awmr::CommandVerdict::kUnknown)));
        continue;
      }
      word = reader_.word;
      value = reader_.value;
      heard_ms = millis();
      has_heard = true;
      return true;
    }
    return false;
  }

  /* Call in receive() or the step: queues an answer for loop(). fault, cause: the autopilot's fault
     bits and the sensor fault to print, if not 0. If the queue is full, the answer is lost. */
  void answer(Answer what, uint8_t fault = 0, uint8_t cause = 0) {
    const uint8_t next = static_cast<uint8_t>((written_ + 1) % kWaiting);
    if (next == read_) return;
    waiting_[written_] = {static_cast<uint8_t>(what), fault, cause, reader_.sequence,
                          reader_.is_framed};
    written_ = next;
  }

  /* Call in loop(): prints the queued answers. */
  void speak() {
    while (read_ != written_) {
      const Waiting one = waiting_[read_];
      read_ = static_cast<uint8_t>((read_ + 1) % kWaiting);
      if (one.is_framed) {
        Serial.print('#');
        Serial.print(one.sequence);
        Serial.print(' ');
      }
      print(one);
    }
  }

 private:
  struct Waiting {
    uint8_t what, fault, cause, sequence;
    bool is_framed;
  };
  static const uint8_t kWaiting = 6;
  awmr::CommandReader reader_;
  Waiting waiting_[kWaiting] = {};
  volatile uint8_t written_ = 0;
  volatile uint8_t read_ = 0;

  static void print(const Waiting& one) {
    if (one.what == kOk) return (void)Serial.println(F("ok"));
    if (one.what == kArmed) return (void)Serial.println(F("armed"));
    Serial.print(one.what == kDisarmed ? F("disarmed") : F("refused:"));
    switch (one.what) {
      case kUnknown: Serial.print(F(" no such command or value")); break;
      case kTooLong: Serial.print(F(" line too long")); break;
      case kDamaged: Serial.print(F(" frame damaged")); break;
      case kRepeated: Serial.print(F(" sequence not new")); break;
      case kTextLocked: Serial.print(F(" frames and STOP only")); break;
      case kOutOfRange: Serial.print(F(" out of range")); break;
      case kNotArmed: Serial.print(F(" not armed")); break;
      default: break;
    }
    if (one.fault != 0 || one.cause != 0) {
      Serial.print(F(" fault "));
      Serial.print(one.fault);
      Serial.print('/');
      Serial.print(one.cause);
    }
    Serial.println();
  }
};

}  // namespace awmr_board

#endif /* AWMR_BOARD_COMMAND_H */
