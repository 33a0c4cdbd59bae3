// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/scene.h"

#include "billet/errors.h"
#include "billet/material/state_fields.h"
#include "billet/parameters/material_texts.h"
#include "billet/parameters/number_text.h"
#include "billet/parameters/reader.h"
#include "billet/scene/boundary_names.h"
#include "billet/scene/mesh_refinements.h"
#include "billet/scene/turning_supports.h"
#include "billet/usage.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <set>
#include <sstream>
#include <stdexcept>

namespace billet {

namespace {

/// `method`: none if the choice is automatic.
std::string describe_solver(const std::optional<LinearMethod> &method, const bool unsymmetric) {
  if (method)
    return describe(*method);
  return describe(default_direct_method(!unsymmetric)) + ", above " +
         std::to_string(parameters::Solver::max_direct_dofs) + " unknowns " +
         describe(default_iterative_method(!unsymmetric));
}

/// Whether the solver that the scene names is for symmetric matrices only.
bool wants_symmetry(const parameters::Solver &solver) {
  return solver.linear_solver.value && requires_symmetry(*solver.linear_solver.value);
}

/// Refuses the linear solver of the scene, which is for symmetric matrices. `reason` follows "but
/// "; `otherwise` is what else would help, such as ", or ...".
[[noreturn]] void refuse_symmetric_solver(const parameters::Solver &solver, const std::string &reason,
                                          const std::string &otherwise = "") {
  throw InputError(solver.linear_solver.origin + " is '" +
                   parameters::name_in(parameters::linear_methods(), solver.linear_solver.value) + "', but " +
                   reason + "; allowed are " + parameters::methods_for_unsymmetric() + otherwise);
}

struct ControlWords {
  std::string name;     ///< in records for programs
  std::string addition; ///< to the description of a tool
};

ControlWords describe_control(const Tool::Control control) {
  switch (control) {
  case Tool::Control::motion:
    return {"motion", ""};
  case Tool::Control::force:
    return {"force", ", with a force"};
  case Tool::Control::moment:
    return {"moment", ", with a moment"};
  case Tool::Control::stop:
    return {"stop at a force", ", stops at a force"};
  }
  throw std::logic_error("a tool's control has no description");
}

AppliedLoad make_load(const parameters::Load &parameters,
                      const std::vector<parameters::Amplitude> &amplitudes, const double fade_time) {
  const LoadTimes times{parameters.from, parameters.until, parameters.fade_time.value_or(fade_time)};
  AppliedLoad applied{parameters.type,   parameters.load, parameters.boundary_ids.value, {}, times,
                      parameters.origin, parameters.name};
  for (std::size_t i = 0; i < applied.load.expressions.size(); ++i) {
    const LoadExpression &expression = applied.load.expressions[i];
    applied.expressions.emplace_back(expression.text,
                                     expression.uses_position ? Expression::Variables::time_and_position
                                                              : Expression::Variables::time,
                                     amplitudes, parameters.origins[i]);
  }
  return applied;
}

std::string name_of_support(const parameters::Support &support) { return "support " + support.name; }

/// `fade_time`: of loads and supports that leave it open.
Body make_body(const parameters::Body &parameters, const std::vector<parameters::Amplitude> &amplitudes,
               const double fade_time) {
  Body body;
  body.name = parameters.name;
  body.law = parameters.material.law;
  body.formulation = make_formulation(parameters);
  const ElasticModuli &moduli = body.law->elastic();
  body.young_modulus = parameters.material.elasticity != nullptr
                           ? parameters.material.elasticity->young_modulus()
                           : 9. * moduli.bulk * moduli.shear / (3. * moduli.bulk + moduli.shear);
  body.max_modulus = moduli.bulk + 4. / 3. * moduli.shear;
  body.density = parameters.material.density.value;
  if (body.law->depends_on_temperature())
    body.temperature =
        std::make_unique<Expression>(parameters.material.temperature.value, Expression::Variables::time,
                                     amplitudes, parameters.material.temperature.origin);
  for (const auto &component : parameters.initial_velocity.value)
    body.initial_velocity.emplace_back(component, Expression::Variables::time_and_position, amplitudes,
                                       parameters.initial_velocity.origin);
  for (const auto &component : parameters.element.value.thickness_direction)
    body.thickness_direction.emplace_back(component, Expression::Variables::time_and_position,
                                          std::vector<parameters::Amplitude>(),
                                          parameters.element.value.direction_origin);
  for (const auto &load : parameters.loads)
    body.loads.push_back(make_load(load, amplitudes, fade_time));
  for (const auto &plane : parameters.symmetry_planes.value) {
    Constraint constraint;
    constraint.name = "symmetry plane " + plane.text;
    constraint.on_plane = true;
    constraint.is_of_section = plane.is_of_section;
    constraint.normal = plane.normal;
    constraint.offset = plane.offset;
    body.constraints.push_back(constraint);
  }
  for (const auto &support : parameters.supports) {
    const std::array<std::string, 3> displacement = directed_displacement(support);
    for (unsigned int i = 0; i < 3; ++i)
      if (support.components[i]) {
        Constraint constraint;
        constraint.name = name_of_support(support);
        constraint.origin = support.displacement.origin;
        constraint.boundary_ids = support.boundary_ids.value;
        constraint.normal[i] = 1.;
        constraint.component = i;
        constraint.times = {support.from, support.until, support.fade_time.value_or(fade_time)};
        if (!support.axes.are_global())
          constraint.axes = std::make_shared<const Axes>(support.axes);
        body.expressions.push_back(std::make_unique<Expression>(displacement[i],
                                                                Expression::Variables::time_and_position,
                                                                amplitudes, support.displacement.origin));
        if (!parameters::is_zero(displacement[i]))
          constraint.value = body.expressions.back().get();
        body.constraints.push_back(constraint);
      }
  }
  return body;
}

std::string describe_facets(const FacetMethod method) {
  return method == FacetMethod::overlap
             ? "overlapping"
             : parameters::name_in(parameters::facet_methods(), std::optional(method));
}

std::string describe_friction(const FrictionPointer &friction) {
  return friction != nullptr ? friction->description() : "mu = 0";
}

/// Refuses names of state fields that the laws of all bodies lack.
void check_state_fields(const Located<std::vector<std::string>> &wanted, const std::vector<Body> &bodies) {
  std::set<std::string> known;
  for (const Body &body : bodies)
    for (const StateField &field : stored_fields(*body.law))
      known.insert(field.name);
  std::string allowed;
  for (const std::string &name : known)
    allowed += (allowed.empty() ? "" : ", ") + name;
  for (const std::string &name : wanted.value)
    if (known.count(name) == 0)
      throw InputError(wanted.origin + " names '" + name + "'; " +
                       (known.empty() ? "the materials of this scene have no state"
                                      : "allowed are those of the scene's materials: " + allowed));
}

/// Refuses an axisymmetric body beside one that is not, or is another wedge.
void check_wedges(const std::vector<parameters::Body> &bodies) {
  using Section = parameters::Mesh::Section;
  constexpr double rounding = 1e-9;
  const auto axis_of = [](const parameters::Mesh &mesh) {
    return mesh.rotated(dealii::Tensor<1, 3>({0., 0., 1.}));
  };
  const auto side_of = [](const parameters::Mesh &mesh) {
    return mesh.rotated(dealii::Tensor<1, 3>({0., 1., 0.}));
  };
  const auto first = std::find_if(bodies.begin(), bodies.end(), [](const parameters::Body &body) {
    return body.mesh.section.value == Section::axisymmetric;
  });
  if (first == bodies.end())
    return;
  const parameters::Mesh &wedge = first->mesh;
  for (const parameters::Body &body : bodies) {
    const parameters::Mesh &mesh = body.mesh;
    const auto shift = dealii::cross_product_3d(mesh.translation - wedge.translation, axis_of(wedge));
    const double size = mesh.translation.norm() + wedge.translation.norm();
    if (mesh.section.value != Section::axisymmetric || mesh.wedge_angle != wedge.wedge_angle ||
        (axis_of(mesh) - axis_of(wedge)).norm() > rounding ||
        (side_of(mesh) - side_of(wedge)).norm() > rounding || shift.norm() > rounding * size)
      throw InputError(
          mesh.section.origin + ": body '" + body.name + "' is not the same wedge as body '" + first->name +
          "'; allowed is 'Section = axisymmetric' for all bodies or none, with one 'Wedge angle' "
          "and the same axis and sides after rotation and translation");
  }
}

/// Refuses layers in plane strain that do not have the same sides. A load on one would bear on a
/// part of the width of the other.
void check_layers(const std::vector<parameters::Body> &bodies) {
  constexpr double rounding = 1e-9;
  const parameters::Body *first = nullptr;
  const auto side_of = [](const parameters::Mesh &mesh) {
    const auto normal = mesh.rotated(dealii::Tensor<1, 3>({0., 0., 1.}));
    return std::make_pair(normal, normal * mesh.translation);
  };
  for (const parameters::Body &body : bodies) {
    const parameters::Mesh &mesh = body.mesh;
    if (mesh.section.value != parameters::Mesh::Section::plane_strain)
      continue;
    if (first == nullptr)
      first = &body;
    const auto [normal, low] = side_of(mesh);
    const auto [first_normal, first_low] = side_of(first->mesh);
    const double width = mesh.scale * mesh.height, first_width = first->mesh.scale * first->mesh.height;
    if ((normal - first_normal).norm() > rounding || std::abs(low - first_low) > rounding * width ||
        std::abs(width - first_width) > rounding * width)
      throw InputError(mesh.section.origin + ": body '" + body.name + "' is not the same layer as body '" +
                       first->name +
                       "'; allowed is 'Section = plane strain' with one 'Height', and with the same sides "
                       "after scaling, rotation and translation");
  }
}

WholeSection find_whole_section(const std::vector<parameters::Body> &bodies) {
  using Section = parameters::Mesh::Section;
  check_wedges(bodies);
  check_layers(bodies);
  WholeSection whole;
  if (bodies.empty())
    return whole;
  const parameters::Mesh &mesh = bodies.front().mesh;
  whole.axis = mesh.rotated(dealii::Tensor<1, 3>({0., 0., 1.}));
  if (mesh.section.value == Section::axisymmetric) {
    whole.kind = WholeSection::Kind::full_circle;
    whole.factor = 2. * M_PI / std::sin(mesh.wedge_angle); // by the area of the bricks' section
    return whole;
  }
  const auto all = [&](const auto &is) { return std::all_of(bodies.begin(), bodies.end(), is); };
  whole.is_layer =
      all([](const parameters::Body &body) { return body.mesh.section.value == Section::plane_strain; });
  const double width = mesh.scale * mesh.height;
  if (whole.is_layer && width != 1. &&
      all([width](const parameters::Body &body) { return body.mesh.scale * body.mesh.height == width; })) {
    whole.kind = WholeSection::Kind::per_width;
    whole.factor = 1. / width;
  }
  return whole;
}

/// Returns element, unless it is the default one, and law.
std::string describe_law(const parameters::Body &body) {
  const BrickElement element = body.element.value.type;
  return (element != BrickElement::assumed_strain ? std::string(element.name()) + ", " : "") +
         (body.element.value.points_through > 2
              ? std::to_string(body.element.value.points_through) + " points through the thickness, "
              : "") +
         body.material.law->summary();
}

/// Builds the meshes of all bodies in one.
void merge_meshes(const std::vector<parameters::Body> &bodies, const MeshDetail detail,
                  dealii::Triangulation<3> &mesh) {
  std::vector<std::unique_ptr<dealii::Triangulation<3>>> meshes;
  std::vector<const dealii::Triangulation<3> *> pointers;
  for (const auto &body : bodies) {
    meshes.push_back(std::make_unique<dealii::Triangulation<3>>());
    build_body_mesh(body, detail, *meshes.back());
    pointers.push_back(meshes.back().get());
  }
  merge_bodies(pointers, mesh);
}

/// Gives supports and loads the nodes that they select.
void select_nodes(const parameters::Body &parameters, Body &body) {
  NodeFinder finder(parameters);
  ErrorNotes errors;
  for (std::size_t i = 0; i < parameters.loads.size(); ++i)
    errors.note([&] { body.loads[i].nodes = finder.find(parameters.loads[i].nodes); });
  for (const auto &support : parameters.supports)
    errors.note([&] {
      const auto nodes = finder.find(support.nodes);
      for (Constraint &constraint : body.constraints)
        if (!constraint.on_plane && constraint.name == name_of_support(support))
          constraint.nodes = nodes;
    });
  errors.require_none();
}

} // namespace

ElementFormulation make_formulation(const parameters::Body &parameters) {
  ElementFormulation formulation;
  formulation.element = parameters.element.value.type;
  formulation.points_through = parameters.element.value.points_through;
  formulation.constants = parameters.element.value.constants;
  return formulation;
}

Scene::Scene(const parameters::Scene &parameters) : Scene(resolve_boundaries(parameters)) {}

Scene::~Scene() = default;

Scene::Scene(ResolvedScene resolved) : parameters_(std::move(resolved.parameters)) {
  const parameters::Scene &parameters = parameters_;
  ErrorNotes &errors = resolved.errors;
  if (!resolved.has_meshes)
    errors.require_none();
  const std::vector<std::size_t> materials = parameters::number_materials(parameters);
  for (std::size_t i = 0; i < parameters.bodies.size(); ++i) {
    bodies_.push_back(
        make_body(parameters.bodies[i], parameters.amplitudes, parameters.automatic_fade_time()));
    bodies_.back().material = materials[i];
    bodies_.back().boundary_names = std::move(resolved.names[i]);
    if (!errors.note([&] { select_nodes(parameters.bodies[i], bodies_.back()); }))
      resolved.unsound_bodies.insert(i);
  }
  check_state_fields(parameters.output.state_fields, bodies_);
  check_refinements(parameters, errors);
  check_before_start([&] {
    for (const auto &tool : parameters.tools) {
      tools_.emplace_back(tool, parameters.amplitudes);
      tools_.back().placement(0.);
      tools_.back().placement(parameters.time_stepping.end_time);
      if (tools_.back().control() != Tool::Control::motion) {
        tools_.back().load(0.);
        tools_.back().load(parameters.time_stepping.end_time);
      }
    }
  });
  make_pairs();
  if (!errors.is_empty())
    note_errors_on_outlines(errors, resolved.unsound_bodies);
  whole_section_ = find_whole_section(parameters.bodies);

  capabilities_.contact = !pairs_.empty() || !body_pairs_.empty();
  capabilities_.body_contact = !body_pairs_.empty();
  for (const auto &body : bodies_) {
    capabilities_.plasticity |= body.law->has_plasticity();
    for (const auto &constraint : body.constraints)
      capabilities_.moving_supports |= constraint.value != nullptr;
    capabilities_.stabilisation |= body.formulation.element.is_stabilised();
  }
  for (const auto &pair : pairs_)
    capabilities_.friction |= pair.has_friction();
  for (const auto &pair : body_pairs_)
    capabilities_.friction |= pair.has_friction();
  using Tangent = parameters::ContactTangent;
  const bool is_symmetric = wants_symmetry(parameters.solver);
  contact_tangent_ = parameters.solver.contact_tangent;
  // If bodies fold onto each other, Newton's method does not converge with frozen areas and
  // normals.
  if (contact_tangent_ == Tangent::automatic)
    contact_tangent_ = capabilities_.friction || (capabilities_.body_contact && !is_symmetric)
                           ? Tangent::exact
                           : Tangent::consistent;
  capabilities_.unsymmetric_matrix =
      capabilities_.contact &&
      (contact_tangent_ == Tangent::exact || contact_tangent_ == Tangent::numerical ||
       (capabilities_.friction &&
        (contact_tangent_ == Tangent::consistent || contact_tangent_ == Tangent::continuum)));
  if (capabilities_.unsymmetric_matrix && is_symmetric)
    refuse_symmetric_solver(parameters.solver, "this scene's contact tangent is unsymmetric",
                            ", or a symmetrised 'Contact tangent'");
  if (parameters.scheme().has_matrix) {
    allow_for_loads();
    choose_material_tangents();
  }
}

void Scene::note_errors_on_outlines(ErrorNotes &errors, const std::set<std::size_t> &unsound) const {
  dealii::Triangulation<3> mesh;
  if (errors.note([&] { merge_meshes(parameters_.bodies, MeshDetail::outline, mesh); }))
    check_on_mesh(mesh, MeshDetail::outline, errors, unsound);
  errors.require_none();
}

void Scene::choose_material_tangents() {
  using Tangent = parameters::MaterialTangent;
  const auto &[wanted, origin] = parameters_.solver.material_tangent;
  const auto is_symmetric = [](const Body &body) { return body.law->has_symmetric_moduli(); };
  if (wanted != Tangent::automatic && std::all_of(bodies_.begin(), bodies_.end(), is_symmetric))
    throw InputError(origin + " is '" + (wanted == Tangent::exact ? "exact" : "symmetrised") +
                     "', but the exact material tangent of every body is symmetric; allowed is automatic");
  for (auto &body : bodies_) {
    if (is_symmetric(body))
      continue;
    body.formulation.is_symmetrised =
        wanted == Tangent::symmetrised || (wanted == Tangent::automatic && !capabilities_.unsymmetric_matrix);
    if (body.formulation.is_symmetrised)
      continue;
    if (wants_symmetry(parameters_.solver))
      refuse_symmetric_solver(parameters_.solver,
                              "the exact material tangent of body '" + body.name + "' is unsymmetric",
                              ", or another 'Material tangent'");
    capabilities_.unsymmetric_matrix = true;
  }
}

void Scene::allow_for_loads() {
  for (const auto &body : bodies_)
    for (const AppliedLoad &load : body.loads)
      if (load.load.has_unsymmetric_tangent()) {
        capabilities_.unsymmetric_matrix = true;
        if (wants_symmetry(parameters_.solver))
          refuse_symmetric_solver(parameters_.solver, "the " + load.type + " on body '" + body.name +
                                                          "' makes the matrix unsymmetric");
      }
}

void Scene::make_pairs() {
  const auto penetration_tolerance = [&](const parameters::ContactPair &pair) {
    return parameters_.scheme().has_inertia ? pair.penetration_tolerance.value_or(0.)
                                            : pair.penetration_tolerance;
  };
  const auto is_raised = [&](const parameters::ContactPair &pair) {
    // A raise in implicit dynamics treats existing penetration as allowed overlap; with a ramp it
    // would fade.
    const bool may_grow = !parameters_.scheme().has_matrix || !(pair.initial.ramp_time > 0.);
    return parameters_.scheme().has_inertia && !pair.penetration_tolerance && may_grow;
  };
  for (const auto &pair : parameters_.pairs) {
    const std::size_t body = parameters_.body_index(pair);
    const PairSettings settings{pair.name,
                                &pair,
                                pair.friction,
                                pair.penalty.unit == parameters::ContactPair::PenaltyUnit::factor,
                                parameters_.scheme().has_inertia && !pair.penalty.is_given,
                                pair.penalty.normal,
                                pair.penalty.tangential,
                                penetration_tolerance(pair),
                                is_raised(pair),
                                {pair.initial.may_overlap, pair.initial.ramp_time, pair.initial.closed_gap}};
    if (!pair.is_between_bodies()) {
      pairs_.push_back({settings, body, pair.boundary_ids.value, parameters_.tool_index(pair)});
      continue;
    }
    using Pair = parameters::ContactPair;
    const FacetMethod facets = pair.facets.method.value.value_or(
        parameters_.scheme().has_matrix ? FacetMethod::overlap : FacetMethod::planed);
    Pair::PenaltyOf penalty_of = pair.penalty.of;
    if (penalty_of == Pair::PenaltyOf::automatic)
      penalty_of = parameters_.scheme().has_matrix ? Pair::PenaltyOf::series : Pair::PenaltyOf::stiffer;
    const std::size_t second = parameters_.second_body_index(pair);
    const auto &second_ids = pair.second_boundary_ids.value;
    body_pairs_.push_back(
        {settings,
         {body, second},
         {pair.boundary_ids.value, second_ids.empty() ? pair.boundary_ids.value : second_ids},
         body == second && second_ids.empty(),
         facets,
         pair.facets.passes == Pair::Passes::automatic ? facets != FacetMethod::overlap
                                                       : pair.facets.passes == Pair::Passes::two,
         !parameters_.scheme().has_matrix && facets != FacetMethod::overlap &&
             pair.facets.edges != Pair::Edges::free,
         penalty_of,
         pair.facets.smoothing,
         pair.facets.search_margin,
         pair.correction});
    const auto &ids = body_pairs_.back().boundary_ids;
    if (body == second && !second_ids.empty())
      for (const unsigned int id : ids[0])
        if (std::count(ids[1].begin(), ids[1].end(), id) > 0)
          throw InputError(pair.second_boundary_ids.origin + " names boundary id " + std::to_string(id) +
                           " on both sides of the pair; allowed are two sets without a common id, or no id "
                           "here: the faces of 'Boundary ids' among themselves");
  }
}

void Scene::build_mesh(const MeshDetail detail, dealii::Triangulation<3> &mesh) const {
  merge_meshes(parameters_.bodies, detail, mesh);
  ErrorNotes errors;
  check_on_mesh(mesh, detail, errors, {});
  errors.require_none();
}

std::vector<double> Scene::stops() const {
  std::vector<double> times;
  const auto add_ramp = [&](const auto &pair) {
    if (pair.overlap.ramp_time > 0. && pair.overlap.ramp_time < parameters_.time_stepping.end_time)
      times.push_back(pair.overlap.ramp_time);
  };
  std::for_each(pairs_.begin(), pairs_.end(), add_ramp);
  std::for_each(body_pairs_.begin(), body_pairs_.end(), add_ramp);
  for (const auto &tool : tools_)
    for (const double time : {tool.removal_time(), tool.removal_time() + tool.release_time()})
      if (time < parameters_.time_stepping.end_time)
        times.push_back(time);
  const auto add_times = [&](const auto &of) {
    for (const double time : {of.from, of.until, of.until + of.fade_time})
      if (time > 0. && time < parameters_.time_stepping.end_time)
        times.push_back(time);
  };
  for (const auto &body : bodies_) {
    for (const AppliedLoad &load : body.loads)
      add_times(load.times);
    for (const Constraint &constraint : body.constraints)
      add_times(constraint.times);
  }
  for (const double time : refinement_times(parameters_))
    times.push_back(time);
  if (parameters_.scheme().has_matrix)
    add_corners(times);
  return times;
}

namespace {

/// Whether an expression for a motion or load contains the amplitude.
bool drives_something(const std::string &amplitude, const parameters::Scene &scene) {
  const auto has_it = [&amplitude](const std::string &text) {
    return text.find(amplitude) != std::string::npos;
  };
  const auto any_has_it = [&](const std::array<std::string, 3> &texts) {
    return std::any_of(texts.begin(), texts.end(), has_it);
  };
  const auto moves = [&](const parameters::Tool &tool) {
    return any_has_it(tool.motion.translation.value) || has_it(tool.motion.rotation_angle.value) ||
           has_it(tool.motion.load.value);
  };
  const auto is_driven = [&](const parameters::Body &body) {
    return std::any_of(
               body.supports.begin(), body.supports.end(),
               [&](const parameters::Support &support) { return any_has_it(support.displacement.value); }) ||
           std::any_of(body.loads.begin(), body.loads.end(), [&](const parameters::Load &load) {
             const auto &expressions = load.load.expressions;
             return std::any_of(expressions.begin(), expressions.end(),
                                [&](const LoadExpression &expression) { return has_it(expression.text); });
           });
  };
  return std::any_of(scene.tools.begin(), scene.tools.end(), moves) ||
         std::any_of(scene.bodies.begin(), scene.bodies.end(), is_driven);
}

} // namespace

void Scene::add_corners(std::vector<double> &times) const {
  const parameters::TimeStepping &stepping = parameters_.time_stepping;
  const bool is_fixed = stepping.control == parameters::TimeStepping::Control::fixed;
  // Times closer than this need no step of their own.
  constexpr double little = 1e-3;
  const double apart = little * (is_fixed ? stepping.initial_step : stepping.max_step);
  std::vector<double> known = times;
  known.insert(known.end(), stepping.stops.begin(), stepping.stops.end());
  known.push_back(0.);
  known.push_back(stepping.end_time);
  for (const auto &amplitude : parameters_.amplitudes) {
    if (!drives_something(amplitude.name, parameters_))
      continue;
    for (const double corner : corners(amplitude)) {
      const bool is_new = std::none_of(known.begin(), known.end(),
                                       [&](const double time) { return std::abs(time - corner) < apart; });
      if (!is_new || corner < 0. || corner > stepping.end_time)
        continue;
      times.push_back(corner);
      known.push_back(corner);
    }
  }
}

std::array<bool, 3> Scene::free_directions() const {
  std::array<bool, 3> are_free;
  are_free.fill(tools_.empty());
  for (unsigned int i = 0; i < 3; ++i)
    for (const auto &body : parameters_.bodies) {
      const auto &planes = body.symmetry_planes.value;
      are_free[i] =
          are_free[i] && body.loads.empty() &&
          std::none_of(planes.begin(), planes.end(),
                       [i](const parameters::SymmetryPlane &plane) { return plane.normal[i] != 0.; }) &&
          std::none_of(body.supports.begin(), body.supports.end(), [i](const parameters::Support &support) {
            return support.components[i] || !support.axes.are_global();
          });
    }
  return are_free;
}

namespace {

/// Returns "1 support" or "2 supports".
std::string counted(const std::size_t n, const std::string &what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

} // namespace

std::vector<Scene::CapabilityUse> Scene::capability_uses() const {
  std::vector<CapabilityUse> uses;
  const auto add = [&uses](const Capability capability, const bool is_used, const std::string &how) {
    uses.push_back({name_of(capability), is_used, is_used ? how : ""});
  };
  const auto part = [](const std::ptrdiff_t n, const std::size_t all, const std::string &what) {
    return std::to_string(n) + " of " + std::to_string(all) + " " + what;
  };
  const auto n_pairs = [this](const auto &has) {
    return std::count_if(pairs_.begin(), pairs_.end(), has) +
           std::count_if(body_pairs_.begin(), body_pairs_.end(), has);
  };
  const std::size_t n_all_pairs = pairs_.size() + body_pairs_.size();
  const parameters::SchemeType &scheme = parameters_.scheme();
  add(Capability::plasticity, capabilities_.plasticity,
      "history of " + part(std::count_if(bodies_.begin(), bodies_.end(),
                                         [](const Body &body) { return body.law->has_plasticity(); }),
                           bodies_.size(), "bodies"));
  add(Capability::stabilisation, capabilities_.stabilisation,
      "hourglass modes of " +
          part(std::count_if(bodies_.begin(), bodies_.end(),
                             [](const Body &body) { return body.formulation.element.is_stabilised(); }),
               bodies_.size(), "bodies"));
  add(Capability::contact, capabilities_.contact, counted(n_all_pairs, "pair"));
  add(Capability::friction, capabilities_.friction,
      "history of " +
          part(n_pairs([](const auto &pair) { return pair.has_friction(); }), n_all_pairs, "pairs"));
  add(Capability::body_contact, capabilities_.body_contact,
      "facet search of " + part(static_cast<std::ptrdiff_t>(body_pairs_.size()), n_all_pairs, "pairs"));
  const auto n_self = std::count_if(body_pairs_.begin(), body_pairs_.end(),
                                    [](const BodyPair &pair) { return pair.is_self_contact; });
  add(Capability::self_contact, n_self > 0, part(n_self, n_all_pairs, "pairs"));
  const auto n_edges =
      std::count_if(body_pairs_.begin(), body_pairs_.end(), [](const BodyPair &pair) { return pair.edges; });
  add(Capability::edges, n_edges > 0, part(n_edges, n_all_pairs, "pairs"));
  const auto n_augmented = n_pairs([](const auto &pair) { return pair.is_augmented(); });
  add(Capability::augmentation, n_augmented > 0, part(n_augmented, n_all_pairs, "pairs"));
  add(Capability::moving_supports, capabilities_.moving_supports, "");
  const auto n_driven = std::count_if(
      tools_.begin(), tools_.end(), [](const Tool &tool) { return tool.control() != Tool::Control::motion; });
  add(Capability::driven_tools, n_driven > 0,
      "travel of " + part(n_driven, tools_.size(), "tools with a force or moment"));
  const auto n_loaded =
      std::count_if(bodies_.begin(), bodies_.end(), [](const Body &body) { return !body.loads.empty(); });
  add(Capability::loads, n_loaded > 0, "on " + part(n_loaded, bodies_.size(), "bodies"));
  add(Capability::inertia, scheme.has_inertia, scheme.lumps_mass ? "lumped" : "");
  const bool is_implicit_motion = scheme.has_inertia && scheme.has_matrix;
  add(Capability::error_control,
      parameters_.target_error > 0. || parameters_.time_stepping.error_tolerance > 0. ||
          (is_implicit_motion && parameters_.implicit_dynamics.error_tolerance > 0.),
      "");
  const auto &[every_steps, interval, keep] = parameters_.output.checkpoint;
  add(Capability::checkpoints, every_steps > 0 || interval > 0.,
      "the last " + std::to_string(keep) + " are kept");
  add(Capability::matrix, scheme.has_matrix,
      (capabilities_.unsymmetric_matrix ? "unsymmetric; " : "symmetric; ") +
          describe_solver(parameters_.solver.linear_solver.value, capabilities_.unsymmetric_matrix));
  return uses;
}

namespace {

/// Returns the number of elements of the body's mesh, from its outline.
std::size_t count_elements_of(const parameters::Body &body) {
  dealii::Triangulation<3> outline;
  build_body_mesh(body, MeshDetail::outline, outline);
  return count_full_elements(body.mesh, outline);
}

/// Returns the numbers of elements after refinements: "512 from time 0.5, ".
std::string describe_refinements(const parameters::Body &body, std::size_t n_elements) {
  std::ostringstream text;
  for (const double time : body.refinement_times.value) {
    n_elements *= dealii::GeometryInfo<3>::max_children_per_cell;
    text << n_elements << " from time " << time << ", ";
  }
  return text.str();
}

/// Prints names behind a label, in lines of at most 100 columns. Prints nothing without names.
void print_names(const std::string &label, const std::vector<std::string> &names, std::ostream &stream) {
  constexpr std::size_t max_columns = 100;
  std::string line = label;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string name = names[i] + (i + 1 < names.size() ? "," : "");
    if (i > 0 && line.size() + 1 + name.size() > max_columns) {
      stream << line << "\n";
      line = std::string(label.size() - 1, ' ');
    }
    line += (i > 0 ? " " : "") + name;
  }
  if (!names.empty())
    stream << line << "\n";
}

} // namespace

void Scene::describe(std::ostream &stream) const {
  stream << "Scene          " << parameters_.file_name << "\n";
  if (!parameters_.title.empty())
    stream << "Title          " << parameters_.title << "\n";
  if (parameters_.target_error > 0.)
    stream << "Target error   " << parameters_.print_target() << " of the "
           << (parameters_.scheme().has_inertia ? "energies"
               : std::any_of(tools_.begin(), tools_.end(), [](const Tool &tool) { return tool.is_driven(); })
                   ? "forces, or of the travel of driven tools"
                   : "forces")
           << (parameters_.mesh_target.is_wanted() ? "" : ", without the error of the mesh")
           << "; controlled during the run, from\n";
  else
    stream << "Profile        " << parameters_.profile
           << (parameters_.presets.empty() ? " (defaults)\n" : "\n");
  for (const auto &preset : parameters_.presets)
    stream << "               " << parameters::to_string(preset) << "\n";
  std::size_t n_elements = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const auto &body = parameters_.bodies[i];
    const std::size_t n = count_elements_of(body);
    n_elements += n;
    stream << "Body           " << body.name << ": " << n << " hexahedra, " << describe_refinements(body, n)
           << describe_law(body) << ", " << counted(body.symmetry_planes.value.size(), "symmetry plane")
           << ", " << counted(body.supports.size(), "support") << ", " << counted(body.loads.size(), "load")
           << (body.is_stabilised.value ? ", contact stabilisation until contact\n" : "\n");
  }
  for (const auto &tool : tools_) {
    stream << "Tool           " << tool.name() << ": rigid " << tool.shapes()
           << describe_control(tool.control()).addition;
    if (std::isfinite(tool.removal_time()))
      stream << ", removed at time " << tool.removal_time();
    stream << "\n";
  }
  const auto describe_penalties = [](const auto &pair) {
    std::ostringstream text;
    text << ", penalties " << pair.normal_penalty << ", " << pair.tangential_penalty
         << (pair.penalty_is_factor ? " E/h" : " (absolute)");
    if (pair.limits_softness())
      text << ", automatic augmentation";
    else if (pair.is_augmented())
      text << ", augmented to " << *pair.penetration_tolerance << " facet sizes";
    if (pair.overlap.is_allowed && pair.overlap.ramp_time > 0.)
      text << ", initial penetration resolved until time " << pair.overlap.ramp_time;
    else if (pair.overlap.is_allowed)
      text << ", initial penetration kept";
    if (pair.overlap.closed_gap > 0.)
      text << ", initial gaps up to " << pair.overlap.closed_gap << " closed";
    text << "\n";
    return text.str();
  };
  for (const auto &pair : pairs_)
    stream << "Contact pair   " << pair.name << ": " << bodies_[pair.body].name << " on "
           << tools_[pair.tool].name() << ", " << describe_friction(pair.friction)
           << describe_penalties(pair);
  for (const auto &pair : body_pairs_)
    stream << "Contact pair   " << pair.name << ": " << bodies_[pair.bodies[0]].name << " on "
           << (pair.is_self_contact ? "itself" : bodies_[pair.bodies[1]].name) << ", "
           << describe_facets(pair.facets) << " facets, " << (pair.two_passes ? "two passes, " : "one pass, ")
           << (pair.edges ? "edges, " : "") << describe_friction(pair.friction) << describe_penalties(pair);
  for (const auto &probe : parameters_.probes)
    stream << "Probe          " << probe.name << ": " << probe.type << ", " << probe.probe.columns().size()
           << " columns of the history\n";
  const auto &stepping = parameters_.time_stepping;
  stream << "Time           0 to " << stepping.end_time;
  if (!parameters_.scheme().has_matrix)
    stream << ", " << parameters_.explicit_dynamics.safety_factor << " of the stable step\n";
  else
    stream << (stepping.control == parameters::TimeStepping::Control::automatic ? ", automatic steps from "
                                                                                : ", fixed steps of ")
           << stepping.initial_step << "\n";
  stream << "Elements       " << n_elements << " in all, " << parameters_.scheme().description << "\n";
  std::vector<std::string> unused;
  for (const CapabilityUse &use : capability_uses())
    if (use.is_used)
      stream << std::left << std::setw(15) << use.name << "yes" << (use.how.empty() ? "" : ": ") << use.how
             << "\n";
    else
      unused.push_back(use.name);
  print_names("Not modelled   ", unused, stream);
  stream << "Output         " << parameters_.output.folder.value << "\n";
}

