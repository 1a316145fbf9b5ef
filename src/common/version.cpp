#include "wavetank/common/version.h"

namespace wavetank {

const char* version() { return WAVETANK_VERSION; }

}  // namespace wavetank
