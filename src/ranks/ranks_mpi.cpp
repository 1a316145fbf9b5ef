// The ranks of MPI. Nothing here waits within MPI, whose own waits would neither see that a rank has failed nor leave its cores to others.
#define OMPI_SKIP_MPICXX 1  // of MPI the C interface alone, whichever it is
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <list>
#include <thread>
#include <type_traits>
#include <utility>

#include "wavetank/common/ending_signals.h"
#include "wavetank/common/error.h"
#include "wavetank/common/log.h"
#include "wavetank/common/stopwatch.h"
#include "wavetank/ranks/ranks.h"

namespace wavetank::parallel {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int code_of_trouble = 2;          // as other errors
constexpr double patience = 300;            // s, with a rank that does not answer
constexpr double patience_when_ending = 5;  // the same, once the run shall end: mpirun then kills soon
constexpr double patience_with_living = 20;
constexpr std::size_t piece = std::size_t{1} << 30;  // bytes: MPI counts in int

/// Of a communicator's own messages.
enum Tag { of_group, of_order, of_reply, of_end, of_farewell, of_trouble };

void check(int code, const char* call) {
  if (code == MPI_SUCCESS) return;
  char text[MPI_MAX_ERROR_STRING] = "";
  int length = 0;
  MPI_Error_string(code, text, &length);
  throw Error(std::string(call) + " failed: " + std::string(text, static_cast<std::size_t>(length)));
}

/// Another rank has told of its trouble, to all.
struct Told : Error {
  using Error::Error;
};

/// What others never answered may be under way still, for which some MPI waits here for ever.
void finalize() {
  std::thread([] {
    std::this_thread::sleep_for(std::chrono::seconds(20));
    std::fflush(nullptr);
    std::_Exit(code_of_trouble);
  }).detach();
  MPI_Finalize();
}

/// How long somebody waits, and how gently. By the clock: on a busy machine each look that gives way to others may take milliseconds.
class Waiting {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }
  bool is_long() const { return seconds() > 0.02; }
  /// Now and then, more seldom the longer it takes.
  bool is_time_to_look_around() const { return is_long() || looks_ % 64 == 63; }
  void rest() {
    ++looks_;
    const double waited = seconds();
    if (waited > 1)  // a tank that is paused, say
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    else if (waited > 0.2)
      std::this_thread::sleep_for(std::chrono::microseconds(500));
    else if (is_long())
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    else if (looks_ > 100)
      std::this_thread::yield();
  }

 private:
  Clock::time_point begin_ = Clock::now();
  int looks_ = 0;
};

/// What each rank tells of its process at the beginning.
struct Process {
  long pid = 0;
  char machine[64] = "";
};

class MpiRanks final : public Ranks, private Group {
 public:
  MpiRanks();
  ~MpiRanks() override = default;

  int size() const override { return size_; }
  int rank() const override { return rank_; }
  int rank_on_machine() const override { return rank_on_machine_; }
  std::vector<int> here() const override { return {rank_}; }
  Group& member(int) override { return *this; }
  std::string name_of(int rank) const override;
  std::vector<Bytes> ask(const Bytes& order, const Work& work) override;
  int serve(const Work& work) override;
  int end(int code) override;
  double waited() const override { return waiting_.seconds(); }

 private:
  /// A message under way: its bytes must stay until it is there.
  struct Sent {
    Bytes bytes;
    std::vector<MPI_Request> requests;
  };
  /// A piece of one that comes, likewise.
  struct Coming {
    Bytes bytes;
    MPI_Request request = MPI_REQUEST_NULL;
  };
  /// A reduction under way, likewise, whatever becomes of it.
  template <class T>
  struct Reduction {
    std::vector<T> given, combined;
    MPI_Request request = MPI_REQUEST_NULL;
  };
  enum class Patience {
    limited,     ///< less once the run shall end
    of_message,  ///< of one that has begun: it may take its time even then
    endless
  };

  void send(int to, Bytes bytes) override { post(to, of_group, std::move(bytes)); }
  Bytes receive(int from) override { return take(from, of_group, Patience::limited); }
  std::vector<double> greatest(const std::vector<double>& values) override { return combine(reals_, values, MPI_DOUBLE, MPI_MAX); }
  std::vector<std::int64_t> sums(const std::vector<std::int64_t>& values) override {
    return combine(integers_, values, MPI_INT64_T, MPI_SUM);
  }
  std::vector<std::int64_t> least(const std::vector<std::int64_t>& values) override {
    return combine(integers_, values, MPI_INT64_T, MPI_MIN);
  }

