#include "facing_walls.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

namespace wavetank {

std::vector<WallElement> pieces_that_may_face(const std::vector<WallElement>& pieces, const std::vector<bool>& moving, double support) {
  std::vector<Eigen::AlignedBox3d> about(moving.size());
  for (const WallElement& piece : pieces) about.at(piece.owner).extend(piece.centre);
  const Vector3d reach = Vector3d::Constant(2 * support);  // a piece is no wider than a spacing or two
  std::vector<WallElement> kept;
  for (const WallElement& piece : pieces) {
    bool may_face = false;
    for (std::size_t o = 0; o < about.size() && !may_face; ++o) {
      if (static_cast<int>(o) == piece.owner || about[o].isEmpty()) continue;
      may_face =
          moving[o] || moving[piece.owner] || Eigen::AlignedBox3d(about[o].min() - reach, about[o].max() + reach).contains(piece.centre);
    }
    if (may_face) kept.push_back(piece);
  }
  return kept;
}

namespace {

/// About each owner's pieces, with all that is within the support of them; the tank, owner 0, is about everything.
template <class Real>
std::vector<Real> spheres_about(const std::vector<WallElement>& pieces, const Discretisation& discretisation) {
  std::vector<Eigen::AlignedBox3d> about(1);
  for (const WallElement& piece : pieces) {
    if (piece.owner >= static_cast<int>(about.size())) about.resize(piece.owner + 1);
    about[piece.owner].extend(piece.centre - discretisation.origin);
  }
  constexpr double piece_size = 2.0;  // spacings, at the most
  std::vector<Real> spheres;
  for (std::size_t o = 0; o < about.size(); ++o) {
    Vector3d centre = Vector3d::Zero();
    if (!about[o].isEmpty()) centre = about[o].center();
    const double radius =
        about[o].isEmpty() ? 0.0 : 0.5 * about[o].diagonal().norm() + discretisation.support + piece_size * discretisation.spacing;
    for (int axis = 0; axis < 3; ++axis) spheres.push_back(static_cast<Real>(centre[axis]));
    spheres.push_back(static_cast<Real>(o == 0 ? -1.0 : radius));
  }
  return spheres;
}

}  // namespace

template <class Real>
FacingWalls<Real>::FacingWalls(const compute::Device& device, const std::vector<WallElement>& pieces, const Discretisation& discretisation)
    : device_(device), discretisation_(discretisation) {
  const auto of_first_owner = [&pieces](const WallElement& piece) { return piece.owner == pieces.front().owner; };
  if (std::all_of(pieces.begin(), pieces.end(), of_first_owner)) return;
  count_ = static_cast<int>(pieces.size());
  chunks_ = chunks_of(count_);
  std::vector<Real> rest(6 * pieces.size());
  std::vector<int> owners(pieces.size());
  for (std::size_t s = 0; s < pieces.size(); ++s) {
    owners[s] = pieces[s].owner;
    for (int axis = 0; axis < 3; ++axis) {
      rest[axis * pieces.size() + s] = static_cast<Real>(pieces[s].centre[axis] - discretisation.origin[axis]);
      rest[(3 + axis) * pieces.size() + s] = static_cast<Real>(pieces[s].area * pieces[s].normal[axis]);
    }
  }
  rest_ = compute::Buffer<Real>(device, rest);
  spheres_ = compute::Buffer<Real>(device, spheres_about<Real>(pieces, discretisation));
  owner_count_ = static_cast<int>(spheres_.size() / 4);
  owners_ = compute::Buffer<int>(device, owners);
  places_ = compute::Buffer<Real>(device, 3 * pieces.size());
  forces_ = compute::Buffer<Real>(device, 3 * field::facing_owners * pieces.size());
  others_ = compute::Buffer<int>(device, field::facing_owners * pieces.size());
}

template <class Real>
void FacingWalls<Real>::set_poses(const std::vector<WallPose>& poses) {
  if (count_ > 0) poses_.set(device_, pose_values<Real>(poses, discretisation_));
}

template <class Real>
void FacingWalls<Real>::bind(const KernelMaker& make, const std::map<Slot, compute::Arguments>& given) {
  if (count_ == 0) return;
  std::map<Slot, compute::Arguments> arguments = given;
  for (auto& [slot, own] : arguments) {
    own.value("count", count_).value("owner_count", owner_count_).memory("rest", rest_).memory("owners", std::as_const(owners_));
    own.memory("poses", poses_.on_device()).memory("spheres", spheres_);
    own.memory("places", places_).memory("others", others_).memory("forces", forces_);
    sweeps_[slot] = make.over_points("facing_walls.cl", "facing_walls", own);
  }
  compute::Arguments reduction = arguments.begin()->second;
  reduction.value("items", items_).value("chunks", chunks_).memory("sums", sums_);
  chunk_kernel_ = make.exact("reduce.cl", "facing_chunks", reduction);
  total_kernel_ = make.exact("reduce.cl", "facing_totals", reduction);
}

template <class Real>
void FacingWalls<Real>::add(Slot state, int regions) {
  if (count_ == 0) return;
  sweeps_.at(state).launch(count_);
  items_ = regions * chunks_;
  const std::size_t size = exact_places(field::facing_count) * static_cast<std::size_t>(items_);
  if (sums_.size() < size) sums_ = compute::Buffer<std::int64_t>(device_, size);
  chunk_kernel_.launch(items_);
  total_kernel_.launch(regions);
}

template class FacingWalls<float>;
template class FacingWalls<double>;

}  // namespace wavetank
