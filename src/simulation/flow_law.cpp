#include "flow_law.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "texts.h"
#include "wavetank/common/error.h"
#include "wavetank/common/expression.h"
#include "wavetank/common/record_file.h"
#include "wavetank/scene/file_path.h"
#include "wavetank/scene/upward.h"

namespace wavetank {
namespace {

const char* word_of(FlowQuantity quantity) {
  return quantity == FlowQuantity::discharge ? "discharge" : quantity == FlowQuantity::velocity ? "velocity" : "head";
}

/// In straight lines between the points; held at the ends.
std::function<double(double)> lines_through(std::vector<double> times, std::vector<double> values) {
  return [times = std::move(times), values = std::move(values)](double time) {
    const auto after = std::upper_bound(times.begin(), times.end(), time);
    if (after == times.begin()) return values.front();
    if (after == times.end()) return values.back();
    const auto k = static_cast<std::size_t>(after - times.begin());
    const double share = (time - times[k - 1]) / (times[k] - times[k - 1]);
    return values[k - 1] + share * (values[k] - values[k - 1]);
  };
}

std::function<double(double)> recorded(const FlowRecordCase& record, const std::string& what, const std::string& case_directory,
                                       const ResourceResolver& resolve, double& greatest) {
  std::string path;
  try {
    path = file_path("flow record", record.file, case_directory, resolve);
    check_file("flow record", path);
  } catch (const Error& error) {
    throw Error(what + ": " + error.what());
  }
  const RecordFile file(path, what, "flow");
  std::vector<double> times = file.times(record.time_column);
  std::vector<double> values = file.numbers(record.column.empty() ? word_of(record.quantity) : record.column);
  for (double& time : times) time += record.delay;
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] *= record.factor;
    if (values[k] < 0 && record.quantity != FlowQuantity::head)
      throw Error(file.place_of_row(k) + ": the " + word_of(record.quantity) + " is " + number(values[k]) + "; it must be at least 0");
  }
  greatest = *std::max_element(values.begin(), values.end());
  return lines_through(std::move(times), std::move(values));
}

}  // namespace

FlowLaw::FlowLaw(const OpeningCase& opening, const std::string& case_directory, const ResourceResolver& resolve) : name_(opening.name) {
  if (opening.record) {
    quantity_ = opening.record->quantity;
    greatest_recorded_.emplace();
    value_ = recorded(*opening.record, "opening '" + name_ + "'", case_directory, resolve, *greatest_recorded_);
    return;
  }
  const auto take = [&](const std::string& text, FlowQuantity quantity) {
    if (text.empty()) return;
    quantity_ = quantity;
    const auto expression = std::make_shared<Expression>(text, Expression::Of::time);
    value_ = [expression](double time) { return expression->at(time); };
  };
  take(opening.discharge, FlowQuantity::discharge);
  if (!opening.velocity.empty() && Expression(opening.velocity, Expression::Of::time_and_place).depends_on_place()) {
    quantity_ = FlowQuantity::velocity;
    by_place_ = std::make_shared<Expression>(opening.velocity, Expression::Of::time_and_place);
  } else {
    take(opening.velocity, FlowQuantity::velocity);
  }
  take(opening.head, FlowQuantity::head);
}

double FlowLaw::checked(double value, double time) const {
  if (!std::isfinite(value) || (value < 0 && quantity_ != FlowQuantity::head))
    throw Error("opening '" + name_ + "': its " + word_of(*quantity_) + " at t = " + number(time) + " s is " + number(value) +
                "; it must be finite" + (quantity_ == FlowQuantity::head ? "" : " and at least 0"));
  return value;
}

double FlowLaw::at(double time) const { return checked(value_(time), time); }

double FlowLaw::at(double time, const Vector3d& place) const { return checked(by_place_->at(time, place), time); }

std::vector<bool> carrying(const OpeningCase& given, const Opening& opening) {
  std::vector<bool> wet;
  for (const Opening::Column& column : opening.columns) wet.push_back(given.kind == OpeningKind::inlet ? column.wet : true);
  return wet;
}

