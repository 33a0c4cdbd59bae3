// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/expression.h"

#include "billet/errors.h"
#include "billet/without_traps.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <sstream>

namespace billet {

double evaluate_amplitude(const parameters::Amplitude &amplitude, const double t) {
  const auto &times = amplitude.times;
  const auto &values = amplitude.values;
  if (t <= times.front())
    return values.front();
  if (t >= times.back())
    return values.back();
  const auto i = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), t) - times.begin());
  const double s = (t - times[i - 1]) / (times[i] - times[i - 1]);
  const double weight = amplitude.interpolation == parameters::Amplitude::Interpolation::linear
                            ? s
                            : s * s * s * (10. + s * (-15. + 6. * s));
  return values[i - 1] + weight * (values[i] - values[i - 1]);
}

std::vector<double> corners(const parameters::Amplitude &amplitude) {
  const std::vector<double> &t = amplitude.times, &values = amplitude.values;
  // Relative to the greater of two rates, and to the range of values.
  constexpr double notable = 0.5, rounding = 1e-9;
  const auto [minimum, greatest] = std::minmax_element(values.begin(), values.end());
  const double range = *greatest - *minimum;
  std::vector<double> found;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double length = std::max(i > 0 ? t[i] - t[i - 1] : 0., i + 1 < t.size() ? t[i + 1] - t[i] : 0.);
    const double before = i > 0 ? (values[i] - values[i - 1]) / (t[i] - t[i - 1]) : 0.,
                 after = i + 1 < t.size() ? (values[i + 1] - values[i]) / (t[i + 1] - t[i]) : 0.;
    const double change = std::abs(after - before);
    if (change > notable * std::max(std::abs(before), std::abs(after)) && change * length > rounding * range)
      found.push_back(t[i]);
  }
  return found;
}

namespace {

/// Whether the text contains one of the names x, y, z.
bool has_position(const std::string &text) {
  const auto is_of_name = [](const char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
  };
  std::string name;
  for (const char c : text + " ") {
    if (is_of_name(c)) {
      name += c;
      continue;
    }
    if (name == "x" || name == "y" || name == "z")
      return true;
    name.clear();
  }
  return false;
}

} // namespace

Expression::Expression(const std::string &text, const Variables variables,
                       std::vector<parameters::Amplitude> amplitudes, const std::string &origin)
    : text_(text), origin_(origin), variables_(parser_variables(variables)),
      amplitudes_(std::move(amplitudes)), is_uniform_(!has_position(text)) {
  check_expression(text, variables, amplitudes_, origin);
  parse(0.);
}

void Expression::parse(const double t) const {
  std::map<std::string, double> constants{{"pi", dealii::numbers::PI}};
  uses_amplitudes_ = false;
  for (const auto &amplitude : amplitudes_) {
    constants[amplitude.name] = evaluate_amplitude(amplitude, t);
    // A name may match as part of another one; then the text is parsed more often than necessary.
    uses_amplitudes_ |= text_.find(amplitude.name) != std::string::npos;
  }
  parser_ = std::make_unique<dealii::FunctionParser<3>>(1);
  parser_->initialize(variables_, text_, constants, true);
  parser_->set_time(t);
  parsed_time_ = t;
}

double Expression::value(const double t, const dealii::Point<3> &position) const {
  if (t != parsed_time_) {
    if (uses_amplitudes_)
      parse(t);
    else
      parser_->set_time(t);
    parsed_time_ = t;
  }
  const double value = [&] {
    const WithoutTraps quiet;
    return parser_->value(position);
  }();
  if (!std::isfinite(value)) {
    std::ostringstream message;
    message << origin_ << ": '" << text_ << "' is " << value << " at time " << t
            << "; allowed are finite values";
    throw SolutionFailure(message.str());
  }
  return value;
}

} // namespace billet
