#include "wavetank/node/surface_drawer.h"

#include <chrono>
#include <exception>
#include <new>

namespace wavetank {
namespace {

double seconds_since(std::chrono::steady_clock::time_point then) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

}  // namespace

SurfaceDrawer::SurfaceDrawer(std::function<void(const WaterSurface&, const ros::Time&)> done) : done_(std::move(done)) {
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

void SurfaceDrawer::draw(const Simulation& simulation, const ros::Time& stamp) {
  wait();
  if (!failure().empty()) return;
  try {
    look_at(simulation, stamp);
  } catch (const std::exception&) {
    give_up();
  }
}

void SurfaceDrawer::look_at(const Simulation& simulation, const ros::Time& stamp) {
  if (!finder_) finder_ = std::make_unique<SurfaceFinder>(simulation);
  const auto began = std::chrono::steady_clock::now();
  WaterField field = finder_->look_at(simulation);
  looking_seconds_ = seconds_since(began);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    field_ = std::move(field);
    stamp_ = stamp;
    is_dropped_ = false;
  }
  changed_.notify_all();
}

/// While what failed is caught.
void SurfaceDrawer::give_up() {
  std::string why;
  try {
    throw;
  } catch (const std::bad_alloc&) {
    why = "there is not enough memory";
  } catch (const std::exception& error) {
    why = error.what();
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  failure_ = why;
}

std::string SurfaceDrawer::failure() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return failure_;
}

void SurfaceDrawer::drop() {
  const std::lock_guard<std::mutex> lock(mutex_);
  is_dropped_ = true;
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

/// In the drawer's thread. Nobody changes the field until it is gone.
void SurfaceDrawer::find() {
  const WaterSurface surface = finder_->find(*field_);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (is_dropped_) return;
  }
  done_(surface, stamp_);
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
      find();
    } catch (const std::exception&) {
      give_up();
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
