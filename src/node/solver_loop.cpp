#include "wavetank/node/solver_loop.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "wavetank/common/error.h"
#include "wavetank/common/log.h"
#include "wavetank/common/whole_file.h"

namespace wavetank {

namespace {

constexpr auto idle_period = std::chrono::milliseconds(20);

/// Thrown through the simulation's start when the loop is stopped meanwhile.
struct Abandoned : std::exception {
  const char* what() const noexcept override { return "the start was abandoned"; }
};

std::string seconds_text(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4f s", seconds);
  return text;
}

}  // namespace

SolverLoop::SolverLoop(Case checked, SimulationOptions options, LoopSettings settings, LoopHooks hooks)
    : case_(std::move(checked)), options_(std::move(options)), settings_(std::move(settings)), hooks_(std::move(hooks)) {
  status_.paused = settings_.paused;
  thread_ = std::thread([this] { run(); });
}

SolverLoop::~SolverLoop() { stop(); }

void SolverLoop::stop() {
  stopping_ = true;
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

LoopStatus SolverLoop::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return status_;
}

// ---------------------------------------------------------------- the solver's thread

void SolverLoop::run() {
  try {
    start();
    loop();
  } catch (const Abandoned&) {
    log(LogLevel::info, "the start was abandoned");
  } catch (const Violation& violation) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      status_.is_violation = true;
    }
    fail(violation.what());
  } catch (const std::exception& error) {
    fail(error.what());
  }
  refuse_requests();
  try {
    hooks_.ended(status());
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

void SolverLoop::start() {
  const auto callers_progress = options_.progress;
  options_.progress = [this, callers_progress](const std::string& what, double fraction) {
    if (stopping_) throw Abandoned();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      status_.start_progress = fraction;
    }
    if (callers_progress) callers_progress(what, fraction);
  };
  simulation_ = std::make_unique<Simulation>(case_, options_);
  if (!settings_.restore_from.empty()) simulation_->restore(settings_.restore_from);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    status_.start_progress = 1.0;
    status_.has_started = true;
    status_.solver = simulation_->state();
    status_.energies = simulation_->energies();
    status_.device = simulation_->device_description();
    accepts_requests_ = true;
  }
  if (hooks_.started) hooks_.started(*simulation_);
  while (!stopping_ && settings_.may_start && !settings_.may_start()) {
    serve_requests();
    hooks_.idle(*simulation_);
    std::this_thread::sleep_for(idle_period);
  }
  pass_on_samples();
}

void SolverLoop::loop() {
  while (!stopping_) {
    serve_requests();
    answer_advance();
    {
      std::unique_lock<std::mutex> lock(mutex_);
      const bool paused = status_.paused && !advancing_;
      const bool finished = status_.solver.time >= case_.duration;
      status_.phase = finished ? LoopPhase::finished : paused ? LoopPhase::paused : LoopPhase::running;
      if (finished || paused) {
        pace_known_ = false;
        wake_.wait_for(lock, idle_period, [this] { return stopping_ || !requests_.empty(); });
        lock.unlock();
        hooks_.idle(*simulation_);
        continue;
      }
    }
    if (wait_for_pace()) advance();
    hooks_.idle(*simulation_);
  }
}

void SolverLoop::advance() {
  if (hooks_.before_step) hooks_.before_step(*simulation_);
  try {
    simulation_->advance();
  } catch (const Violation&) {
    if (hooks_.violated) hooks_.violated();
    pass_on_samples();
    throw;
  }
  pass_on_samples();
}

void SolverLoop::pass_on_samples() {
  const Samples samples = simulation_->take_samples();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    status_.solver = simulation_->state();
    if (!samples.energies.empty()) status_.energies = samples.energies.back();
  }
  hooks_.stepped(*simulation_, samples);
}

bool SolverLoop::wait_for_pace() {
  if (case_.publishing.real_time_factor <= 0.0) return true;
  const double time = simulation_->state().time;
  const Clock::time_point now = Clock::now();
  const auto due = [&] {
    return pace_wall_ + std::chrono::duration_cast<Clock::duration>(
                            std::chrono::duration<double>((time - pace_time_) / case_.publishing.real_time_factor));
  };
  // The factor is an upper limit: time lost is not made up for by a burst.
  if (!pace_known_ || now > due() + std::chrono::milliseconds(100)) {
    pace_known_ = true;
    pace_wall_ = now;
    pace_time_ = time;
  }
  if (now >= due()) return true;
  std::unique_lock<std::mutex> lock(mutex_);
  wake_.wait_until(lock, std::min(due(), now + idle_period), [this] { return stopping_ || !requests_.empty(); });
  return Clock::now() >= due() && !stopping_;
}

void SolverLoop::fail(const std::string& why) {
  cut_advance_short(why);
  std::string failure = why;
  if (status().has_started && !settings_.failure_snapshot.empty()) {
    try {
      // A state that nobody asked for takes no other file's place, such as that of the run that this one was restored from.
      const std::filesystem::path wanted(settings_.failure_snapshot);
      const std::string path = free_path(std::filesystem::path(wanted).replace_extension().string(), wanted.extension().string());
      simulation_->save(path);
      failure += "; its state is in '" + path + "'";
    } catch (const std::exception& second) {
      log(LogLevel::warning, std::string("no snapshot of the failure: ") + second.what());
    }
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    status_.phase = LoopPhase::failed;
    status_.failure = failure;
    if (simulation_) status_.solver = simulation_->state();
  }
  log(LogLevel::error, failure);
}

