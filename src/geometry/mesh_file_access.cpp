#include "mesh_file_access.h"

#include <assimp/IOStream.hpp>
#include <stdexcept>

namespace wavetank {
namespace {

constexpr int patience = 1000;  // fruitless reads in a row

class PatientStream : public Assimp::IOStream {
 public:
  PatientStream(Assimp::DefaultIOSystem& files, Assimp::IOStream* stream) : files_(files), stream_(stream) {}
  PatientStream(const PatientStream&) = delete;
  PatientStream& operator=(const PatientStream&) = delete;
  ~PatientStream() override { files_.Assimp::DefaultIOSystem::Close(stream_); }

  size_t Read(void* buffer, size_t size, size_t count) override {
    const size_t read = stream_->Read(buffer, size, count);
    fruitless_ = read > 0 ? 0 : fruitless_ + 1;
    if (fruitless_ > patience) throw std::runtime_error("the file ends too early");  // assimp reports it as the reason
    return read;
  }
  size_t Write(const void* buffer, size_t size, size_t count) override { return stream_->Write(buffer, size, count); }
  aiReturn Seek(size_t offset, aiOrigin origin) override { return stream_->Seek(offset, origin); }
  size_t Tell() const override { return stream_->Tell(); }
  size_t FileSize() const override { return stream_->FileSize(); }
  void Flush() override { stream_->Flush(); }

 private:
  Assimp::DefaultIOSystem& files_;
  Assimp::IOStream* stream_;
  int fruitless_ = 0;
};

}  // namespace

Assimp::IOStream* MeshFileAccess::Open(const char* file, const char* mode) {
  Assimp::IOStream* stream = DefaultIOSystem::Open(file, mode);
  return stream ? new PatientStream(*this, stream) : nullptr;
}

void MeshFileAccess::Close(Assimp::IOStream* stream) { delete stream; }

}  // namespace wavetank
