#pragma once

#include <string>
#include <vector>

namespace wavetank {

/// A file of comma-separated values: a header line with the columns' names, then lines of as many values. Lines that are empty or start
/// with # do not count; spaces around names and values and quotes ("") around them are dropped.
class RecordFile {
 public:
  /// `what` opens the messages, `kind` ("motion") says in them what the record is of. Throws Error for a file that cannot be read, has no
  /// header or fewer than two lines of values, or a line of another number of values than the header.
  RecordFile(const std::string& path, const std::string& what, const std::string& kind);

  const std::vector<std::string>& columns() const { return names_; }
  bool has(const std::string& column) const;
  /// Throws Error for a column that is not there or there twice, and for a value that is not a finite number, with its line.
  std::vector<double> numbers(const std::string& column) const;
  /// The same; also throws for times that do not increase.
  std::vector<double> times(const std::string& column) const;
  /// "'time', 'surge' and 'heave'"
  std::string listed_columns() const;

  /// Likewise of a row of values, from 0.
  std::string place_of_row(std::size_t row) const { return place(rows_[row].line); }
  /// Opens a message: what, file and line (0: the whole file).
  std::string place(int line) const;

 private:
  struct Row {
    int line;  ///< in the file, from 1
    std::vector<std::string> values;
  };
  std::size_t index_of(const std::string& column) const;

  std::string path_, what_, kind_;
  int header_line_ = 0;
  std::vector<std::string> names_;
  std::vector<Row> rows_;
};

}  // namespace wavetank
