// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/element_fields.h"

#include "billet/output/field_quantity.h"
#include "billet/solve/mesh_errors.h"

#include <deal.II/base/geometry_info.h>

#include <algorithm>
#include <cmath>

namespace billet {

namespace {

/// Quantities that are written, in the order of the files.
struct WrittenQuantities {
  explicit WrittenQuantities(const Scene &scene) {
    for (const ElementQuantity &quantity : field_quantities().of_elements())
      if (quantity.is_written(scene))
        of_elements.push_back(quantity);
    for (ElementQuantity &quantity : state_quantities(scene))
      of_elements.push_back(std::move(quantity));
    for (const ElementQuantity &quantity : of_elements) {
      if (quantity.has_layers)
        of_layers.push_back(quantity);
      read_states = read_states || quantity.reads_state;
    }
  }

  std::vector<ElementQuantity> of_elements, of_layers;
  bool read_states = false;
};

/// Averages of the elements of a body.
class BodyAverages {
public:
  BodyAverages(const Solution &solution, const Scene &scene, const std::size_t body,
               const WrittenQuantities &written, const bool has_layers)
      : body_(body), material_(scene.bodies()[body].material), solution_(solution),
        has_sheet_strains_(scene.parameters().output.sheet_strains),
        forming_limit_(scene.parameters().bodies[body].material.forming_limit),
        summaries_(solution.discretization().elements(body).size()) {
    if (!written.of_layers.empty())
      summaries_ = solution.summarize(body);
    if (has_layers && !written.of_layers.empty())
      layers_ = solution.summarize_layers(body);
    if (written.read_states) {
      fields_ = scene.bodies()[body].law->fields();
      states_ = solution.average_states(body);
    }
  }

  std::size_t size() const { return summaries_.size(); }
  ElementAverage operator()(const std::size_t element) const {
    return average(summaries_[element], element, 0);
  }
  /// Returns the average of a layer. With two points all layers have the element's.
  ElementAverage of_layer(const std::size_t element, const std::size_t layer) const {
    return layers_.empty() ? (*this)(element) : average(layers_[element][layer], element, 1 + layer);
  }

private:
  template <class Summary>
  ElementAverage average(const Summary &summary, const std::size_t element, const std::size_t place) const {
    ElementAverage result{body_, summary.cauchy_stress, summary.equivalent_plastic_strain, {}};
    result.material = material_;
    if (solution_.mesh_errors() != nullptr)
      result.mesh_error = solution_.mesh_errors()->of_element(body_, element);
    if (!states_.empty())
      result.state = {fields_, states_[element][place]};
    const Element &brick = solution_.discretization().elements(body_)[element];
    const ElementVectors positions = nodal_positions(brick.cell);
    result.deformation_gradient =
        mean_deformation_gradient(positions, gather(solution_.state().displacements, brick.dofs));
    if (has_sheet_strains_)
      result.sheet = compute_sheet_strains(result.deformation_gradient, find_sheet_normal(positions));
    if (has_sheet_strains_ && forming_limit_ != nullptr)
      result.forming_limit = forming_limit_->major_strain(result.sheet.minor);
    return result;
  }

