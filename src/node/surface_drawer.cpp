#include "wavetank/node/surface_drawer.h"

#include <exception>
#include <new>
#include <utility>

#include "wavetank/common/stopwatch.h"

namespace wavetank {

SurfaceDrawer::SurfaceDrawer(std::function<void(const WaterSurface&, const ros::Time&)> done) : done_(std::move(done)) {}

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
  Stopwatch looking;
  std::shared_ptr<WaterField> taken;
  {
    const Stopwatch::Lap lap(looking);
    taken = std::make_shared<WaterField>(finder_->look_at(simulation));
  }
  looking_seconds_ = looking.seconds();
  is_dropped_ = false;
  work_.hand_over([this, taken, stamp] { find(*taken, stamp); });
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
  const std::lock_guard<std::mutex> lock(failure_mutex_);
  failure_ = why;
}

std::string SurfaceDrawer::failure() const {
  const std::lock_guard<std::mutex> lock(failure_mutex_);
  return failure_;
}

void SurfaceDrawer::drop() { is_dropped_ = true; }

/// In the drawer's thread.
void SurfaceDrawer::find(const WaterField& field, const ros::Time& stamp) {
  Stopwatch finding;
  try {
    const Stopwatch::Lap lap(finding);
    const WaterSurface surface = finder_->find(field);
    if (!is_dropped_) done_(surface, stamp);
  } catch (const std::exception&) {
    give_up();
  }
  finding_seconds_ = finding.seconds();
}

}  // namespace wavetank
