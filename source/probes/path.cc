// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/probes/probe.h"

#include <cmath>

namespace billet {

ProbeType path_type();

namespace {

Probe make_path(const TypeInput &input) {
  constexpr double max_points = 1000.;
  const dealii::Tensor<1, 3> start = input.vector("Start"), end = input.vector("End");
  if (!((end - start).norm() > 0.))
    input.reject("End", "a point other than 'Start'");
  const double n = input.number("Points");
  if (!(n >= 2. && n <= max_points && n == std::floor(n)))
    input.reject("Points", "a whole number from 2 to 1000");
  ProbedPoints points{{}, read_place(input)};
  for (double i = 0.; i < n; ++i)
    points.points.emplace_back((1. - i / (n - 1.)) * start + i / (n - 1.) * end);
  Probe probe{std::move(points)};
  probe.axes = Axes(input);
  probe.quantities = read_quantities(input);
  probe.statistics = read_statistics(input, true);
  probe.names_sites = true;
  return probe;
}

} // namespace

ProbeType path_type() {
  return {"path", "quantities at points at equal distances on a line through a body",
          with_probed_axes({probed_body(),
                            {"Start", "", TypeParameter::Kind::text, "First point 'x, y, z'. [length]"},
                            {"End", "", TypeParameter::Kind::text, "Last point 'x, y, z'. [length]"},
                            {"Points", "11", TypeParameter::Kind::number,
                             "2 to 1000. Number of points, with both ends; columns number them from 1."},
                            probed_place(),
                            probed_quantities(),
                            probed_statistics()}),
          make_path};
}

} // namespace billet