  template <class T>
  std::vector<T> combine(std::list<Reduction<T>>& kept, const std::vector<T>& values, MPI_Datatype type, MPI_Op operation);
  void post(int to, Tag tag, Bytes bytes);
  Bytes take(int from, Tag tag, Patience limit);
  /// A message whose beginning is there. The rest needs the sender still, who may end in the middle of it: MPI_Recv would wait for ever.
  Bytes read(int from, Tag tag, Patience limit);
  Bytes read_piece(int from, Tag tag, Patience limit);
  bool is_there(int from, Tag tag) const;
  static bool is_done(MPI_Request& request);
  /// Until `done`, for the sake of rank `whom`, or of all (-1).
  template <class Done>
  void wait(int whom, Patience limit, const Done& done);
  void forget_what_is_sent();
  void look_for_trouble();
  /// Of those that can be seen from here; -1: none is gone.
  int find_dead(int whom) const;
  [[noreturn]] void stop(const std::string& why);
  /// Tells all others.
  void fail(const std::string& why);
  void check_whole() const;
  std::string gone(int rank) const;
  /// Of rank 0, when it has told that the run is over.
  int take_leave();
  int wait_for_the_end();
  void wait_until_gone(double seconds) const;

  int size_ = 1, rank_ = 0, rank_on_machine_ = 0;
  MPI_Comm comm_ = MPI_COMM_NULL;
  std::vector<Process> processes_;
  std::vector<bool> is_visible_;  ///< processes that can be looked at from here
  std::list<Sent> sent_;
  std::list<Coming> coming_;
  std::list<Reduction<double>> reals_;
  std::list<Reduction<std::int64_t>> integers_;
  std::string failed_;  ///< why, once there is no more to be had of the ranks
  bool has_told_ = false;
  Stopwatch waiting_;
};

MpiRanks::MpiRanks() {
  int provided = 0;
  check(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided), "MPI_Init_thread");
  if (provided < MPI_THREAD_SERIALIZED) throw Error("this MPI serves one thread alone: the solver needs MPI_THREAD_SERIALIZED.");
  check(MPI_Comm_dup(MPI_COMM_WORLD, &comm_), "MPI_Comm_dup");
  check(MPI_Comm_set_errhandler(comm_, MPI_ERRORS_RETURN), "MPI_Comm_set_errhandler");
  check(MPI_Comm_size(comm_, &size_), "MPI_Comm_size");
  check(MPI_Comm_rank(comm_, &rank_), "MPI_Comm_rank");
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* const started = std::getenv(name))
      if (std::atoi(started) != size_)
        throw Error(std::string("the launcher has started ") + started + " ranks, but MPI knows of " + std::to_string(size_) +
                    ": start it by the mpirun of the MPI that it was built with.");
  Process own;
  own.pid = static_cast<long>(getpid());
  gethostname(own.machine, sizeof own.machine - 1);
  processes_.resize(static_cast<std::size_t>(size_));
  check(MPI_Allgather(&own, sizeof own, MPI_BYTE, processes_.data(), sizeof own, MPI_BYTE, comm_), "MPI_Allgather");
  for (int k = 0; k < size_; ++k) {
    const bool is_here = std::strcmp(processes_[k].machine, own.machine) == 0;
    if (is_here && k < rank_) ++rank_on_machine_;
    is_visible_.push_back(is_here && kill(static_cast<pid_t>(processes_[k].pid), 0) == 0);
  }
}

std::string MpiRanks::name_of(int rank) const {
  return "part " + std::to_string(rank) + " of " + std::to_string(size_) + " (process " + std::to_string(processes_[rank].pid) + " on " +
         processes_[rank].machine + ")";
}

std::string MpiRanks::gone(int rank) const { return name_of(rank) + " has ended without a word"; }

void MpiRanks::check_whole() const {
  if (!failed_.empty()) throw Error("there is no more to be had of the water's parts, since one has stopped");
}

void MpiRanks::stop(const std::string& why) {
  failed_ = why;
  throw Error(why);
}

void MpiRanks::fail(const std::string& why) {
  if (has_told_) return;
  has_told_ = true;
  failed_ = why;
  for (int other = 0; other < size_; ++other)
    if (other != rank_ && find_dead(other) < 0) post(other, of_trouble, Bytes(why.begin(), why.end()));
}

