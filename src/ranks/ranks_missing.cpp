// In the place of ranks_mpi.cpp, where there is no MPI.
#include "wavetank/common/error.h"
#include "wavetank/ranks/ranks.h"

namespace wavetank::parallel {

std::unique_ptr<Ranks> join_ranks() {
  throw Error(
      "mpirun has started this program, which was built without MPI: install libopenmpi-dev (scripts/install --mpi) and build it again, or "
      "run it without mpirun.");
}

}  // namespace wavetank::parallel