std::size_t Scene::count_elements() const {
  std::size_t n_elements = 0;
  for (const auto &body : parameters_.bodies)
    n_elements += count_elements_of(body);
  return n_elements;
}

std::string Scene::describe_as_json(const DiagnosticList &diagnostics) const {
  using Json = nlohmann::ordered_json;
  Json scene;
  scene["file"] = parameters_.file_name;
  scene["valid"] = true;
  scene["title"] = parameters_.title;
  if (parameters_.target_error > 0.)
    scene["target error"] = parameters_.target_error;
  else
    scene["profile"] = parameters_.profile;
  scene["presets"] = Json::object();
  for (const auto &preset : parameters_.presets)
    scene["presets"][join(preset.path) + " / " + preset.key] = preset.value;
  std::size_t n_elements = 0;
  scene["bodies"] = Json::array();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const auto &body = parameters_.bodies[i];
    const std::size_t n = count_elements_of(body);
    n_elements += n;
    scene["bodies"].push_back({{"name", body.name},
                               {"hexahedra", n},
                               {"law", describe_law(body)},
                               {"symmetry planes", body.symmetry_planes.value.size()},
                               {"supports", body.supports.size()},
                               {"loads", body.loads.size()}});
    if (body.is_stabilised.value)
      scene["bodies"].back()["stabilised"] = "until contact";
    std::size_t n_refined = n;
    for (const double time : body.refinement_times.value) {
      n_refined *= dealii::GeometryInfo<3>::max_children_per_cell;
      scene["bodies"].back()["refinements"].push_back({{"time", time}, {"hexahedra", n_refined}});
    }
  }
  scene["tools"] = Json::array();
  for (const auto &tool : tools_) {
    Json entry = {
        {"name", tool.name()}, {"shapes", tool.shapes()}, {"control", describe_control(tool.control()).name}};
    if (std::isfinite(tool.removal_time()))
      entry["removed at"] = tool.removal_time();
    scene["tools"].push_back(entry);
  }
  scene["contact pairs"] = Json::array();
  const auto add_pair = [&](const auto &pair, const std::string &body, const std::string &against,
                            const std::string &facets) {
    Json entry = {{"name", pair.name}, {"body", body}, {"against", against}};
    if (!facets.empty())
      entry["facets"] = facets;
    entry["friction"] = describe_friction(pair.friction);
    entry["normal penalty"] = pair.normal_penalty;
    entry["tangential penalty"] = pair.tangential_penalty;
    entry["penalty unit"] = pair.penalty_is_factor ? "E/h" : "absolute";
    if (pair.limits_softness())
      entry["penetration tolerance"] = "automatic";
    else
      entry["penetration tolerance"] = *pair.penetration_tolerance;
    scene["contact pairs"].push_back(entry);
  };
  for (const auto &pair : pairs_)
    add_pair(pair, bodies_[pair.body].name, tools_[pair.tool].name(), "");
  for (const auto &pair : body_pairs_)
    add_pair(pair, bodies_[pair.bodies[0]].name, bodies_[pair.bodies[1]].name, describe_facets(pair.facets));
  scene["probes"] = Json::array();
  for (const auto &probe : parameters_.probes)
    scene["probes"].push_back(
        {{"name", probe.name}, {"type", probe.type}, {"columns", probe.probe.columns().size()}});
  scene["end time"] = parameters_.time_stepping.end_time;
  scene["scheme"] = parameters::name_of(parameters_.time_stepping.scheme);
  scene["elements"] = n_elements;
  for (const CapabilityUse &use : capability_uses())
    scene["capabilities"][use.name] = use.is_used;
  scene["output folder"] = parameters_.output.folder.value;
  scene["diagnostics"] = Json::array();
  for (const auto &diagnostic : diagnostics)
    scene["diagnostics"].push_back(Json::parse(diagnostic.json()));
  return scene.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

} // namespace billet
