#include "contacts.h"

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/CollisionShapes/btPolyhedralConvexShape.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "bullet_types.h"

namespace wavetank {
namespace {

constexpr double reach_of_spacing = 0.05, merge_of_spacing = 0.05;
constexpr double same_normal = 1 - 1e-6;  // cosine

btDefaultCollisionConstructionInfo small_pools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 64;  // one pair at a time; Bullet's default would take megabytes
  info.m_defaultMaxCollisionAlgorithmPoolSize = 64;
  return info;
}

/// Gives contacts the reach of this case in place of Bullet's 2 cm.
class Dispatcher : public btCollisionDispatcher {
 public:
  Dispatcher(btCollisionConfiguration* configuration, double reach) : btCollisionDispatcher(configuration), reach_(reach) {}
  btPersistentManifold* getNewManifold(const btCollisionObject* a, const btCollisionObject* b) override {
    btPersistentManifold* manifold = btCollisionDispatcher::getNewManifold(a, b);
    manifold->setContactBreakingThreshold(reach_);
    return manifold;
  }

 private:
  double reach_;
};

bool overlap(const Box& a, const Box& b, double reach) {
  return ((a.min.array() - reach) <= b.max.array()).all() && ((b.min.array() - reach) <= a.max.array()).all();
}

/// Of two hulls along a direction from b to a; negative where they overlap.
double gap_along(const PlacedHull& a, const PlacedHull& b, const Vector3d& direction) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const Vector3d& vertex : a.vertices) least = std::min(least, direction.dot(vertex));
  for (const Vector3d& vertex : b.vertices) most = std::max(most, direction.dot(vertex));
  return least - most;
}

}  // namespace

struct ContactFinder::Bullet {
  explicit Bullet(double reach) : configuration(small_pools()), dispatcher(&configuration, reach) {}

  /// Asks Bullet for the contacts of two convex shapes; the algorithm with its memory lives for this question only.
  template <class Take>
  void ask(btPolyhedralConvexShape* shape_a, const btTransform& place_a, btPolyhedralConvexShape* shape_b, const btTransform& place_b,
           const Take& take) {
    a.setCollisionShape(shape_a);
    b.setCollisionShape(shape_b);
    a.setWorldTransform(place_a);
    b.setWorldTransform(place_b);
    const btCollisionObjectWrapper first(nullptr, shape_a, &a, a.getWorldTransform(), -1, -1);
    const btCollisionObjectWrapper second(nullptr, shape_b, &b, b.getWorldTransform(), -1, -1);
    btCollisionAlgorithm* algorithm = dispatcher.findAlgorithm(&first, &second, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    btManifoldResult result(&first, &second);
    const btDispatcherInfo info;
    algorithm->processCollision(&first, &second, info, &result);
    btManifoldArray manifolds;
    algorithm->getAllContactManifolds(manifolds);
    for (int m = 0; m < manifolds.size(); ++m) take(*manifolds[m], manifolds[m]->getBody0() == &b);
    algorithm->~btCollisionAlgorithm();
    dispatcher.freeCollisionAlgorithm(algorithm);
  }

  btDefaultCollisionConfiguration configuration;
  Dispatcher dispatcher;
  btCollisionObject a, b;
};

struct ContactFinder::Placed {
  int owner;
  const ConvexPart* part;
  const RigidState* frame;  ///< that the part is fixed to
  Quaterniond turn;
  Vector3d place;  ///< of the body's reference point
  PlacedHull hull;
};

ContactFinder::ContactFinder(std::vector<ContactBody> bodies, const Layout& layout, int dimensions, double half_width,
                             std::vector<std::pair<int, int>> apart)
    : bodies_(std::move(bodies)),
      dimensions_(dimensions),
      reach_(reach_of_spacing * layout.spacing),
      apart_(std::move(apart)),
      bullet_(std::make_unique<Bullet>(reach_)) {
  for (std::size_t frame = 0; frame < bodies_.size(); ++frame) {
    std::vector<int> owners;
    for (std::size_t o = 0; o < bodies_.size(); ++o)
      if (bodies_[o].as_walls && bodies_[o].frame == static_cast<int>(frame)) owners.push_back(static_cast<int>(o));
    if (owners.empty()) continue;
    WallSurface surface(layout, owners, dimensions, 2 * half_width);
    if (!surface.empty()) walls_.emplace_back(static_cast<int>(frame), std::move(surface));
  }
}

ContactFinder::~ContactFinder() = default;

bool ContactFinder::together(int a, int b) const {
  const auto is = [&](const std::pair<int, int>& pair) {
    return (pair.first == a && pair.second == b) || (pair.first == b && pair.second == a);
  };
  return bodies_[a].frame != bodies_[b].frame && std::none_of(apart_.begin(), apart_.end(), is);
}

Contact ContactFinder::make(int a, int b, const Vector3d& point, const Vector3d& normal, double gap) const {
  Contact contact{bodies_[a].frame, bodies_[b].frame, a, b, point, normal, gap, 0, 0};
  contact.friction = std::sqrt(bodies_[a].friction * bodies_[b].friction);
  contact.restitution = std::max(bodies_[a].restitution, bodies_[b].restitution);
  return contact;
}

std::vector<Contact> ContactFinder::find(const std::vector<RigidState>& states) const {
  std::vector<Placed> placed;
  for (std::size_t o = 0; o < bodies_.size(); ++o) {
    const ContactBody& body = bodies_[o];
    const RigidState& frame = states[body.frame];
    const Vector3d place = frame.moved(body.reference, bodies_[body.frame].reference);
    for (const ConvexPart& part : body.parts)
      placed.push_back({static_cast<int>(o), &part, &frame, frame.orientation, place, PlacedHull(part.hull, frame.orientation, place)});
  }
  std::vector<Contact> contacts;
  for (std::size_t p = 0; p < placed.size(); ++p) {
    const ContactBody& body = bodies_[placed[p].owner];
    find_on_walls(placed[p], states, contacts);
    for (std::size_t q = p + 1; q < placed.size(); ++q) {
      const ContactBody& other = bodies_[placed[q].owner];
      if ((body.free || other.free) && overlap(placed[p].hull.box, placed[q].hull.box, reach_) &&
          together(placed[p].owner, placed[q].owner))
        find_between(placed[p], placed[q], contacts);
    }
  }
  return contacts;
}

void ContactFinder::find_on_walls(const Placed& placed, const std::vector<RigidState>& states, std::vector<Contact>& contacts) const {
  for (const auto& [frame, surface] : walls_) {
    const bool answers = bodies_[placed.owner].free || bodies_[frame].free;
    if (!answers || bodies_[placed.owner].frame == frame) continue;
    const RigidState& wall = states[frame];
    const Vector3d& reference = bodies_[frame].reference;
    const Quaterniond back = wall.orientation.conjugate();
    std::vector<WallContact> found;
    surface.find(PlacedHull(placed.part->hull, back * placed.turn, back * (placed.place - wall.position) + reference), reach_, found);
    std::vector<Contact> group;
    for (const WallContact& contact : found) {
      if (!together(placed.owner, contact.owner)) continue;
      group.push_back(
          make(placed.owner, contact.owner, wall.moved(contact.point, reference), wall.orientation * contact.normal, contact.gap));
    }
    add(std::move(group), contacts);
  }
}

void ContactFinder::find_between(const Placed& a, const Placed& b, std::vector<Contact>& contacts) const {
  const auto place_of = [](const Placed& placed) { return to_bullet(placed.turn, placed.place + placed.turn * placed.part->middle); };
  std::vector<Contact> group;
  bullet_->ask(a.part->shape.get(), place_of(a), b.part->shape.get(), place_of(b), [&](btPersistentManifold& manifold, bool swapped) {
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      const btManifoldPoint& point = manifold.getContactPoint(k);
      const Vector3d normal = (swapped ? -1 : 1) * from_bullet(point.m_normalWorldOnB);
      // Clipping faces finds edges that cross to overlap by up to the reach more than they do.
      const double gap = std::max<double>(point.getDistance(), gap_along(a.hull, b.hull, normal));
      if (gap > reach_) continue;
      const Vector3d middle = 0.5 * (from_bullet(point.getPositionWorldOnA()) + from_bullet(point.getPositionWorldOnB()));
      group.push_back(make(a.owner, b.owner, middle, normal, gap));
    }
  });
  add(std::move(group), contacts);
}

