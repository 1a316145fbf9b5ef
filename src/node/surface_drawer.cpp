#include "wavetank/node/surface_drawer.h"

#include <chrono>
#include <exception>
#include <string>

#include "wavetank/common/log.h"

namespace wavetank {
namespace {

double seconds_since(std::chrono::steady_clock::time_point then) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

}  // namespace

SurfaceDrawer::SurfaceDrawer(std::function<void(const WaterSurface&)> done) : done_(std::move(done)) {
  thread_ = std::thread([this] { run(); });
}

SurfaceDrawer::~SurfaceDrawer() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void SurfaceDrawer::draw(const Simulation& simulation) {
  if (!finder_) finder_ = std::make_unique<SurfaceFinder>(simulation);
  wait();
  const auto began = std::chrono::steady_clock::now();
  WaterField field = finder_->look_at(simulation);
  looking_seconds_ = seconds_since(began);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    field_ = std::move(field);
  }
  changed_.notify_all();
}

bool SurfaceDrawer::is_idle() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return !field_;
}

void SurfaceDrawer::wait() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return !field_; });
}

double SurfaceDrawer::seconds() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return looking_seconds_ + finding_seconds_;
}

void SurfaceDrawer::run() {
  while (true) {
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return stopping_ || field_; });
      if (!field_) return;
    }
    const auto began = std::chrono::steady_clock::now();
    try {
      done_(finder_->find(*field_));  // nobody changes the field until it is gone
    } catch (const std::exception& error) {
      log(LogLevel::warning, std::string("a surface of the water could not be found: ") + error.what());
    }
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      finding_seconds_ = seconds_since(began);
      field_.reset();
    }
    changed_.notify_all();
  }
}

}  // namespace wavetank
