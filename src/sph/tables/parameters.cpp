#include "parameters.h"

#include <cstring>
#include <utility>

#include "wavetank/common/error.h"

namespace wavetank {
namespace {

using Kind = ParameterRow::Kind;

template <class T>
void append(std::vector<char>& bytes, T value) {
  const char* begin = reinterpret_cast<const char*>(&value);
  bytes.insert(bytes.end(), begin, begin + sizeof value);
}

}  // namespace

std::string parameters_header(const std::vector<ParameterRow>& rows) {
  std::string text;
  for (const Kind kind : {Kind::real, Kind::integer})
    for (const ParameterRow& row : rows)
      if (row.kind == kind)
        text +=
            (kind == Kind::real ? "real " : "int ") + row.name + ";  // " + row.meaning + (row.unit.empty() ? "" : ", " + row.unit) + "\n";
  return text;
}

ParameterBlock::ParameterBlock(std::vector<ParameterRow> rows, const ParameterSource& source) : rows_(std::move(rows)) {
  for (const ParameterRow& row : rows_)
    if (!values_.emplace(row.name, row.value(source)).second) throw Error("two parameters of the kernels are called \"" + row.name + "\"");
}

double ParameterBlock::at(const std::string& name) const {
  const auto found = values_.find(name);
  if (found == values_.end()) throw Error("no parameter of the kernels is called \"" + name + "\"");
  return found->second;
}

void ParameterBlock::set(const std::string& name, double value) {
  at(name);
  values_[name] = value;
}

template <class Real>
std::vector<char> ParameterBlock::bytes() const {
  std::vector<char> bytes;
  for (const ParameterRow& row : rows_)
    if (row.kind == Kind::real) append(bytes, static_cast<Real>(values_.at(row.name)));
  for (const ParameterRow& row : rows_)
    if (row.kind == Kind::integer) append(bytes, static_cast<int>(values_.at(row.name)));
  bytes.resize((bytes.size() + sizeof(Real) - 1) / sizeof(Real) * sizeof(Real));  // as a struct of them is padded
  return bytes;
}

template std::vector<char> ParameterBlock::bytes<float>() const;
template std::vector<char> ParameterBlock::bytes<double>() const;

}  // namespace wavetank
