#include "awmr/core/provenance.h"

#include "awmr/core/version_number.h"

namespace awmr {

const char* version() { return AWMR_VERSION; }

}  // namespace awmr
