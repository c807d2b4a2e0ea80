#include "awmr/core/descriptor.h"

#include <unistd.h>

namespace awmr {

Descriptor::~Descriptor() {
  if (number_ >= 0) ::close(number_);
}

}  // namespace awmr
