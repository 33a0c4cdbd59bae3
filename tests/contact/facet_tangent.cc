// SPDX-License-Identifier: LGPL-2.1-or-later
// The tangent of contact between surfaces against central differences of its forces: for each kind of facet,
// with nodes that stick, slip, press without friction, enter, and are shared by facets.
#include "billet/contact/facet_contact.h"
#include "billet/friction/coulomb.h"
#include "billet/friction/static_kinetic.h"

#include "surfaces.h"

#include "../geometry/facet_samples.h"

#include <deal.II/base/mpi.h>

namespace facet_tangent_test {

using namespace billet;
using namespace billet::testing;
using dealii::Tensor;

namespace {

constexpr ContactStiffness penalty{1e3, 5e2};

/// Two waved balls pressed into each other, and moved step by step.
struct Balls {
  /// `bulge`: of every facet, at most.
  Balls(const FacetMethod method, const FrictionPointer &friction, const double bulge)
      : part((make(bulge), surface), [](const std::size_t) { return true; }), x(part.take(surface.positions)),
        x_n(x) {
    FacetContactSettings settings;
    settings.method = method;
    settings.friction = friction;
    settings.search_margin = 0.1;
    contact = std::make_unique<FacetContact>(MPI_COMM_SELF, settings, part.node_keys, part.facets,
                                             std::vector<ContactStiffness>(x.size(), penalty),
                                             std::vector<double>(x.size(), 0.1));
  }

  Positions forces_at(const Positions &positions) const {
    Positions forces(positions.size());
    contact->add_forces(x_n, positions, 1., forces);
    return forces;
  }
  /// −∂F/∂x v
  Positions product(const ContactTangent kind, const Positions &v) const {
    Positions result(v.size());
    contact->tangents().visit(
        kind, [&](const std::vector<unsigned int> &nodes, const dealii::FullMatrix<double> &K) {
          for (std::size_t a = 0; a < nodes.size(); ++a)
            for (std::size_t b = 0; b < nodes.size(); ++b)
              for (unsigned int i = 0; i < 3; ++i)
                for (unsigned int j = 0; j < 3; ++j)
                  result[nodes[a]][i] += K(3 * a + i, 3 * b + j) * v[nodes[b]][j];
        });
    return result;
  }

  Surface surface;
  Part part;
  Positions x, x_n;
  std::unique_ptr<FacetContact> contact;

private:
  void make(const double bulge) {
    add_ball(surface, 15, 0, 0.2, Tensor<1, 3>(), 1.);
    add_ball(surface, 12, 1, 0.2, Tensor<1, 3>({1.25, 0.4, 0.2}), 0.5);
    Random random;
    if (bulge > 0.)
      for (auto &facet : surface.facets)
        for (double &height : facet.bulge)
          height = random(-bulge, bulge);
  }
};

double norm(const Positions &v) {
  double square = 0.;
  for (const auto &of_node : v)
    square += of_node.norm_square();
  return std::sqrt(square);
}

double dot(const Positions &v, const Positions &w) {
  double sum = 0.;
  for (std::size_t i = 0; i < v.size(); ++i)
    sum += v[i] * w[i];
  return sum;
}

void check_tangents(const FacetMethod method, const FrictionPointer &law, const std::string &name,
                    const double bulge = 0.) {
  const bool has_friction = law != nullptr;
  Random random;
  Balls balls(method, law, bulge);
  RandomMotion motion(random, 2, 4e-3);
  Positions whole = balls.surface.positions;
  WorstError exact, numerical, symmetric;
  std::array<double, 3> n_status{};
  const unsigned int n_steps = method == FacetMethod::overlap ? 4 : 9; // overlaps take twenty times as long
  for (unsigned int step = 0; step < n_steps; ++step) {
    motion.advance(balls.surface, balls.surface.slaves(), whole, Tensor<1, 3>());
    balls.x = balls.part.take(whole);
    balls.forces_at(balls.x);
    for (const auto &node : balls.contact->measures().report())
      n_status[static_cast<unsigned int>(node.status)] += 1.;
    Positions v(balls.x.size()), w(v);
    for (std::size_t i = 0; i < v.size(); ++i) {
      v[i] = random_vector(random, 1.);
      w[i] = random_vector(random, 1.);
    }
    const Positions by_exact = balls.product(ContactTangent::exact, v),
                    by_numerical = balls.product(ContactTangent::numerical, v);
    if (!has_friction)
      symmetric.add(std::abs(dot(w, balls.product(ContactTangent::consistent, v)) -
                             dot(v, balls.product(ContactTangent::consistent, w))) /
                    (norm(by_exact) * norm(w)));
    // Fourth order; a node that changes facet within so little is unlikely.
    Positions difference(v.size());
    const double h = 5e-8;
    for (const auto &[offset, weight] :
         {std::pair<double, double>{1., 8.}, {-1., -8.}, {2., -1.}, {-2., 1.}}) {
      Positions moved(balls.x);
      for (std::size_t i = 0; i < v.size(); ++i)
        moved[i] += offset * h * v[i];
      const Positions forces = balls.forces_at(moved);
      for (std::size_t i = 0; i < v.size(); ++i)
        difference[i] -= weight / (12. * h) * forces[i];
    }
    const double whole_size = norm(difference);
    Positions wrong(difference), wrong_numerical(difference);
    for (std::size_t i = 0; i < v.size(); ++i) {
      wrong[i] -= by_exact[i];
      wrong_numerical[i] -= by_numerical[i];
    }
    exact.add(norm(wrong) / whole_size);
    numerical.add(norm(wrong_numerical) / whole_size);
    balls.forces_at(balls.x);
    balls.contact->commit();
    balls.x_n = balls.x;
  }
  check(name + ": exact tangent", exact.value(), 1e-6);
  check(name + ": numerical tangent", numerical.value(), 1e-6);
  if (!has_friction)
    check(name + ": consistent tangent is symmetric", symmetric.value(), 1e-13);
  check(name + ": contact is as meant", n_status[2] > 30. && (!has_friction || n_status[1] > 30.));
}

} // namespace

BILLET_MPI_TEST(facet_tangent) {
  const std::vector<std::pair<FacetMethod, std::string>> methods{{FacetMethod::planed, "planed"},
                                                                 {FacetMethod::mean_gap, "mean gap"},
                                                                 {FacetMethod::bilinear, "bilinear"},
                                                                 {FacetMethod::overlap, "overlap"}};
  for (const auto &[method, name] : methods) {
    check_tangents(method, nullptr, name + ", no friction");
    check_tangents(method, make_coulomb(0.3), name + ", friction");
    check_tangents(method, std::make_shared<const StaticKinetic>(0.4, 0.2, 20.),
                   name + ", static-kinetic friction");
    if (method != FacetMethod::mean_gap)
      check_tangents(method, make_coulomb(0.3), name + ", friction on curved facets", 2e-3);
  }
}

} // namespace facet_tangent_test
