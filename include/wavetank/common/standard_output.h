#pragma once

namespace wavetank {

/// To be called first thing: writing to a pipe that nobody reads, or beyond the greatest length of a file, fails from then on as on a full
/// disk, instead of ending the process.
void let_writing_fail();

/// What was printed is on its way. Throws Error where standard output did not take all of it. A reader that has gone has seen what it
/// wanted, as head has.
void finish_printing();

}  // namespace wavetank
