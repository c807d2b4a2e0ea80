/* Arming: motors turn only after the command ARM, until STOP, a command time-out, any fault or the
   end of the route. SAFETY.md lists the detector of each fault. */
#ifndef AWMR_BOARD_SAFETY_H
#define AWMR_BOARD_SAFETY_H

#include "../awmr/emit/board/arming.h"
#include "command.h"

namespace awmr_board {

class Safety {
 public:
  bool is_armed() const { return arming_.is_armed(); }
  awmr::DisarmReason reason() const { return arming_.reason; }

  /* Call in receive() until the result is false. Handles ARM, STOP and KEEP, and refuses all other
     commands while disarmed. True: the sketch must act, because the vehicle was just armed
     (`armed_now` is true) or because command.word is a command for the sketch. */
  bool read(Command& command, bool& armed_now) {
    armed_now = false;
    while (command.read()) {
      switch (command.word) {
        case awmr::CommandWord::kStop:
          stop(command, awmr::DisarmReason::kStop);
          break;
        case awmr::CommandWord::kArm:
          if (is_armed()) {
            command.answer(kArmed);
          } else if (arming_.arm(fault_, cause_)) {
            command.answer(kArmed);
            armed_now = true;
            return true;
          } else {
            command.answer(kArmRefused, fault_, cause_);
          }
          break;
        case awmr::CommandWord::kKeep:
          if (!is_armed()) command.answer(kNotArmed);
          break;
        default:
          if (is_armed()) return true;
          command.answer(kNotArmed);
      }
    }
    return false;
  }

  /* Disarms, and answers `disarmed`. */
  void stop(Command& command, awmr::DisarmReason why) {
    arming_.disarm(why);
    command.answer(kDisarmed);
  }

  /* Call before awmr_step(). Keeps the motors of a disarmed vehicle off: sets the time of the last
     command so that awmr_step() finds a command time-out. */
  void guard(awmr_input& input) const {
    if (is_armed()) return;
    input.command_ms = input.now_ms - AWMR_COMMAND_TIMEOUT_MS - 1;
    input.u_ref_mps = 0.0f;
  }

  /* Call after awmr_step() with its fault bits and the sensor fault (`cause`). Disarms the vehicle
     if any of them is set. */
  void observe(uint8_t fault, uint8_t cause, Command& command) {
    fault_ = fault;
    cause_ = cause;
    if (arming_.observe(fault, cause)) command.answer(kDisarmed, fault, cause);
  }

 private:
  awmr::Arming arming_;
  /* fault bits of the last step; all bits until the first step, so that ARM is refused */
  uint8_t fault_ = 0xFF;
  uint8_t cause_ = 0;
};

}  // namespace awmr_board

#endif /* AWMR_BOARD_SAFETY_H */
