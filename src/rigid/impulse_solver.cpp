#include "impulse_solver.h"

#include <BulletCollision/CollisionShapes/btEmptyShape.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "bullet_types.h"

namespace wavetank {

/// Fills Bullet's pools of rows, lets it iterate and takes the velocities out.
class ImpulseSolver::Rows : public btSequentialImpulseConstraintSolver {
 public:
  Rows() : mark_(1.0, nullptr, &shape_) {}

  const std::vector<SolverBody>* bodies = nullptr;
  const std::vector<Contact>* contacts = nullptr;
  const std::vector<JointRow>* joints = nullptr;
  const SolverSettings* settings = nullptr;
  std::vector<BodyChange> changes;

 protected:
  btScalar solveGroupCacheFriendlySetup(btCollisionObject**, int, btPersistentManifold**, int, btTypedConstraint**, int,
                                        const btContactSolverInfo&, btIDebugDraw*) override;
  void solveGroupCacheFriendlySplitImpulseIterations(btCollisionObject**, int, btPersistentManifold**, int, btTypedConstraint**, int,
                                                     const btContactSolverInfo&, btIDebugDraw*) override;
  btScalar solveGroupCacheFriendlyFinish(btCollisionObject**, int, const btContactSolverInfo&) override;

 private:
  void add_bodies();
  void add_joints();
  void add_contact(const Contact& contact);
  void add_friction(const Contact& contact, int index, const Vector3d& direction);
  /// The row that both kinds share: what it measures, and how an impulse along it acts.
  void fill(btSolverConstraint& row, int a, int b, const Vector3d& linear, const Vector3d& angular_a, const Vector3d& angular_b) const;
  /// What the row measures of the velocities without contacts and joints.
  double measured(const btSolverConstraint& row) const;
  /// One row's turn in finding the push velocities; returns by how much it has changed what the row measures of them.
  double push(btSolverConstraint& row);

