// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_EXPRESSION_H
#define BILLET_SCENE_EXPRESSION_H

#include "billet/parameters/control.h"

#include <deal.II/base/function_parser.h>
#include <deal.II/base/point.h>

#include <memory>
#include <string>
#include <vector>

namespace billet {

/// Value of an amplitude at time t.
double evaluate_amplitude(const parameters::Amplitude &amplitude, double t);

/// Times, ascending, at which it turns back, begins, comes to rest, or becomes more than twice as fast or
/// slow: where the rates of the straight lines between two pairs of its points, or the rest before and after
/// them, differ by more than half of the greater. A step that goes on past one cuts the corner.
std::vector<double> corners(const parameters::Amplitude &amplitude);

/// A muParser expression of the time t, the amplitudes by their names, pi and, where allowed, the position x,
/// y, z.
class Expression {
public:
  enum class Variables { time, time_and_position };

  /// Throws InputError, beginning with `origin`, if the text does not make sense.
  Expression(const std::string &text, Variables variables, std::vector<parameters::Amplitude> amplitudes,
             const std::string &origin);

  /// Throws SolutionFailure, on the calling rank, if the value is not finite.
  double value(double t, const dealii::Point<3> &position = {}) const;
  /// Whether the value is the same anywhere, as far as the text shows.
  bool is_uniform() const { return is_uniform_; }

private:
  void parse(double t) const;

  std::string text_, origin_;
  std::string variables_;
  std::vector<parameters::Amplitude> amplitudes_;
  bool is_uniform_ = true;
  // The parser takes amplitudes as constants and is made anew when the time changes, if the text has any.
  mutable std::unique_ptr<dealii::FunctionParser<3>> parser_;
  mutable double parsed_time_ = 0.;
  mutable bool uses_amplitudes_ = false;
};

} // namespace billet

#endif
