// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/mesh_file_notes.h"

#include "billet/diagnostic_kinds.h"
#include "billet/printable.h"
#include "billet/scene/unread_keywords.h"

#include <cmath>
#include <sstream>

namespace billet {

namespace {

constexpr std::size_t max_name = 200, max_list = 1000; // characters

std::string text_of(const double value) {
  std::ostringstream text;
  text.precision(2);
  text << value;
  return text.str();
}

/// Returns a number with one digit that is at least twice the value.
double above_twice(const double value) {
  constexpr double rounding = 1e-6;
  const double power = std::pow(10., std::floor(std::log10(2. * value)));
  return std::ceil(2. * value / power - rounding) * power;
}

std::string list(const std::vector<std::string> &names) {
  std::string text;
  for (const std::string &name : names)
    text += (text.empty() ? "" : ", ") + name;
  return printable(text, max_list);
}

Diagnostic describe_near_nodes(const NearNodes &near_nodes, const Located<std::string> &file,
                               const std::string &body) {
  const bool is_one = near_nodes.n_pairs == 1;
  return Diagnostic(diagnostic::nodes_not_joined,
                    (is_one ? "Two nodes" : std::to_string(near_nodes.n_pairs) + " pairs of nodes") +
                        " of '" + printable(file.value, max_name) + "' are " + (is_one ? "" : "at most ") +
                        text_of(near_nodes.distance) +
                        " apart, less than a thousandth of the edges there, and not joined" +
                        (is_one ? ": " : ", such as ") + near_nodes.examples)
      .body(body)
      .origin(file.origin)
      .advice("'Merge nodes within = " + text_of(above_twice(near_nodes.distance)) +
              "' in Mesh joins them. 0 keeps them apart, for parts that only touch")
      .value("pairs", static_cast<double>(near_nodes.n_pairs))
      .value("distance", near_nodes.distance);
}

Diagnostic describe_parts(const std::vector<std::string> &parts, const Located<std::string> &file,
                          const std::string &body) {
  return Diagnostic(diagnostic::volumes_together, "The body takes the volumes " + list(parts) + " of '" +
                                                      printable(file.value, max_name) +
                                                      "' as one body of one material")
      .body(body)
      .origin(file.origin)
      .advice("Name some of them in 'Volumes' in Mesh, and the others in a body of their own with the same "
              "'File'. Name all of them to confirm")
      .value("volumes", static_cast<double>(parts.size()));
}

Diagnostic describe_untaken(const UntakenVolumes &untaken, const Located<std::string> &file) {
  std::string what;
  if (!untaken.names.empty())
    what = (untaken.names.size() == 1 ? "volume " : "volumes ") + list(untaken.names);
  if (untaken.n_unnamed > 0)
    what += (what.empty() ? "" : "; ") + std::to_string(untaken.n_unnamed) +
            (untaken.n_unnamed == 1 ? " hexahedron" : " hexahedra") + " in no volume";
  return Diagnostic(diagnostic::volumes_unread,
                    "No body takes this of '" + printable(file.value, max_name) + "': " + what)
      .origin(file.origin)
      .advice("Name volumes in 'Volumes' of a body if they belong to the scene")
      .value("volumes", static_cast<double>(untaken.names.size()));
}

} // namespace

void MeshFileNotes::add(const LoadedMesh &loaded, const parameters::Mesh &mesh, const std::string &body) {
  append(notes_, describe_unread_keywords(loaded.mesh.unread, mesh.file_name, body));
  if (loaded.near_nodes.n_pairs > 0)
    notes_.push_back(describe_near_nodes(loaded.near_nodes, mesh.file_name, body));
  if (const auto parts = separate_parts(loaded.volumes); mesh.volumes.value.empty() && !parts.empty())
    notes_.push_back(describe_parts(parts, mesh.file_name, body));
  File &file = files_[mesh.file_name.value];
  if (file.choices.empty())
    file.name = mesh.file_name;
  file.choices.push_back(loaded.volumes);
}

DiagnosticList MeshFileNotes::all() const {
  DiagnosticList notes = notes_;
  for (const auto &[name, file] : files_) {
    const UntakenVolumes untaken = find_untaken(file.choices);
    if (!untaken.names.empty() || untaken.n_unnamed > 0)
      notes.push_back(describe_untaken(untaken, file.name));
  }
  return notes;
}

} // namespace billet
