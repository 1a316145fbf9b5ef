#pragma once

namespace wavetank {

/// The package's version, as in package.xml ("0.1.0").
const char* version();

}  // namespace wavetank
