// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/point_location.h"

#include "billet/algebra/gather.h"
#include "billet/discretization/node_keys.h"
#include "billet/errors.h"
#include "billet/mechanics/hexahedron.h"

#include <deal.II/base/geometry_info.h>

#include <algorithm>
#include <array>
#include <limits>
#include <sstream>

namespace billet {

using dealii::Point;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double near = 0.1; // maximum distance from the nearest node [scene's radius]

/// Place of a point in an element of this rank. Of several the one with the least distance, then
/// with the least key, counts.
struct Candidate {
  double distance = infinity;
  LocatedPoint at{0, std::numeric_limits<std::uint64_t>::max(), {}};

  bool is_before(const double other_distance, const std::uint64_t other_key) const {
    return distance < other_distance || (distance == other_distance && at.key < other_key);
  }
};

Candidate find_inside(const std::vector<Element> &elements, const Point<3> &point) {
  Candidate best;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const Hexahedron hexahedron(nodal_positions(elements[e].cell));
    if (const auto coordinates = hexahedron.find(point)) {
      const Candidate found{0., {e, element_key(elements[e].cell), *coordinates}};
      if (found.is_before(best.distance, best.at.key))
        best = found;
    }
  }
  return best;
}

Candidate find_nearest_node(const std::vector<Element> &elements, const Point<3> &point) {
  Candidate best;
  for (std::size_t e = 0; e < elements.size(); ++e)
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      const double distance = elements[e].cell->vertex(a).distance(point);
      if (!(distance <= best.distance))
        continue;
      const Candidate found{distance,
                            {e, element_key(elements[e].cell), dealii::GeometryInfo<3>::unit_cell_vertex(a)}};
      if (found.is_before(best.distance, best.at.key))
        best = found;
    }
  return best;
}

/// Box around the body, and the node that is nearest to a point. Collective.
struct Surroundings {
  std::array<double, 3> low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
  std::array<double, 4> nearest{infinity, 0., 0., 0.}; ///< distance and position
  double distance = infinity;                          ///< from the body

  Surroundings(const Discretization &discretization, const std::size_t body, const Point<3> &point) {
    const MPI_Comm communicator = discretization.communicator();
    for (const Element &element : discretization.elements(body)) {
      distance = std::min(distance, Hexahedron(nodal_positions(element.cell)).distance(point));
      for (unsigned int a = 0; a < n_element_nodes; ++a) {
        const Point<3> &x = element.cell->vertex(a);
        for (unsigned int i = 0; i < 3; ++i) {
          low[i] = std::min(low[i], x[i]);
          high[i] = std::max(high[i], x[i]);
        }
        nearest = std::min(nearest, {x.distance(point), x[0], x[1], x[2]});
      }
    }
    for (unsigned int i = 0; i < 3; ++i) {
      low[i] = dealii::Utilities::MPI::min(low[i], communicator);
      high[i] = dealii::Utilities::MPI::max(high[i], communicator);
    }
    for (const auto &of_rank : all_gather(communicator, nearest))
      nearest = std::min(nearest, of_rank);
    distance = std::min(dealii::Utilities::MPI::min(distance, communicator), nearest[0]);
  }
};

[[noreturn]] void refuse(const Discretization &discretization, const std::size_t body,
                         const PointRequest &request, const Point<3> &point) {
  const Surroundings of_point(discretization, body, point);
  const auto &[low, high, node, distance] = of_point;
  std::ostringstream message;
  message << request.origin << ": the point (" << point << ") is "
          << (request.takes_nearest_nodes ? "far from all nodes of" : "not in") << " the undeformed body '"
          << request.body << "', which reaches from (" << low[0] << " " << low[1] << " " << low[2] << ") to ("
          << high[0] << " " << high[1] << " " << high[2] << "). Its distance is " << distance
          << " from the body, and " << node[0] << " from the nearest node, (" << node[1] << " " << node[2]
          << " " << node[3] << "); allowed "
          << (request.takes_nearest_nodes ? "is a distance of at most a tenth of the scene's radius"
                                          : request.allowed);
  throw InputError(message.str());
}

} // namespace

std::vector<std::optional<LocatedPoint>> locate_points(const Discretization &discretization,
                                                       const std::size_t body, const PointRequest &request) {
  const MPI_Comm communicator = discretization.communicator();
  const auto &elements = discretization.elements(body);
  std::vector<Candidate> own;
  std::vector<double> distances;
  std::vector<std::uint64_t> keys;
  for (const Point<3> &point : request.points) {
    own.push_back(request.takes_nearest_nodes ? find_nearest_node(elements, point)
                                              : find_inside(elements, point));
    distances.push_back(own.back().distance);
    keys.push_back(own.back().at.key);
  }
  const auto all_distances = all_gather(communicator, distances);
  const auto all_keys = all_gather(communicator, keys);
  const double max_distance = request.takes_nearest_nodes ? near * discretization.radius() : 0.;
  std::vector<std::optional<LocatedPoint>> located(request.points.size());
  for (std::size_t p = 0; p < request.points.size(); ++p) {
    std::size_t best = 0;
    for (std::size_t rank = 1; rank < all_keys.size(); ++rank)
      if (std::pair(all_distances[rank][p], all_keys[rank][p]) <
          std::pair(all_distances[best][p], all_keys[best][p]))
        best = rank;
    if (all_distances[best][p] > max_distance)
      refuse(discretization, body, request, request.points[p]);
    if (best == dealii::Utilities::MPI::this_mpi_process(communicator))
      located[p] = own[p].at;
  }
  return located;
}

} // namespace billet
