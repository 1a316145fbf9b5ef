#pragma once

#include <assimp/DefaultIOSystem.h>

namespace wavetank {

/// Files for assimp that end a reader which goes on asking for more at the end of a truncated file: some of its formats would do so for
/// ever.
class MeshFileAccess : public Assimp::DefaultIOSystem {
 public:
  Assimp::IOStream* Open(const char* file, const char* mode = "rb") override;
  void Close(Assimp::IOStream* stream) override;
};

}  // namespace wavetank