std::vector<double> shape_of_profile(const OpeningCase& given, const Opening& opening) {
  std::vector<double> shape(opening.columns.size(), 1.0);
  if (given.profile == "uniform") return shape;
  if (given.profile == "parabolic") {
    if (opening.shape == Opening::Shape::polygon)
      throw Error("opening '" + opening.name + "' has the profile parabolic, which is for rectangles and discs; give an expression");
    for (std::size_t c = 0; c < shape.size(); ++c) {
      const Vector3d way = opening.columns[c].place - opening.centre;
      const double up = 2 * way.dot(opening.up) / opening.height;
      const double across = opening.width > 0 ? 2 * way.dot(opening.across) / opening.width : 0.0;
      const bool disc = opening.shape == Opening::Shape::disc;
      shape[c] = std::max(disc ? 1 - up * up - across * across : (1 - up * up) * (1 - across * across), 0.0);
    }
    return shape;
  }
  const Expression expression(given.profile);
  const std::vector<bool> wet = carrying(given, opening);
  for (std::size_t c = 0; c < shape.size(); ++c) {
    if (!wet[c]) {
      shape[c] = 0;
      continue;
    }
    const Vector3d& place = opening.columns[c].place;
    shape[c] = expression.at(place);
    if (!std::isfinite(shape[c]) || shape[c] < 0)
      throw Error("opening '" + opening.name + "': its profile at (" + number(place.x()) + ", " + number(place.y()) + ", " +
                  number(place.z()) + ") m is " + number(shape[c]) + "; it must be finite and at least 0");
  }
  if (*std::max_element(shape.begin(), shape.end()) <= 0)
    throw Error("opening '" + opening.name + "': its profile is 0 wherever water passes");
  return shape;
}

std::vector<double> profile_of(const Opening& opening, std::vector<double> shape, const std::vector<bool>& wet) {
  double area = 0, flow = 0;
  for (std::size_t c = 0; c < shape.size(); ++c) {
    if (!wet[c]) shape[c] = 0;
    if (!wet[c]) continue;
    area += opening.columns[c].area;
    flow += shape[c] * opening.columns[c].area;
  }
  if (flow > 0)
    for (double& value : shape) value *= area / flow;
  return shape;
}

double FlowLaw::greatest(double duration, const Opening& opening, const std::vector<bool>& wet) const {
  if (greatest_recorded_) return *greatest_recorded_;
  constexpr int looks = 1000;
  double greatest = -std::numeric_limits<double>::infinity();
  for (int k = 0; k <= looks; ++k) {
    const double time = duration * k / looks;
    if (by_place_ == nullptr) {
      greatest = std::max(greatest, at(time));
    } else {
      for (std::size_t c = 0; c < wet.size(); ++c)
        if (wet[c]) greatest = std::max(greatest, at(time, opening.columns[c].place));
    }
  }
  return greatest;
}

double fastest_by_head(const OpeningCase& given, const Opening& opening, const FlowLaw& law, const Case& scene) {
  if (given.kind != OpeningKind::pressure || law.quantity() != FlowQuantity::head) return 0;
  const Top top = top_of(scene);
  double lowest = std::numeric_limits<double>::infinity();
  for (const Opening::Column& column : opening.columns) lowest = std::min(lowest, top.way * column.place[top.axis]);
  const double head = top.way > 0 ? law.greatest(scene.duration, opening, carrying(given, opening)) : -law.at(0);
  return std::sqrt(2 * std::abs(scene.gravity[top.axis]) * std::max(head - lowest, 0.0));
}

namespace {

double area_of(const Opening& opening, const std::vector<bool>& wet) {
  double area = 0;
  for (std::size_t c = 0; c < wet.size(); ++c)
    if (wet[c]) area += opening.columns[c].area;
  return area;
}

/// Of the fastest column over the mean.
double peak_of(const OpeningCase& given, const Opening& opening, const std::vector<bool>& wet) {
  const std::vector<double> profile = profile_of(opening, shape_of_profile(given, opening), wet);
  return *std::max_element(profile.begin(), profile.end());
}

}  // namespace

double fastest_of_discharge(const OpeningCase& given, const Opening& opening, double discharge) {
  const std::vector<bool> wet = carrying(given, opening);
  const double area = area_of(opening, wet);
  return area > 0 ? peak_of(given, opening, wet) * discharge / area : 0.0;
}

double greatest_discharge(const OpeningCase& given, const Opening& opening, const FlowLaw& law, double duration) {
  if (given.command) return given.command->greatest_discharge.value_or(0);
  if (law.quantity() != FlowQuantity::discharge) return 0;
  return law.greatest(duration, opening, carrying(given, opening));
}

double fastest_flow(const OpeningCase& given, const Opening& opening, const FlowLaw& law, double duration) {
  if (law.quantity() != FlowQuantity::velocity)
    return fastest_of_discharge(given, opening, greatest_discharge(given, opening, law, duration));
  const std::vector<bool> wet = carrying(given, opening);
  return area_of(opening, wet) > 0 ? peak_of(given, opening, wet) * law.greatest(duration, opening, wet) : 0.0;
}

}  // namespace wavetank
