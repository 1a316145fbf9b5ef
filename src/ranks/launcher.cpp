#include <cstdlib>

#include "wavetank/ranks/ranks.h"

namespace wavetank::parallel {

// Open MPI's, that of PMIx, which Slurm has too, and PMI's, which MPICH has.
bool is_under_launcher() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_SIZE"})
    if (std::getenv(name) != nullptr) return true;
  return false;
}

int rank_by_launcher() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"})
    if (const char* const rank = std::getenv(name)) return std::atoi(rank);
  return 0;
}

}  // namespace wavetank::parallel
