#pragma once

#include <string>
#include <vector>

#include "wavetank/compute/program.h"

namespace wavetank::compute {

/// The text of files[main] with every `#include "NAME"` replaced by that file's text, once each, and #line directives that keep the
/// compiler's messages in terms of the files' own names and lines. Throws Error for a name that is not among the files.
std::string resolve_includes(const SourceFiles& files, const std::string& main);

/// The resolved text without what files that hold nothing but definitions of one line each, such as tables, define for others: names that
/// the text does not hold elsewhere, nor a beginning of them that ends in _, with which ## may make them; and without those files'
/// comments. A program that knows nothing of a row is then the same with it and without, and a driver compiles it once.
std::string definitions_that_matter(const std::string& resolved);

/// The build options without definitions ("-DNAME=VALUE") of names that the resolved text does not hold: they change nothing, but a driver
/// that keeps what it compiled would compile it anew for each value.
std::string options_that_matter(const std::string& options, const std::string& resolved);

/// One error of a compiler's log, in terms of the kernel sources.
struct CompilerError {
  std::string file;     ///< as in SourceFiles; empty if the message names none of them
  int line = 0;         ///< from 1
  std::string message;  ///< what the compiler says, without the place
};

/// The errors of the log, in its order. `resolved` is the text that was compiled: some drivers overlook #line and count its own lines.
std::vector<CompilerError> compiler_errors(const std::string& log, const SourceFiles& files, const std::string& resolved);

/// One readable text of what the compiler refused: the first errors, each with file, line and the source line itself. A log that is not
/// understood is given as it is, shortened.
std::string explain_build_log(const std::string& log, const SourceFiles& files, const std::string& resolved);

}  // namespace wavetank::compute