void MpiRanks::post(int to, Tag tag, Bytes bytes) {
  if (tag == of_group || tag == of_order || tag == of_reply) check_whole();
  sent_.push_back({std::move(bytes), {}});
  Sent& sent = sent_.back();
  std::size_t first = 0;
  while (true) {  // a whole piece is followed by another, or by an empty one
    const std::size_t count = std::min(piece, sent.bytes.size() - first);
    sent.requests.push_back(MPI_REQUEST_NULL);
    check(MPI_Isend(sent.bytes.data() + first, static_cast<int>(count), MPI_BYTE, to, tag, comm_, &sent.requests.back()), "MPI_Isend");
    first += count;
    if (count < piece) break;
  }
  forget_what_is_sent();
}

void MpiRanks::forget_what_is_sent() {
  sent_.remove_if([](Sent& sent) {
    int done = 0;
    check(MPI_Testall(static_cast<int>(sent.requests.size()), sent.requests.data(), &done, MPI_STATUSES_IGNORE), "MPI_Testall");
    return done != 0;
  });
}

bool MpiRanks::is_there(int from, Tag tag) const {
  int there = 0;
  check(MPI_Iprobe(from, tag, comm_, &there, MPI_STATUS_IGNORE), "MPI_Iprobe");
  return there != 0;
}

bool MpiRanks::is_done(MPI_Request& request) {
  int done = 0;
  check(MPI_Test(&request, &done, MPI_STATUS_IGNORE), "MPI_Test");
  return done != 0;
}

Bytes MpiRanks::read_piece(int from, Tag tag, Patience limit) {
  wait(from, limit, [&] { return is_there(from, tag); });
  MPI_Status status;
  check(MPI_Probe(from, tag, comm_, &status), "MPI_Probe");
  int count = 0;
  check(MPI_Get_count(&status, MPI_BYTE, &count), "MPI_Get_count");
  const auto coming = coming_.insert(coming_.end(), Coming{Bytes(static_cast<std::size_t>(count)), MPI_REQUEST_NULL});
  check(MPI_Irecv(coming->bytes.data(), count, MPI_BYTE, from, tag, comm_, &coming->request), "MPI_Irecv");
  wait(from, Patience::of_message, [&] { return is_done(coming->request); });
  Bytes bytes = std::move(coming->bytes);
  coming_.erase(coming);
  return bytes;
}

Bytes MpiRanks::read(int from, Tag tag, Patience limit) {
  Bytes bytes = read_piece(from, tag, limit);
  std::size_t last = bytes.size();
  while (last == piece) {
    const Bytes more = read_piece(from, tag, limit);
    bytes.insert(bytes.end(), more.begin(), more.end());
    last = more.size();
  }
  return bytes;
}

Bytes MpiRanks::take(int from, Tag tag, Patience limit) {
  check_whole();
  return read(from, tag, limit);
}

template <class Done>
void MpiRanks::wait(int whom, Patience limit, const Done& done) {
  const Stopwatch::Lap lap(waiting_);
  Waiting waiting;
  Clock::time_point heard_at;
  bool heard = false;
  while (!done()) {
    if (waiting.is_time_to_look_around()) {
      look_for_trouble();
      forget_what_is_sent();
    }
    if (waiting.is_long()) {
      const int dead = find_dead(whom);
      if (dead >= 0 && !done()) stop(gone(dead));
      if (!heard && EndingSignals::heard()) {
        heard = true;
        heard_at = Clock::now();
      }
      const double ending = heard ? std::chrono::duration<double>(Clock::now() - heard_at).count() : 0;
      const std::string who = whom < 0 ? "a part of the water" : name_of(whom);
      const bool is_seen = whom >= 0 ? is_visible_[whom] : std::find(is_visible_.begin(), is_visible_.end(), false) == is_visible_.end();
      if (limit != Patience::endless && waiting.seconds() > patience) stop(who + " has not answered for 300 s");
      if (limit == Patience::limited && ending > (is_seen ? patience_with_living : patience_when_ending))
        stop(who + " has not answered since the run was asked to end");
    }
    waiting.rest();
  }
}

template <class T>
std::vector<T> MpiRanks::combine(std::list<Reduction<T>>& kept, const std::vector<T>& values, MPI_Datatype type, MPI_Op operation) {
  check_whole();
  kept.emplace_back();
  Reduction<T>& reduction = kept.back();
  reduction.given = values;
  reduction.combined.resize(values.size());
  check(MPI_Iallreduce(reduction.given.data(), reduction.combined.data(), static_cast<int>(values.size()), type, operation, comm_,
                       &reduction.request),
        "MPI_Iallreduce");
  wait(-1, Patience::limited, [&] { return is_done(reduction.request); });
  std::vector<T> combined = std::move(reduction.combined);
  kept.pop_back();
  return combined;
}