/// Puts points into the plane in 2-D, and takes out what says the same twice.
void ContactFinder::add(std::vector<Contact> group, std::vector<Contact>& contacts) const {
  std::vector<std::vector<Contact>> by_normal;
  for (Contact& contact : group) {
    if (dimensions_ == 2) {
      contact.point.y() = contact.normal.y() = 0;
      if (contact.normal.norm() < 0.5) continue;  // the ends of a prism, which a section has not
      contact.normal.normalize();
    }
    const auto same = std::find_if(by_normal.begin(), by_normal.end(), [&](const std::vector<Contact>& others) {
      return others.front().b == contact.b && others.front().friction == contact.friction &&
             others.front().restitution == contact.restitution && others.front().normal.dot(contact.normal) > same_normal;
    });
    if (same == by_normal.end()) {
      by_normal.push_back({contact});
    } else {
      same->push_back(contact);
    }
  }
  for (const std::vector<Contact>& others : by_normal) {
    std::vector<Contact> distinct;
    for (const Contact& contact : others) {
      const double near = merge_of_spacing / reach_of_spacing * reach_;
      const auto twin =
          std::find_if(distinct.begin(), distinct.end(), [&](const Contact& c) { return (c.point - contact.point).norm() < near; });
      if (twin == distinct.end()) {
        distinct.push_back(contact);
      } else if (contact.gap < twin->gap) {
        *twin = contact;
      }
    }
    const std::vector<Contact> kept = thinned_out(distinct);
    contacts.insert(contacts.end(), kept.begin(), kept.end());
  }
}

std::vector<Contact> thinned_out(const std::vector<Contact>& contacts) {
  if (contacts.size() <= 4) return contacts;
  const auto greatest = [&](const auto& measure) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < contacts.size(); ++k)
      if (measure(contacts[k]) > measure(contacts[best])) best = k;
    return contacts[best];
  };
  const Contact first = greatest([](const Contact& c) { return -c.gap; });
  const Contact second = greatest([&](const Contact& c) { return (c.point - first.point).norm(); });
  const Vector3d across = first.normal.cross(second.point - first.point);
  const Contact third = greatest([&](const Contact& c) { return across.dot(c.point - first.point); });
  const Contact fourth = greatest([&](const Contact& c) { return -across.dot(c.point - first.point); });
  return {first, second, third, fourth};
}

}  // namespace wavetank
