#include "wavetank/common/expression.h"

#include <muParser.h>

#include <cmath>

#include "wavetank/common/error.h"
#include "wavetank/common/visible_text.h"

namespace wavetank {

const char* Expression::variables(Of of) {
  return of == Of::time ? "t" : of == Of::place ? "x, y and z" : of == Of::plan ? "x and y" : "t, x, y and z";
}

struct Expression::Parser {
  mu::Parser parser;
  double x = 0, y = 0, z = 0, t = 0;
};

Expression::Expression(const std::string& text, Of of) : parser_(std::make_unique<Parser>()) {
  try {
    if (of == Of::time || of == Of::time_and_place) parser_->parser.DefineVar("t", &parser_->t);
    if (of != Of::time) {
      parser_->parser.DefineVar("x", &parser_->x);
      parser_->parser.DefineVar("y", &parser_->y);
      if (of != Of::plan) parser_->parser.DefineVar("z", &parser_->z);
    }
    parser_->parser.DefineConst("pi", std::acos(-1.0));
    parser_->parser.SetExpr(text);
    parser_->parser.Eval();
  } catch (const mu::Parser::exception_type& failure) {
    const int at = failure.GetPos();
    const std::string place =
        at >= 0 && at < static_cast<int>(text.size()) ? "at its character " + std::to_string(at + 1) : std::string("at its end");
    std::string what = failure.GetMsg();
    what = what.substr(0, what.find(" found at position"));  // which counts from 0
    throw Error("\"" + visible_text(text) + "\" is no expression of " + variables(of) + ": " + visible_text(what) + ", " + place);
  }
}

Expression::~Expression() = default;
Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression&&) noexcept = default;

double Expression::at(const Eigen::Vector3d& place) const {
  parser_->x = place.x();
  parser_->y = place.y();
  parser_->z = place.z();
  return parser_->parser.Eval();
}

double Expression::at(double time) const {
  parser_->t = time;
  return parser_->parser.Eval();
}

double Expression::at(double time, const Eigen::Vector3d& place) const {
  parser_->t = time;
  return at(place);
}

bool Expression::depends_on_place() const {
  const auto used = parser_->parser.GetUsedVar();
  return used.count("x") + used.count("y") + used.count("z") > 0;
}

}  // namespace wavetank
