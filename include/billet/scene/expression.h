// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_EXPRESSION_H
#define BILLET_SCENE_EXPRESSION_H

#include "billet/parameters/expression_check.h"

#include <deal.II/base/function_parser.h>
#include <deal.II/base/point.h>

#include <memory>
#include <string>
#include <vector>

namespace billet {

/// Returns the value of an amplitude at time t.
double evaluate_amplitude(const parameters::Amplitude &amplitude, double t);

/// Returns the times, ascending, at which the amplitude reverses, starts, stops, or changes its
/// rate by a factor of more than two. There the rates of adjacent segments differ by more than half
/// of the greater; before and after all points the rate is 0. A step across such a time would miss
/// the corner.
std::vector<double> corners(const parameters::Amplitude &amplitude);

/// muParser expression of the time t, the amplitudes by their names, pi and, where allowed, the
/// position x, y, z.
class Expression {
public:
  using Variables = ExpressionVariables;

  /// Parses the text. Throws InputError, beginning with `origin`, if the text is invalid.
  Expression(const std::string &text, Variables variables, std::vector<parameters::Amplitude> amplitudes,
             const std::string &origin);

  /// Returns the value. Throws SolutionFailure, on the calling rank, if it is not finite.
  double value(double t, const dealii::Point<3> &position = {}) const;
  /// Whether the value does not depend on the position, as far as the text shows.
  bool is_uniform() const { return is_uniform_; }

private:
  void parse(double t) const;

  std::string text_, origin_;
  std::string variables_;
  std::vector<parameters::Amplitude> amplitudes_;
  bool is_uniform_ = true;
  // The parser treats amplitudes as constants. If the text has any, it is rebuilt when the time
  // changes.
  mutable std::unique_ptr<dealii::FunctionParser<3>> parser_;
  mutable double parsed_time_ = 0.;
  mutable bool uses_amplitudes_ = false;
};

} // namespace billet

#endif