Reply SolverLoop::reply_at(bool success, const std::string& message, double time) const {
  return {success, message, time, hooks_.stamp ? hooks_.stamp(time) : 0};
}

void SolverLoop::answer_advance() {
  if (!advancing_) return;
  const SolverState state = simulation_->state();
  if (!lock_step_.is_reached(state)) return;
  advancing_->set_value(reply_at(true, "step " + std::to_string(state.step) + ", time " + seconds_text(state.time), state.time));
  advancing_.reset();
}

void SolverLoop::cut_advance_short(const std::string& why) {
  if (!advancing_) return;
  const double time = simulation_->state().time;
  advancing_->set_value(reply_at(false, "cut short at " + seconds_text(time) + ": " + why, time));
  advancing_.reset();
}

// ---------------------------------------------------------------- requests

void SolverLoop::serve_requests() {
  while (true) {
    Request request;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (requests_.empty()) return;
      request = std::move(requests_.front());
      requests_.pop_front();
    }
    request(*simulation_);
    if (failure_in_request_) std::rethrow_exception(failure_in_request_);
  }
}

void SolverLoop::refuse_requests() {
  const std::lock_guard<std::mutex> lock(mutex_);
  accepts_requests_ = false;
  requests_.clear();  // whose futures then hold a broken promise
  advancing_.reset();
}

Reply SolverLoop::ask(std::function<Reply(Simulation&)> what) {
  std::future<Reply> answer;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (status_.phase == LoopPhase::failed) return {false, "the solver has stopped: " + status_.failure};
    if (!accepts_requests_) return {false, "the solver is not running yet: it is packing the particles"};
    Request request(std::move(what));
    answer = request.get_future();
    requests_.push_back(std::move(request));
  }
  wake_.notify_all();
  try {
    return answer.get();
  } catch (const std::future_error&) {
    return {false, "the solver has stopped"};
  } catch (const std::exception& error) {
    return {false, error.what()};
  }
}

Reply SolverLoop::pause(bool paused) {
  const std::string what = paused ? "paused" : "running on";
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (status_.phase == LoopPhase::starting && !accepts_requests_) {
      status_.paused = paused;
      return {true, what + " from the start"};
    }
  }
  return ask([this, paused, what](Simulation&) -> Reply {
    cut_advance_short(paused ? "the solver was paused" : "the solver was set running");
    const std::lock_guard<std::mutex> lock(mutex_);
    status_.paused = paused;
    return {true, what + " at " + seconds_text(status_.solver.time)};
  });
}

Reply SolverLoop::step() {
  return ask([this](Simulation& simulation) -> Reply {
    if (advancing_) return {false, "an advance is in progress"};
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!status_.paused) return {false, "the solver is running: pause it first"};
      if (status_.solver.time >= case_.duration) return {false, "the run has ended at " + seconds_text(status_.solver.time)};
    }
    try {
      advance();
    } catch (const std::exception& error) {
      failure_in_request_ = std::current_exception();
      return {false, error.what()};
    }
    const SolverState state = simulation.state();
    return {true, "step " + std::to_string(state.step) + ", time " + seconds_text(state.time)};
  });
}

Reply SolverLoop::advance_by(double seconds) {
  std::future<Reply> end;
  bool is_heard = false;  // by the solver's thread, where no reset comes between a time and its stamp
  const Reply begun = ask([this, seconds, &end, &is_heard](Simulation& simulation) -> Reply {
    const SolverState state = simulation.state();
    is_heard = true;
    if (advancing_) return reply_at(false, "an advance is in progress already", state.time);
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!status_.paused) return reply_at(false, "the solver is running: pause it first", state.time);
    }
    try {
      lock_step_.ask(state, seconds, case_.duration);
    } catch (const Error& error) {
      return reply_at(false, error.what(), state.time);
    }
    advancing_ = std::make_shared<std::promise<Reply>>();
    end = advancing_->get_future();
    return {true, ""};
  });
  if (!begun.success) return is_heard ? begun : reply_at(false, begun.message, status().solver.time);
  try {
    return end.get();
  } catch (const std::future_error&) {
    return reply_at(false, "the solver has stopped", status().solver.time);
  }
}

Reply SolverLoop::reset() {
  return ask([this](Simulation& simulation) -> Reply {
    cut_advance_short("the simulation was reset");
    const SolverState last = simulation.state();
    simulation.reset();
    lock_step_ = LockStep();
    hooks_.restarted(last);
    pace_known_ = false;
    pass_on_samples();
    return {true, "back at time 0 from " + seconds_text(last.time)};
  });
}

Reply SolverLoop::save(const std::function<std::string(const SolverState&)>& path) {
  return ask([path](Simulation& simulation) -> Reply {
    const std::string file = path(simulation.state());
    simulation.save(file);
    return {true, file};
  });
}

}  // namespace wavetank
