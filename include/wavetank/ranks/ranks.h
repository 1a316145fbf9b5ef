#pragma once

#include <memory>

#include "wavetank/parallel/group.h"

namespace wavetank::parallel {

/// Whether mpirun, or another launcher of MPI, has started this process, as its environment tells, and as which rank.
bool is_under_launcher();
int rank_by_launcher();

/// The processes that a launcher has started, as parts of one computation: each has one, and rank 0 says what is done. Calls are made by
/// one thread at a time.
///
/// A rank that fails tells all others why, out of turn, and they stop where they wait for one. Of a rank on the same machine the others see
/// that its process is gone, within a second; of one elsewhere nothing is known but that it does not answer: 300 s are waited for it, 5 s
/// once an EndingSignals has heard that the run shall end, which is how mpirun tells of a rank that has died. After any of these there is
/// no more to be had of the parts, and all calls throw Error.
class Ranks : public Team {
 public:
  virtual int rank() const = 0;
  virtual int rank_on_machine() const = 0;  ///< among those on the same machine, from 0
  /// By all ranks but 0: does what rank 0 asks for, until that ends the run. Returns the code to exit with: 0 where rank 0 has told how it
  /// ended, by which mpirun goes then.
  virtual int serve(const Work& work) = 0;
  /// By rank 0, last of all: the others then exit. Returns the code to exit with: `code`, or that of an error where a rank is found dead,
  /// or in trouble, of which nobody has told.
  virtual int end(int code) = 0;
  /// s, that this rank has waited for others.
  virtual double waited() const = 0;
};

/// Makes this process one of the ranks. An EndingSignals should live already, since MPI starts threads. Throws Error, in one sentence,
/// where the program was built without MPI or the launcher is another MPI's.
std::unique_ptr<Ranks> join_ranks();

}  // namespace wavetank::parallel