  btEmptyShape shape_;
  btRigidBody mark_;  ///< that a solver body answers to impulses; nothing of it is used
};

void ImpulseSolver::Rows::add_bodies() {
  m_tmpSolverBodyPool.resizeNoInitialize(0);
  for (const SolverBody& body : *bodies) {
    btSolverBody& added = m_tmpSolverBodyPool.expandNonInitializing();
    added.m_worldTransform.setIdentity();
    for (btVector3* zero : {&added.m_deltaLinearVelocity, &added.m_deltaAngularVelocity, &added.m_pushVelocity, &added.m_turnVelocity,
                            &added.m_externalForceImpulse, &added.m_externalTorqueImpulse})
      zero->setZero();
    added.m_linearFactor.setValue(1, 1, 1);
    added.m_angularFactor.setValue(1, 1, 1);
    added.m_invMass.setValue(body.inverse_mass, body.inverse_mass, body.inverse_mass);
    added.m_linearVelocity = to_bullet(body.velocity);
    added.m_angularVelocity = to_bullet(body.angular_velocity);
    added.m_originalBody = body.inverse_mass > 0 ? &mark_ : nullptr;
  }
}

void ImpulseSolver::Rows::fill(btSolverConstraint& row, int a, int b, const Vector3d& linear, const Vector3d& angular_a,
                               const Vector3d& angular_b) const {
  row = btSolverConstraint();
  const SolverBody &first = (*bodies)[a], &second = (*bodies)[b];
  const Vector3d turn_a = first.inverse_inertia * angular_a, turn_b = second.inverse_inertia * angular_b;
  row.m_contactNormal1 = to_bullet(linear);
  row.m_contactNormal2 = -row.m_contactNormal1;
  row.m_relpos1CrossNormal = to_bullet(angular_a);
  row.m_relpos2CrossNormal = -to_bullet(angular_b);
  row.m_angularComponentA = to_bullet(turn_a);
  row.m_angularComponentB = -to_bullet(turn_b);
  const double answer = (first.inverse_mass + second.inverse_mass) * linear.squaredNorm() + turn_a.dot(angular_a) + turn_b.dot(angular_b);
  row.m_jacDiagABInv = answer > 0 ? 1 / answer : 0;
  row.m_appliedImpulse = row.m_appliedPushImpulse = 0;
  row.m_friction = row.m_cfm = row.m_rhsPenetration = 0;
  row.m_originalContactPoint = nullptr;
  row.m_overrideNumSolverIterations = settings->iterations;
  row.m_frictionIndex = 0;
  row.m_solverBodyIdA = a;
  row.m_solverBodyIdB = b;
}

double ImpulseSolver::Rows::measured(const btSolverConstraint& row) const {
  const btSolverBody &a = m_tmpSolverBodyPool[row.m_solverBodyIdA], &b = m_tmpSolverBodyPool[row.m_solverBodyIdB];
  return row.m_contactNormal1.dot(a.m_linearVelocity) + row.m_relpos1CrossNormal.dot(a.m_angularVelocity) +
         row.m_contactNormal2.dot(b.m_linearVelocity) + row.m_relpos2CrossNormal.dot(b.m_angularVelocity);
}

void ImpulseSolver::Rows::add_joints() {
  m_tmpSolverNonContactConstraintPool.resizeNoInitialize(0);
  for (const JointRow& joint : *joints) {
    btSolverConstraint& row = m_tmpSolverNonContactConstraintPool.expandNonInitializing();
    fill(row, joint.a, joint.b, joint.linear, joint.angular_a, joint.angular_b);
    row.m_rhs = (joint.target - measured(row)) * row.m_jacDiagABInv;
    row.m_rhsPenetration = joint.push * row.m_jacDiagABInv;
    row.m_lowerLimit = joint.least_impulse;
    row.m_upperLimit = joint.greatest_impulse;
  }
}

void ImpulseSolver::Rows::add_contact(const Contact& contact) {
  const Vector3d arm_a = contact.point - (*bodies)[contact.a].centre, arm_b = contact.point - (*bodies)[contact.b].centre;
  const int index = m_tmpSolverContactConstraintPool.size();
  btSolverConstraint& row = m_tmpSolverContactConstraintPool.expandNonInitializing();
  fill(row, contact.a, contact.b, contact.normal, arm_a.cross(contact.normal), arm_b.cross(contact.normal));
  const double approach = measured(row), time_step = settings->time_step;
  // What is apart may come together in this step, no more; what meets in it rebounds.
  double target = -std::max(contact.gap, 0.0) / time_step;
  if (approach * time_step + std::max(contact.gap, 0.0) < 0 && -approach > settings->least_rebound)
    target = std::max(target, -contact.restitution * approach);
  row.m_rhs = (target - approach) * row.m_jacDiagABInv;
  row.m_rhsPenetration = std::max(-contact.gap - settings->slop, 0.0) * settings->correction / time_step * row.m_jacDiagABInv;
  row.m_lowerLimit = 0;
  row.m_upperLimit = 1e300;
  row.m_friction = contact.friction;

  const SolverBody &a = (*bodies)[contact.a], &b = (*bodies)[contact.b];
  const Vector3d relative = a.velocity + a.angular_velocity.cross(arm_a) - b.velocity - b.angular_velocity.cross(arm_b);
  Vector3d slip = relative - relative.dot(contact.normal) * contact.normal;
  // Friction works along the slip, so that it has Coulomb's size whatever the direction, and across it.
  if (settings->planar) {
    add_friction(contact, index, contact.normal.cross(Vector3d::UnitY()));
    return;
  }
  if (slip.norm() > 1e-12) {
    slip.normalize();
  } else {
    slip = contact.normal.unitOrthogonal();
  }
  add_friction(contact, index, slip);
  add_friction(contact, index, contact.normal.cross(slip));
}

void ImpulseSolver::Rows::add_friction(const Contact& contact, int index, const Vector3d& direction) {
  if (!(contact.friction > 0)) return;
  const Vector3d arm_a = contact.point - (*bodies)[contact.a].centre, arm_b = contact.point - (*bodies)[contact.b].centre;
  btSolverConstraint& row = m_tmpSolverContactFrictionConstraintPool.expandNonInitializing();
  fill(row, contact.a, contact.b, direction, arm_a.cross(direction), arm_b.cross(direction));
  row.m_rhs = -measured(row) * row.m_jacDiagABInv;
  row.m_lowerLimit = row.m_upperLimit = 0;  // set by Bullet from the contact's impulse
  row.m_friction = contact.friction;
  row.m_frictionIndex = index;
}

btScalar ImpulseSolver::Rows::solveGroupCacheFriendlySetup(btCollisionObject**, int, btPersistentManifold**, int, btTypedConstraint**, int,
                                                           const btContactSolverInfo&, btIDebugDraw*) {
  m_maxOverrideNumSolverIterations = 0;
  add_bodies();
  add_joints();
  m_tmpSolverContactConstraintPool.resizeNoInitialize(0);
  m_tmpSolverContactFrictionConstraintPool.resizeNoInitialize(0);
  m_tmpSolverContactRollingFrictionConstraintPool.resizeNoInitialize(0);
  for (const Contact& contact : *contacts) add_contact(contact);
  const auto number = [](btAlignedObjectArray<int>& order, int size) {
    order.resizeNoInitialize(size);
    for (int k = 0; k < size; ++k) order[k] = k;
  };
  number(m_orderNonContactConstraintPool, m_tmpSolverNonContactConstraintPool.size());
  number(m_orderTmpConstraintPool, m_tmpSolverContactConstraintPool.size());
  number(m_orderFrictionConstraintPool, m_tmpSolverContactFrictionConstraintPool.size());
  return 0;
}

double ImpulseSolver::Rows::push(btSolverConstraint& row) {
  if (row.m_jacDiagABInv == 0) return 0;
  btSolverBody &a = m_tmpSolverBodyPool[row.m_solverBodyIdA], &b = m_tmpSolverBodyPool[row.m_solverBodyIdB];
  const double speed = row.m_contactNormal1.dot(a.internalGetPushVelocity()) + row.m_relpos1CrossNormal.dot(a.internalGetTurnVelocity()) +
                       row.m_contactNormal2.dot(b.internalGetPushVelocity()) + row.m_relpos2CrossNormal.dot(b.internalGetTurnVelocity());
  const double before = row.m_appliedPushImpulse;
  const double after = std::clamp<double>(before + row.m_rhsPenetration - speed * row.m_jacDiagABInv, row.m_lowerLimit, row.m_upperLimit);
  row.m_appliedPushImpulse = after;
  a.internalApplyPushImpulse(row.m_contactNormal1 * a.internalGetInvMass(), row.m_angularComponentA, after - before);
  b.internalApplyPushImpulse(row.m_contactNormal2 * b.internalGetInvMass(), row.m_angularComponentB, after - before);
  return (after - before) / row.m_jacDiagABInv;
}

/// As Bullet's, but with the joints: what is pushed out of an overlap or back to a limit takes along what hangs on it.
void ImpulseSolver::Rows::solveGroupCacheFriendlySplitImpulseIterations(btCollisionObject**, int, btPersistentManifold**, int,
                                                                        btTypedConstraint**, int, const btContactSolverInfo& info,
                                                                        btIDebugDraw*) {
  for (int iteration = 0; iteration < info.m_numIterations; ++iteration) {
    double greatest = 0;
    const auto take_turn = [&](btSolverConstraint& row, bool two_sided) {
      if (two_sided || row.m_rhsPenetration != 0) greatest = std::max(greatest, std::abs(push(row)));
    };
    for (std::size_t k = 0; k < joints->size(); ++k)
      take_turn(m_tmpSolverNonContactConstraintPool[static_cast<int>(k)], !(*joints)[k].one_sided());
    for (int k = 0; k < m_tmpSolverContactConstraintPool.size(); ++k) take_turn(m_tmpSolverContactConstraintPool[k], false);
    if (greatest * greatest <= info.m_leastSquaresResidualThreshold) break;
  }
}

btScalar ImpulseSolver::Rows::solveGroupCacheFriendlyFinish(btCollisionObject**, int, const btContactSolverInfo&) {
  changes.assign(bodies->size(), {});
  for (std::size_t k = 0; k < bodies->size(); ++k) {
    const btSolverBody& body = m_tmpSolverBodyPool[static_cast<int>(k)];
    changes[k].velocity = from_bullet(body.m_deltaLinearVelocity);
    changes[k].angular_velocity = from_bullet(body.m_deltaAngularVelocity);
    changes[k].push = from_bullet(body.m_pushVelocity);
    changes[k].turn = from_bullet(body.m_turnVelocity);
  }
  const auto touch = [&](const btSolverConstraint& row) {
    if (row.m_appliedImpulse != 0 || row.m_appliedPushImpulse != 0)
      changes[row.m_solverBodyIdA].touched = changes[row.m_solverBodyIdB].touched = true;
  };
  for (int k = 0; k < m_tmpSolverContactConstraintPool.size(); ++k) touch(m_tmpSolverContactConstraintPool[k]);
  for (std::size_t k = 0; k < joints->size(); ++k)
    if ((*joints)[k].one_sided()) touch(m_tmpSolverNonContactConstraintPool[static_cast<int>(k)]);
  return 0;
}

ImpulseSolver::ImpulseSolver() : rows_(std::make_unique<Rows>()) {}
ImpulseSolver::~ImpulseSolver() = default;

std::vector<BodyChange> ImpulseSolver::solve(const std::vector<SolverBody>& bodies, const std::vector<Contact>& contacts,
                                             const std::vector<JointRow>& rows, const SolverSettings& settings) {
  rows_->bodies = &bodies;
  rows_->contacts = &contacts;
  rows_->joints = &rows;
  rows_->settings = &settings;
  btContactSolverInfo info;
  info.m_timeStep = settings.time_step;
  info.m_numIterations = settings.iterations;
  info.m_solverMode = 0;  // the rows in their order, one by one, without a warm start
  info.m_splitImpulse = 1;
  info.m_leastSquaresResidualThreshold = settings.resolution * settings.resolution;
  rows_->reset();
  rows_->solveGroup(nullptr, 0, nullptr, 0, nullptr, 0, info, nullptr, nullptr);
  return std::move(rows_->changes);
}

}  // namespace wavetank
