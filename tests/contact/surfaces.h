// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_SURFACES_H
#define BILLET_TESTS_SURFACES_H

#include "billet/contact/facet_choice.h"

#include "../testing.h"

#include <functional>
#include <map>

namespace billet::testing {

using Positions = FacetSearch::Positions;

/// Facets and where their nodes are.
struct Surface {
  std::vector<SurfaceFacet> facets;
  Positions positions;

  std::vector<SlaveNode> slaves() const {
    std::vector<SlaveNode> result(positions.size());
    for (const auto &facet : facets)
      for (const unsigned int node : facet.nodes)
        result[node] = {node, facet.surface};
    return result;
  }
};

/// Adds n × m facets, the image of the unit square under `map`: outward is map,s × map,t.
inline void add_sheet(Surface &surface, const unsigned int n, const unsigned int m, const unsigned int label,
                      const double reach,
                      const std::function<dealii::Tensor<1, 3>(double s, double t)> &map) {
  const auto first = static_cast<unsigned int>(surface.positions.size());
  for (unsigned int j = 0; j <= m; ++j)
    for (unsigned int i = 0; i <= n; ++i)
      surface.positions.push_back(map(i / static_cast<double>(n), j / static_cast<double>(m)));
  for (unsigned int j = 0; j < m; ++j)
    for (unsigned int i = 0; i < n; ++i) {
      const unsigned int corner = first + i + j * (n + 1);
      surface.facets.push_back(
          {{corner, corner + 1, corner + n + 1, corner + n + 2}, label, surface.facets.size(), reach});
    }
}

/// Most of a sphere, with folds; outward is out of it, or into it.
inline void add_ball(Surface &surface, const unsigned int n, const unsigned int label, const double reach,
                     const dealii::Tensor<1, 3> &centre, const double radius) {
  add_sheet(surface, n, n, label, reach, [&](const double s, const double t) {
    const double around = 1.9 * M_PI * s, up = 0.8 * M_PI * (t - 0.5);
    const double r = radius * (1. + 0.05 * std::sin(9. * around) * std::sin(7. * up));
    return centre + r * dealii::Tensor<1, 3>(
                            {std::cos(around) * std::cos(up), std::sin(around) * std::cos(up), std::sin(up)});
  });
}

/// A long strip, bent into a U so far that its flanks have come through each other by `depth`.
inline Surface make_strip(const double depth) {
  Surface surface;
  add_sheet(surface, 30, 4, 0, 0.03, [&](const double s, const double t) {
    const double along = 3. * s - 1.5;
    if (along < -0.5)
      return dealii::Tensor<1, 3>({-along - 0.5, t, 0.});
    if (along > 0.5)
      return dealii::Tensor<1, 3>({along - 0.5, t, depth});
    const double angle = M_PI * (along + 0.5);
    return dealii::Tensor<1, 3>(
        {-0.3 * std::sin(angle), t, depth * (along + 0.5) - 0.02 * std::sin(2. * angle)});
  });
  return surface;
}

/// The part of a surface that one rank has.
struct Part {
  std::vector<unsigned int> nodes; ///< of the whole surface
  std::vector<std::uint64_t> node_keys;
  std::vector<SurfaceFacet> facets;

  template <class IsMine> Part(const Surface &whole, const IsMine &is_mine) {
    std::map<unsigned int, unsigned int> index;
    for (std::size_t f = 0; f < whole.facets.size(); ++f) {
      if (!is_mine(f))
        continue;
      SurfaceFacet facet = whole.facets[f];
      for (unsigned int &node : facet.nodes) {
        const auto found = index.emplace(node, static_cast<unsigned int>(nodes.size()));
        if (found.second) {
          nodes.push_back(node);
          node_keys.push_back(key_of(node));
        }
        node = found.first->second;
      }
      facets.push_back(facet);
    }
  }

  static std::uint64_t key_of(const unsigned int node) { return (std::uint64_t{1} << 40) + 7 * node; }

  Positions take(const Positions &whole) const {
    Positions result;
    for (const unsigned int node : nodes)
      result.push_back(whole[node]);
    return result;
  }
};

/// Each surface turns and drifts as a whole, waves, and its nodes tremble.
class RandomMotion {
public:
  RandomMotion(Random &random, const unsigned int n_surfaces, const double speed)
      : random_(random), speed_(speed) {
    for (unsigned int i = 0; i < n_surfaces; ++i) {
      Rates rates;
      for (unsigned int c = 0; c < 3; ++c) {
        rates.drift[c] = speed * random(-1., 1.);
        rates.spin[c] = speed * random(-1., 1.);
        rates.wave[c] = random(-4., 4.);
      }
      rates_.push_back(rates);
    }
  }

  /// `common` is added to all velocities.
  void advance(const Surface &surface, const std::vector<SlaveNode> &nodes, Positions &positions,
               const dealii::Tensor<1, 3> &common) {
    for (const auto &slave : nodes) {
      const Rates &rates = rates_[slave.surface];
      auto &x = positions[slave.node];
      const auto &reference = surface.positions[slave.node];
      dealii::Tensor<1, 3> tremble;
      for (unsigned int c = 0; c < 3; ++c)
        tremble[c] = 0.2 * speed_ * random_(-1., 1.);
      x += common + rates.drift + dealii::cross_product_3d(rates.spin, reference) +
           std::sin(rates.wave * reference + time_) * rates.drift + tremble;
    }
    time_ += 0.1;
  }

private:
  struct Rates {
    dealii::Tensor<1, 3> drift, spin, wave;
  };
  Random &random_;
  double speed_, time_ = 0.;
  std::vector<Rates> rates_;
};

/// Makes lists if they are outdated, as contact on one rank does.
inline void update(FacetSearch &search, const FacetSearch::Positions &positions_n,
                   const FacetSearch::Positions &positions) {
  if (search.is_outdated(positions, [](const BoundingBox &motion) { return motion; }))
    search.rebuild(positions_n, positions);
}

} // namespace billet::testing

#endif
