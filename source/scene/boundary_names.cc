// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/boundary_names.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/mesh/loose_nodes.h"
#include "billet/mesh/mesh_cursor.h"
#include "billet/nearest_name.h"
#include "billet/scene/mesh_builder.h"
#include "billet/scene/mesh_file_notes.h"

#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace billet {

namespace {

/// Names of a body's boundaries, and the nodes of sets that these leave out.
struct KnownNames : GroupNames {
  std::map<std::string, LooseNodes> loose;
};

void add_once(std::vector<unsigned int> &ids, const unsigned int id) {
  if (std::find(ids.begin(), ids.end(), id) == ids.end())
    ids.push_back(id);
}

/// Throws the InputError for a name of several groups with different faces.
[[noreturn]] void refuse_ambiguous(const std::string &name, const std::vector<std::string> &groups,
                                   const std::string &origin, const std::string &body) {
  std::string list;
  for (const std::string &group : groups)
    list += (list.empty() ? "" : ", ") + group;
  throw InputError(origin + " names boundary '" + name + "', which body '" + body +
                   "' has several times, with different faces; allowed are " + list);
}

using NamedIds = std::pair<const std::string, std::vector<unsigned int>>;

/// Returns the name of the body that a scene means, though in other letters: Abaqus does not tell
/// upper case from lower case. Throws InputError if there is none.
const NamedIds &find_ids(const std::string &name, const GroupNames &known, const std::string &origin,
                         const std::string &body) {
  const auto exact = known.ids_of_name.find(name);
  const NamedIds *found = exact != known.ids_of_name.end() ? &*exact : nullptr;
  std::vector<std::string> names;
  std::size_t n_similar = 0;
  for (const NamedIds &named : known.ids_of_name) {
    names.push_back(named.first);
    if (exact == known.ids_of_name.end() && lower_case(named.first) == lower_case(name)) {
      ++n_similar;
      found = &named;
    }
  }
  if (const auto several = known.ambiguous.find(lower_case(name));
      found == nullptr && several != known.ambiguous.end())
    refuse_ambiguous(name, several->second, origin, body);
  if (found == nullptr || n_similar > 1) {
    std::string list;
    for (const std::string &other : names)
      list += (list.empty() ? "" : ", ") + other;
    throw InputError(origin + " names boundary '" + name + "'; " +
                     (names.empty() ? "body '" + body +
                                          "' has no names of boundaries; allowed are its ids, and names that "
                                          "'Boundary ids' in its Mesh gives"
                                    : "allowed are ids, and the names of body '" + body + "': " + list) +
                     did_you_mean(name, names));
  }
  if (found->second.empty())
    throw InputError(
        origin + " names boundary '" + name + "', which has no whole face on the outside of body '" + body +
        "'; allowed are groups of exterior faces. 'Nodes = set " + name +
        "' of a support or a load takes a node set (*NSET) of an Abaqus file, and 'Nodes = on line' "
        "the nodes of a straight edge of any mesh");
  return *found;
}

/// Adds a warning if a node set of this name has nodes that are on none of its faces.
void warn_of_loose_nodes(const std::string &name, const KnownNames &known, const std::string &origin,
                         const std::string &body, DiagnosticList &warnings) {
  const auto found = known.loose.find(lower_case(name));
  if (found == known.loose.end())
    return;
  constexpr std::size_t max_listed = 10;
  const LooseNodes &loose = found->second;
  const bool is_one = loose.numbers.size() == 1;
  std::string list;
  std::size_t n_listed = 0;
  for (const long long number : loose.numbers)
    if (n_listed++ < max_listed)
      list += (list.empty() ? "" : ", ") + std::to_string(number);
  warnings.push_back(
      Diagnostic(diagnostic::nodes_on_no_face,
                 std::to_string(loose.numbers.size()) + " of the " + std::to_string(loose.n_nodes) +
                     " nodes of set '" + name + "' " + (is_one ? "is" : "are") +
                     " on no face with all nodes in the set, and " + (is_one ? "is" : "are") + " left out: " +
                     (is_one ? "node " : "nodes ") + list + (n_listed > max_listed ? ", ..." : ""))
          .body(body)
          .origin(origin)
          .advice(
              "'Nodes = set " + name +
              "' of a support or a force takes all nodes of the set. Elsewhere complete its faces, or leave "
              "these nodes out")
          .value("nodes", static_cast<double>(loose.numbers.size())));
}

void resolve(BoundaryIds &boundaries, const KnownNames &known, const std::string &body,
             DiagnosticList &warnings) {
  std::vector<unsigned int> ids;
  for (const unsigned int number : boundaries.value) {
    if (const auto several = known.ambiguous.find(std::to_string(number)); several != known.ambiguous.end())
      refuse_ambiguous(std::to_string(number), several->second, boundaries.origin, body);
    warn_of_loose_nodes(std::to_string(number), known, boundaries.origin, body, warnings);
    const auto group = known.ids_of_number.find(number);
    if (group == known.ids_of_number.end())
      add_once(ids, number);
    else
      for (const unsigned int id : group->second)
        add_once(ids, id);
  }
  for (const std::string &name : boundaries.names) {
    const auto &[found, of_name] = find_ids(name, known, boundaries.origin, body);
    warn_of_loose_nodes(found, known, boundaries.origin, body, warnings);
    for (const unsigned int id : of_name)
      add_once(ids, id);
  }
  boundaries.value = std::move(ids);
}

/// Chooses ids for the names that conditions give to faces.
void name_conditions(parameters::Mesh &mesh, BoundaryNames &names, unsigned int new_id) {
  for (std::size_t i = 0; i < mesh.boundary_names.size(); ++i) {
    const std::string &name = mesh.boundary_names[i];
    if (name.empty()) {
      add_once(names.ids_of_number[mesh.boundary_ids.value[i].first], mesh.boundary_ids.value[i].first);
      continue;
    }
    const auto first = std::find(mesh.boundary_names.begin(), mesh.boundary_names.end(), name);
    unsigned int &id = mesh.boundary_ids.value[i].first;
    id = static_cast<std::size_t>(first - mesh.boundary_names.begin()) < i
             ? mesh.boundary_ids.value[static_cast<std::size_t>(first - mesh.boundary_names.begin())].first
             : new_id++;
    add_once(names.ids_of_name[name], id);
  }
}

/// Returns the names of a body's boundaries: those of its mesh file and those that 'Boundary ids'
/// of Mesh gives. Adds what is to be said of the mesh file to the notes.
KnownNames read_boundary_names(parameters::Mesh &mesh, const std::string &body, MeshFileNotes &notes) {
  unsigned int new_id = min_new_id(mesh) + 1;
  KnownNames names;
  if (mesh.source == parameters::Mesh::Source::file) {
    const LoadedMesh loaded = load_mesh_file(mesh);
    notes.add(loaded, mesh, body);
    static_cast<GroupNames &>(names) = loaded.groups.names();
    names.loose = find_loose_nodes(loaded.mesh);
    new_id = loaded.groups.new_id();
    if (mesh.section.value != parameters::Mesh::Section::solid)
      new_id += 2; // both sides of the section
  }
  name_conditions(mesh, names, new_id);
  return names;
}

/// Returns the ids of the boundary faces that are not on one of these planes.
std::vector<unsigned int> ids_beside(const std::vector<parameters::SymmetryPlane> &planes,
                                     const dealii::Triangulation<3> &mesh) {
  constexpr double rounding = 1e-8;
  const auto corners = dealii::GridTools::compute_bounding_box(mesh).get_boundary_points();
  const double tolerance = rounding * corners.first.distance(corners.second);
  std::vector<unsigned int> ids;
  for (const auto &face : mesh.active_face_iterators()) {
    if (!face->at_boundary())
      continue;
    const bool is_on_plane =
        std::any_of(planes.begin(), planes.end(), [&](const parameters::SymmetryPlane &plane) {
          const auto vertices = face->vertex_indices();
          return std::all_of(vertices.begin(), vertices.end(), [&](const unsigned int v) {
            return std::abs(face->vertex(v) * plane.normal - plane.offset) <= tolerance;
          });
        });
    if (!is_on_plane)
      add_once(ids, face->boundary_id());
  }
  return ids;
}

/// Returns all boundary ids that the body's faces can have, except those of which all faces are on
/// its symmetry planes. Which faces a condition selects shows on the full mesh alone, so that this
/// is made where they may be on a plane. Otherwise faces descend from those of the outline, and may
/// get ids by conditions.
std::vector<unsigned int> find_exterior_ids(const parameters::Body &body) {
  const auto &planes = body.symmetry_planes.value;
  const auto &conditions = body.mesh.boundary_ids.value;
  dealii::Triangulation<3> mesh;
  std::vector<unsigned int> ids;
  if (!planes.empty() && !conditions.empty()) {
    build_body_mesh(body, MeshDetail::full, mesh);
    ids = ids_beside(planes, mesh);
  } else {
    parameters::Body before_conditions = body;
    for (auto &renamed : before_conditions.mesh.boundary_ids.value)
      renamed.second = "0"; // not cleared: its names have the same order
    build_body_mesh(before_conditions, MeshDetail::outline, mesh);
    ids = ids_beside(planes, mesh);
    for (const auto &renamed : conditions)
      add_once(ids, renamed.first);
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// Ids of the exterior faces of bodies, each found once.
class ExteriorIds {
public:
  explicit ExteriorIds(const std::vector<parameters::Body> &bodies) : bodies_(bodies), ids_(bodies.size()) {}

  const std::vector<unsigned int> &of(const std::size_t body) {
    if (!ids_[body])
      ids_[body] = find_exterior_ids(bodies_[body]);
    return *ids_[body];
  }

private:
  const std::vector<parameters::Body> &bodies_;
  std::vector<std::optional<std::vector<unsigned int>>> ids_;
};

} // namespace

unsigned int min_new_id(const parameters::Mesh &mesh) {
  unsigned int id = 1000; // above the ids of primitives
  for (std::size_t i = 0; i < mesh.boundary_names.size(); ++i)
    if (mesh.boundary_names[i].empty())
      id = std::max(id, mesh.boundary_ids.value[i].first);
  return id;
}

namespace {

/// Resolves the boundaries of supports and loads. Returns the names of each body.
std::vector<KnownNames> resolve_of_bodies(ResolvedScene &result) {
  std::vector<KnownNames> known;
  MeshFileNotes notes;
  DiagnosticList warnings;
  for (std::size_t b = 0; b < result.parameters.bodies.size(); ++b) {
    parameters::Body &body = result.parameters.bodies[b];
    known.emplace_back();
    result.has_meshes &=
        result.errors.note([&] { known.back() = read_boundary_names(body.mesh, body.name, notes); });
    if (!result.has_meshes)
      continue;
    const auto resolve_of = [&](auto &of) {
      if (!result.errors.note([&] { resolve(of.boundary_ids, known.back(), body.name, warnings); }))
        result.unsound_bodies.insert(b);
    };
    std::for_each(body.supports.begin(), body.supports.end(), resolve_of);
    std::for_each(body.loads.begin(), body.loads.end(), resolve_of);
  }
  append(result.parameters.warnings, notes.all());
  append(result.parameters.warnings, warnings);
  return known;
}

} // namespace

ResolvedScene resolve_boundaries(parameters::Scene scene) {
  ResolvedScene result{std::move(scene)};
  const std::vector<KnownNames> known = resolve_of_bodies(result);
  result.names.assign(known.begin(), known.end());
  if (!result.has_meshes)
    return result;
  parameters::Scene &resolved = result.parameters;
  ExteriorIds exterior(resolved.bodies);
  const auto resolve_of_pair = [&](BoundaryIds &boundaries, const std::size_t body) {
    result.errors.note([&] {
      if (boundaries.are_all)
        boundaries.value = exterior.of(body);
      else
        resolve(boundaries, known[body], resolved.bodies[body].name, resolved.warnings);
    });
  };
  for (auto &pair : resolved.pairs) {
    resolve_of_pair(pair.boundary_ids, resolved.body_index(pair));
    if (pair.is_between_bodies())
      resolve_of_pair(pair.second_boundary_ids, resolved.second_body_index(pair));
  }
  for (auto &probe : resolved.probes) {
    const std::size_t body = resolved.body_index(probe);
    for (BoundaryIds *const ids : {&probe.boundary_ids, &probe.opposite_ids})
      result.errors.note([&] { resolve(*ids, known[body], resolved.bodies[body].name, resolved.warnings); });
  }
  if (!result.errors.is_empty())
    return result;
  // Ids of pairs without names and groups have been compared when the scene was read.
  const bool has_names = std::any_of(resolved.pairs.begin(), resolved.pairs.end(), [](const auto &pair) {
    return !pair.boundary_ids.names.empty() || !pair.second_boundary_ids.names.empty() ||
           pair.boundary_ids.are_all || pair.second_boundary_ids.are_all;
  });
  const bool has_groups = std::any_of(resolved.bodies.begin(), resolved.bodies.end(), [](const auto &body) {
    return body.mesh.source == parameters::Mesh::Source::file;
  });
  if (has_names || has_groups)
    result.errors.note([&] { parameters::check_repeated_pairs(resolved.pairs, true); });
  return result;
}

} // namespace billet
