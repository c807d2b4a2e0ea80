/* Arming: motors turn only after the command ARM, until STOP, a silence, any fault or the end of the
   route. What detects each fault is in SAFETY.md. */
#ifndef AWMR_BOARD_SAFETY_H
#define AWMR_BOARD_SAFETY_H

#include "../awmr/control/arming.h"
#include "command.h"

namespace awmr_board {

class Safety {
 public:
  bool is_armed() const { return arming_.is_armed(); }
  awmr::DisarmReason reason() const { return arming_.reason; }

  /* In the step, first: true where a command came that the sketch has to obey. ARM, STOP and KEEP are
     dealt with here, and everything else is refused while disarmed. `armed_now` tells that ARM was
     just obeyed. */
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

  void stop(Command& command, awmr::DisarmReason why) {
    arming_.disarm(why);
    command.answer(kDisarmed);
  }

  /* Before awmr_step(): disarmed, nobody commands, and the motors are off. */
  void guard(awmr_input& input) const {
    if (is_armed()) return;
    input.command_ms = input.now_ms - AWMR_COMMAND_TIMEOUT_MS - 1;
    input.u_ref_mps = 0.0f;
  }

  /* After awmr_step(), with the sensors' fault: any of them disarms. */
  void observe(uint8_t fault, uint8_t cause, Command& command) {
    fault_ = fault;
    cause_ = cause;
    if (arming_.observe(fault, cause)) command.answer(kDisarmed, fault, cause);
  }

 private:
  awmr::Arming arming_;
  uint8_t fault_ = 0xFF; /* of the last step; there was none yet */
  uint8_t cause_ = 0;
};

}  // namespace awmr_board

#endif /* AWMR_BOARD_SAFETY_H */
