// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_TOOL_H
#define BILLET_PARAMETERS_TOOL_H

#include "billet/parameters/reader.h"

#include <array>

namespace billet::parameters {

/// Subsection Motion of a tool: it turns about an axis through its centre, then moves.
struct Motion {
  Located<std::array<std::string, 3>> translation; ///< expressions of t and the amplitudes
  Located<std::string> rotation_angle;             ///< expression of t and the amplitudes, radians
  dealii::Tensor<1, 3> rotation_axis;
  dealii::Tensor<1, 3> centre;

  static void declare(dealii::ParameterHandler &prm);
  void parse(Reader &reader);
};

/// One named subsection of Tools.
struct Tool {
  std::string name;
  std::string origin;
  dealii::Tensor<1, 3> plane_point;
  dealii::Tensor<1, 3> plane_normal; ///< unit, out of the tool
  Motion motion;

  static void declare(dealii::ParameterHandler &prm);
  void parse(Reader &reader);
};

/// One named subsection of Contact pairs.
struct ContactPair {
  enum class PenaltyUnit { factor, absolute };

  std::string name;
  std::string origin;
  Located<std::string> body;
  Located<std::vector<unsigned int>> boundary_ids;
  Located<std::string> tool;
  double friction_coefficient;
  PenaltyUnit penalty_unit;
  double normal_penalty;
  double tangential_penalty;
  Located<double> allowed_penetration;

  static void declare(dealii::ParameterHandler &prm);
  void parse(Reader &reader);
};

} // namespace billet::parameters

#endif
