#include "wavetank/node/rank_programs.h"

#include "wavetank/common/log.h"
#include "wavetank/node/resources.h"
#include "wavetank/simulation/part_work.h"

namespace wavetank {

int serve_first_rank(parallel::Ranks& ranks) {
  set_log_sink([](LogLevel, const std::string&) {});  // the first says the same
  return ranks.serve(part_work(ranks.member(ranks.rank()), ranks.rank_on_machine(), resolve_resource));
}

}  // namespace wavetank