void MpiRanks::look_for_trouble() {
  int there = 0;
  MPI_Status status;
  check(MPI_Iprobe(MPI_ANY_SOURCE, of_trouble, comm_, &there, &status), "MPI_Iprobe");
  if (there == 0) return;
  const Bytes why = read(status.MPI_SOURCE, of_trouble, Patience::limited);
  failed_ = name_of(status.MPI_SOURCE) + " has stopped: " + std::string(why.begin(), why.end());
  throw Told(failed_);
}

int MpiRanks::find_dead(int whom) const {
  for (int other = 0; other < size_; ++other)
    if ((whom < 0 || whom == other) && is_visible_[other] && kill(static_cast<pid_t>(processes_[other].pid), 0) != 0 && errno == ESRCH)
      return other;
  return -1;
}

std::vector<Bytes> MpiRanks::ask(const Bytes& order, const Work& work) {
  check_whole();
  try {
    for (int other = 1; other < size_; ++other) post(other, of_order, order);
    std::vector<Bytes> replies{work(0, order)};
    for (int other = 1; other < size_; ++other) replies.push_back(take(other, of_reply, Patience::limited));
    return replies;
  } catch (const std::exception& error) {
    fail(error.what());
    throw;
  }
}

int MpiRanks::serve(const Work& work) {
  try {
    while (true) {
      bool ends = false;
      wait(0, Patience::endless, [&] { return (ends = is_there(0, of_end)) || is_there(0, of_order); });
      if (ends) break;
      post(0, of_reply, work(rank_, read(0, of_order, Patience::endless)));
    }
  } catch (const Told&) {
    return wait_for_the_end();
  } catch (const std::exception& error) {
    fail(error.what());
    return wait_for_the_end();
  }
  return take_leave();
}

/// mpirun ends all as soon as one exits with another code than 0, or without MPI_Finalize, and takes its time for it: that is left to
/// rank 0, which is the last to exit.
int MpiRanks::take_leave() {
  try {
    read(0, of_end, Patience::limited);
  } catch (const std::exception&) {  // of others' trouble, which rank 0 knows of
  }
  post(0, of_farewell, {});
  finalize();
  return 0;
}

/// After a failure, of which rank 0 is to tell, and to close its files.
int MpiRanks::wait_for_the_end() {
  Waiting waiting;
  while (find_dead(0) < 0 && waiting.seconds() < patience) {
    if (is_there(0, of_end)) return take_leave();
    forget_what_is_sent();
    waiting.rest();
  }
  return code_of_trouble;
}

int MpiRanks::end(int code) {
  const bool was_whole = failed_.empty();
  bool all_answer = true;
  const auto tell = [this](const std::string& why) {
    if (failed_.empty()) log(LogLevel::error, why);
    failed_ = why;
  };
  std::vector<int> awaited;
  for (int other = 1; other < size_; ++other) {
    awaited.push_back(other);
    if (find_dead(other) < 0) post(other, of_end, {});
  }
  const auto has_left = [&](int other) {
    if (is_there(other, of_farewell)) return true;
    if (find_dead(other) < 0) return false;
    all_answer = false;
    tell(gone(other));
    return true;
  };
  for (Waiting waiting; !awaited.empty() && waiting.seconds() < patience_with_living; waiting.rest()) {
    try {
      look_for_trouble();
    } catch (const std::exception& trouble) {
      if (was_whole) log(LogLevel::error, trouble.what());
    }
    awaited.erase(std::remove_if(awaited.begin(), awaited.end(), has_left), awaited.end());
    forget_what_is_sent();
  }
  if (all_answer && awaited.empty()) {
    finalize();
    wait_until_gone(2);
  }
  const bool says_nothing = code == 0 || code > 128;  // the latter as of a signal
  return was_whole && !failed_.empty() && says_nothing ? code_of_trouble : code;
}

/// Until mpirun has taken note of the others' ends.
void MpiRanks::wait_until_gone(double seconds) const {
  Waiting waiting;
  for (int other = 0; other < size_; ++other)
    while (other != rank_ && is_visible_[other] && find_dead(other) < 0 && waiting.seconds() < seconds) waiting.rest();
}

}  // namespace

std::unique_ptr<Ranks> join_ranks() { return std::make_unique<MpiRanks>(); }

}  // namespace wavetank::parallel
