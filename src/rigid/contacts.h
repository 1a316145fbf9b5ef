#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "collision_shapes.h"
#include "impulse_solver.h"
#include "wall_contacts.h"
#include "wavetank/geometry/layout.h"
#include "wavetank/rigid/rigid_state.h"
#include "wavetank/scene/case.h"

namespace wavetank {

/// What the search for contacts has to know of an owner.
struct ContactBody {
  bool free = false;
  int frame = 0;                          ///< the owner that it moves with: itself, or the tank (0) where it is fixed
  Vector3d reference = Vector3d::Zero();  ///< m, as the case's geometry has it
  double friction = 0, restitution = 0;
  bool as_walls = false;          ///< its facets stand for it, exactly, hollows and all
  std::vector<ConvexPart> parts;  ///< else these do
};

/// Finds all contacts of a moment anew: nothing is kept from one search to the next.
class ContactFinder {
 public:
  /// `apart`: pairs of owners that pass through each other.
  ContactFinder(std::vector<ContactBody> bodies, const Layout& layout, int dimensions, double half_width,
                std::vector<std::pair<int, int>> apart);
  ~ContactFinder();

  std::vector<Contact> find(const std::vector<RigidState>& states) const;

 private:
  struct Bullet;
  struct Placed;
  bool together(int a, int b) const;
  void find_on_walls(const Placed& placed, const std::vector<RigidState>& states, std::vector<Contact>& contacts) const;
  void find_between(const Placed& a, const Placed& b, std::vector<Contact>& contacts) const;
  void add(std::vector<Contact> group, std::vector<Contact>& contacts) const;
  Contact make(int a, int b, const Vector3d& point, const Vector3d& normal, double gap) const;

  std::vector<ContactBody> bodies_;
  int dimensions_;
  double reach_;  ///< m, up to which a gap is a contact
  std::vector<std::pair<int, int>> apart_;
  std::vector<std::pair<int, WallSurface>> walls_;  ///< by frame
  std::unique_ptr<Bullet> bullet_;
};

/// At most four points of one normal: the deepest, and those that span the greatest area with it.
std::vector<Contact> thinned_out(const std::vector<Contact>& contacts);

}  // namespace wavetank