  std::size_t body_, material_;
  const Solution &solution_;
  bool has_sheet_strains_;
  std::shared_ptr<const FormingLimit> forming_limit_;
  std::vector<ElementSummary> summaries_;
  std::vector<LayerSummaries> layers_;
  std::vector<StateField> fields_;
  std::vector<StateAverages> states_;
};

/// Fields of the quantities, without values.
std::vector<GridField> make_fields(const WrittenQuantities &written, const bool has_layers) {
  std::vector<GridField> fields;
  const auto add = [&](const std::string &layer, const auto &quantities) {
    for (const ElementQuantity &quantity : quantities)
      for (const std::string &component : quantity.components)
        fields.push_back(
            {layer + component, 1, quantity.is_number ? FileNumber::int32 : FileNumber::float32});
  };
  add("", written.of_elements);
  if (has_layers)
    for (const std::string name : layer_names)
      add(name + "_", written.of_layers);
  return fields;
}

} // namespace

std::vector<std::vector<GridField>> collect_element_fields(const Scene &scene, const Solution &solution) {
  const WrittenQuantities written(scene);
  const bool has_layers = std::any_of(scene.bodies().begin(), scene.bodies().end(),
                                      [](const Body &body) { return body.formulation.points_through > 2; }) &&
                          scene.parameters().scheme().has_matrix;
  std::vector<std::vector<GridField>> result;
  for (std::size_t body = 0; body < scene.bodies().size(); ++body) {
    const BodyAverages averages(solution, scene, body, written, has_layers);
    std::vector<GridField> fields = make_fields(written, has_layers);
    for (std::size_t e = 0; e < averages.size(); ++e) {
      std::size_t next = 0;
      const auto add = [&](const ElementAverage &average, const auto &quantities) {
        for (const ElementQuantity &quantity : quantities)
          for (const double value : quantity.evaluate(average))
            fields[next++].values.push_back(value);
      };
      add(averages(e), written.of_elements);
      if (has_layers)
        for (std::size_t layer = 0; layer < layer_names.size(); ++layer)
          add(averages.of_layer(e, layer), written.of_layers);
    }
    result.push_back(join_components(std::move(fields)));
  }
  return result;
}

std::vector<NodalAverage> average_to_nodes(const Discretization &discretization,
                                           const std::vector<std::vector<GridField>> &fields) {
  // Adds up what the elements give to one, two or three entries of their nodes.
  const auto sum = [&](const auto &value, const unsigned int n_entries) {
    Vector sums = discretization.make_additive_vector();
    for (std::size_t body = 0; body < discretization.n_bodies(); ++body) {
      const auto &elements = discretization.elements(body);
      for (std::size_t e = 0; e < elements.size(); ++e) {
        const double volume = elements[e].cell->measure();
        for (unsigned int a = 0; a < n_element_nodes; ++a)
          for (unsigned int c = 0; c < n_entries; ++c)
            sums(elements[e].dofs[std::size_t{3} * a + c]) += volume * value(body, e, c);
      }
    }
    sums.compress(dealii::VectorOperation::add);
    Vector owned = discretization.make_owned_vector();
    owned = sums;
    return owned;
  };
  const Vector volumes = sum([](const std::size_t, const std::size_t, const unsigned int) { return 1.; }, 3);
  std::vector<NodalAverage> averages;
  for (std::size_t f = 0; !fields.empty() && f < fields[0].size(); ++f) {
    const GridField &form = fields[0][f];
    if (form.type != FileNumber::float32)
      continue;
    NodalAverage average{form.name, form.n_components, {}, volumes};
    for (unsigned int first = 0; first < form.n_components; first += 3)
      average.sums.push_back(
          sum([&](const std::size_t body, const std::size_t e,
                  const unsigned int c) { return fields[body][f].values[form.n_components * e + first + c]; },
              std::min(3U, form.n_components - first)));
    averages.push_back(std::move(average));
  }
  return averages;
}

dealii::Tensor<2, 3> jacobian_at(const dealii::Point<3> &coordinates, const ElementVectors &x) {
  dealii::Tensor<2, 3> jacobian;
  for (unsigned int a = 0; a < n_element_nodes; ++a) {
    const auto gradient = dealii::GeometryInfo<3>::d_linear_shape_function_gradient(coordinates, a);
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        jacobian[i][j] += x[3 * a + i] * gradient[j];
  }
  return jacobian;
}

dealii::Tensor<2, 3> mean_deformation_gradient(const ElementVectors &positions,
                                               const ElementVectors &displacements) {
  ElementVectors moved = positions;
  for (unsigned int i = 0; i < n_element_dofs; ++i)
    moved[i] += displacements[i];
  dealii::Tensor<2, 3> sum;
  double volume = 0.;
  for (unsigned int q = 0; q < n_element_nodes; ++q) { // Gauss points, of equal weights
    const auto coordinate = [](const bool is_upper) { return 0.5 + (is_upper ? 0.5 : -0.5) / std::sqrt(3.); };
    const dealii::Point<3> xi(coordinate((q & 1U) != 0), coordinate((q & 2U) != 0),
                              coordinate((q & 4U) != 0));
    const dealii::Tensor<2, 3> before = jacobian_at(xi, positions);
    const double weight = dealii::determinant(before);
    sum += weight * (jacobian_at(xi, moved) * dealii::invert(before));
    volume += weight;
  }
  return sum / volume;
}

std::vector<double> list_components(const dealii::SymmetricTensor<2, 3> &tensor) {
  return {tensor[0][0], tensor[1][1], tensor[2][2], tensor[0][1], tensor[0][2], tensor[1][2]};
}

std::vector<double> list_stress(const dealii::SymmetricTensor<2, 3> &stress,
                                const dealii::SymmetricTensor<2, 3> &in_axes) {
  std::vector<double> values = list_components(in_axes);
  values.push_back(std::sqrt(1.5) * dealii::deviator(stress).norm());
  values.push_back(-dealii::trace(stress) / 3.);
  return values;
}

dealii::SymmetricTensor<2, 3> logarithmic_strain(const dealii::Tensor<2, 3> &F) {
  const auto pairs = dealii::eigenvectors(dealii::symmetrize(F * dealii::transpose(F)),
                                          dealii::SymmetricTensorEigenvectorMethod::jacobi);
  dealii::SymmetricTensor<2, 3> strain;
  for (const auto &[square, direction] : pairs) {
    if (!(square > 0.) || !std::isfinite(square))
      return {};
    strain += 0.5 * std::log(square) * dealii::symmetrize(dealii::outer_product(direction, direction));
  }
  return strain;
}

} // namespace billet
