// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/all_errors.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/fail_together.h"
#include "billet/loads/load.h"
#include "billet/parameters/scene.h"
#include "billet/run/check.h"
#include "billet/scene_fault.h"

#include <algorithm>
#include <exception>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace billet {

namespace {

using Path = SceneFile::Path;

bool begins_with(const Path &path, const Path &start) {
  return path.size() >= start.size() && std::equal(start.begin(), start.end(), path.begin());
}

bool contains(const std::vector<std::string> &list, const std::string &name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

/// Scene file of which parts with errors are taken out.
class SoundRest {
public:
  explicit SoundRest(SceneFile file) : file_(std::move(file)) { file_.forget_errors(); }

  const SceneFile &file() const { return file_; }

  bool has_bodies() const { return !file_.names_below({"Bodies"}).empty(); }

  /// Notes errors, except consequences of earlier ones, and takes out the parts that they are
  /// about. Returns whether more can be found in what is left.
  bool take_out(const DiagnosticList &errors) {
    const bool is_first = n_rounds_++ == 0;
    bool changes = false;
    std::vector<std::pair<SceneFile::Place, SceneFault>> places;
    for (const Diagnostic &error : errors) {
      const std::optional<SceneFile::Place> place = file_.find_place(error.what());
      const SceneFault fault = fault_of(error);
      if (!is_found(error)) // of one that is, the part is still to be taken out
        note(error, place, fault, is_first);
      if (place)
        places.emplace_back(*place, fault);
      // A statement without a place is left out when the file is read.
      changes = changes || (is_first && !place);
    }
    for (const auto &[place, fault] : places)
      changes = take_out(place, fault) || changes;
    return changes && !all_depends_;
  }

  /// Takes out bodies without a mesh. Returns whether there are any.
  bool leave_out_meshless() {
    const std::set<std::string> bodies = std::exchange(meshless_, {});
    for (const std::string &body : bodies) {
      remove_part({"Bodies", body});
    }
    return !bodies.empty();
  }

  /// Returns all errors, and a note about what is unchecked. `is_sound`: nothing else was found in
  /// the rest.
  DiagnosticList report(const bool is_sound) const {
    DiagnosticList all = found_;
    std::string list;
    for (const auto &[path, detail] : unchecked_)
      if (!path.empty() && (reported_.count(path) == 0 || !detail.empty()))
        list += (list.empty() ? "'" : ", '") + join(path) + "'" + detail;
    // An error beside the scene hides nothing of it.
    if (!is_sound && n_rounds_ > 1 && !changed_.empty())
      list += list.empty() ? "parts of the scene" : ", other parts";
    if (all_depends_)
      list += list.empty() ? "the rest of the scene" : ", the rest of the scene";
    if (!list.empty())
      all.emplace_back(diagnostic::unchecked_parts,
                       "Unchecked, since they depend on parts with errors: " + list);
    return all;
  }

private:
  static constexpr const char *scheme = "Scheme";

  static std::string at(const Path &path, const std::size_t i) { return i < path.size() ? path[i] : ""; }

  static bool is_named(const std::string &section) {
    return section == "Bodies" || section == "Tools" || section == "Contact pairs" || section == "Probes" ||
           section == "Amplitudes";
  }

  bool is_found(const Diagnostic &error) const {
    return std::any_of(found_.begin(), found_.end(),
                       [&](const Diagnostic &before) { return before.what() == error.what(); });
  }

  /// Notes an error, or that its part stays unchecked, since it follows from an earlier one.
  void note(const Diagnostic &error, const std::optional<SceneFile::Place> &place, const SceneFault &fault,
            const bool is_first) {
    if (is_first || (place && !follows(*place, fault))) {
      found_.push_back(error);
      if (place)
        reported_.insert(part_of(place->path));
    } else if (place && !(is_dynamic_ && contains(fault.depends_on, scheme)))
      unchecked_.insert({part_of(place->path), place->path.size() == 2 && place->key.empty() ? " (support)"
                                               : reported_.count(part_of(place->path)) > 0
                                                   ? " (other parameters)"
                                                   : ""});
  }

  /// Returns the part that is taken out if there is an error at this place; otherwise its
  /// subsection.
  static Path part_of(const Path &path) {
    if (!is_named(at(path, 0)) || path.size() < 2)
      return path;
    std::size_t n = 2;
    if (path[0] == "Bodies")
      n = at(path, 2) == "Supports" || at(path, 2) == "Loads" ? 4 : 3;
    else if (path[0] == "Tools" && at(path, 2) == "Motion")
      n = 3;
    return {path.begin(), path.begin() + static_cast<std::ptrdiff_t>(std::min(n, path.size()))};
  }

  /// Whether an error may be due to what was taken out before.
  bool follows(const SceneFile::Place &place, const SceneFault &fault) const {
    const Path &path = place.path;
    if (mended_.count({path, place.key}) > 0)
      return true;
    for (const Path &replaced : replaced_)
      if (begins_with(path, replaced))
        return true;
    if (place.is_missing && std::any_of(changed_.begin(), changed_.end(), [&](const Path &changed) {
          return may_miss(path, changed) || (place.key.empty() && may_touch(path, changed));
        }))
      return true;
    return std::any_of(fault.depends_on.begin(), fault.depends_on.end(), [&](const std::string &other) {
      return names_.count(other) > 0 || std::any_of(keys_.begin(), keys_.end(), [&](const auto &key) {
               return key.second == other && (!is_named(at(key.first, 0)) || begins_with(path, key.first));
             });
    });
  }

  /// Whether something in a subsection may be missing since another one has changed.
  static bool may_miss(const Path &path, const Path &changed) {
    if (at(path, 2) == "Material")
      return begins_with(changed, path);
    return begins_with(path, changed) || // a material supports nothing
           (begins_with(changed, path) && at(changed, 2) != "Material");
  }

  /// Whether a body or a pair may touch something else since another subsection has changed.
  static bool may_touch(const Path &path, const Path &changed) {
    const std::string of = at(path, 0), by = at(changed, 0);
    const bool is_of_contact = by == "Tools" || by == "Contact pairs" || by == "General contact" ||
                               by == "Amplitudes" || changed == Path{"Bodies"};
    return (of == "Bodies" && is_of_contact) || (of == "Contact pairs" && (is_of_contact || by == "Bodies"));
  }

  /// Takes out what has an error. Returns whether the scene has changed.
  bool take_out(const SceneFile::Place &place, const SceneFault &fault) {
    const Path &path = place.path;
    const std::string section = at(path, 0), name = at(path, 1), kind = at(path, 2);
    if (mend(place, fault))
      return true;
    note_key(place, fault);
    if (section == "Bodies" && path.size() > 1) {
      if (kind == "Mesh")
        return replace_mesh(name);
      if (kind == "Material")
        return replace_material(name);
      if (path.size() > 3 && (kind == "Supports" || kind == "Loads"))
        return remove_subsection(part_of(path));
      if (path.size() > 2 || !place.key.empty()) // unknown names, and parameters of the body
        return place.is_missing && !place.key.empty() ? remove_part({section, name}) : remove_place(place);
      return (fault.kind != SceneFault::Kind::unknown_name && make_dynamic()) || remove_part({section, name});
    }
    if (is_named(section) && path.size() > 1) {
      if (section == "Tools" && kind == "Motion" && remove_subsection({section, name, kind}))
        return true;
      return remove_part({section, name});
    }
    return remove_place(place);
  }

  /// Returns the default of a parameter of loads; none if it is not one, or its default is empty.
  static std::optional<std::string> default_of_load(const SceneFile::Place &place) {
    if (at(place.path, 2) == "Loads")
      for (const LoadType &type : load_types())
        for (const TypeParameter &parameter : type.parameters)
          if (parameter.key == place.key && !parameter.default_value.empty())
            return parameter.default_value;
    return std::nullopt;
  }

  /// Gives a parameter a value that stands for the wrong one, or for the missing one of a load.
  /// Thus other errors of its part are found. The value is the one that the user probably meant, a
  /// number of a material, or the default of a support or a load. Returns false if it cannot, or
  /// has done so before.
  bool mend(const SceneFile::Place &place, const SceneFault &fault) {
    const std::string kind = at(place.path, 2);
    const std::optional<std::string> size = default_of_load(place);
    const bool is_set = !place.is_missing && file_.is_set(place.path, place.key);
    if (place.key.empty() || (!is_set && !size) || !fault.is_of_value())
      return false;
    const bool is_kind = place.key == scheme || place.key == "Type" || place.key == "Shape";
    std::optional<std::string> value;
    if (!fault.suggestion.empty() && is_kind)
      value = fault.suggestion;
    else if (kind == "Material" && fault.kind == SceneFault::Kind::wrong_number)
      value = place.key == "Poisson ratio" ? "0.3" : "1";
    else
      value = size;
    const bool has_default = kind == "Supports" || kind == "Loads";
    if ((!value && !has_default) || !mended_.insert({place.path, place.key}).second)
      return false;
    const std::string where = file_.where(place.path, place.key);
    file_.remove(place.path, place.key);
    if (value)
      file_.add_entry(place.path, place.key, *value, where);
    if (fault.suggestion.empty() || place.key == scheme) // others are most likely right
      keys_.insert({place.path, place.key});
    return true;
  }

  /// Remembers a parameter, on which others of its subsection may depend, and on those of other
  /// sections all.
  void note_key(const SceneFile::Place &place, const SceneFault &fault) {
    if (fault.kind == SceneFault::Kind::excluded) // one such error is enough
      for (const std::string &other : fault.depends_on)
        keys_.insert({{}, other});
    if (place.key.empty())
      return;
    // Key of an unknown entry.
    const std::string key = fault.suggestion.empty() ? place.key : fault.suggestion;
    for (const std::string &one : {place.key, key}) {
      keys_.insert({place.path, one});
      all_depends_ = all_depends_ || one == scheme || one == "Libraries";
    }
  }

  /// Takes out an entry, or a subsection that is unknown.
  bool remove_place(const SceneFile::Place &place) {
    if (!place.key.empty()) {
      if (!place.path.empty() || place.key == "Contact")
        changed_.insert(place.path);
      return file_.remove(place.path, place.key);
    }
    if (place.path.empty())
      return false;
    for (const std::string &name : file_.names_below(place.path))
      names_.insert(name);
    return remove_subsection(place.path);
  }

  bool remove_subsection(const Path &path) {
    changed_.insert(path);
    changed_.insert(Path(path.begin(), path.end() - 1));
    return file_.remove(path);
  }

  /// Takes out a body, a tool, a pair, a probe or an amplitude, and pairs and probes that name it.
  bool remove_part(const Path &part) {
    const std::string section = part[0], name = part[1];
    names_.insert(name);
    if (section == "Bodies")
      unchecked_[part] = " (supports, loads, contact, probes)";
    if (section == "Bodies" || section == "Tools")
      for (const std::string list : {"Contact pairs", "Probes"})
        for (const std::string &user : file_.names_below({list}))
          for (const std::string key : {"Body", "Second body", "Tool"})
            if (file_.value({list, user}, key, "") == name && (key == "Tool") == (section == "Tools")) {
              unchecked_.insert({{list, user}, ""});
              remove_subsection({list, user});
            }
    return remove_subsection(part);
  }

  /// Returns where a subsection is in the file; if it is not there, a place at which no message
  /// begins.
  std::string where_of(const Path &path) const {
    const std::string where = file_.where(path);
    return where == file_.file_name() ? "(stands in)" : where;
  }

  /// Makes a static scene a dynamic one, in which a body needs no support. Returns false if it is
  /// one.
  bool make_dynamic() {
    const Path section{"Time stepping"};
    using Scheme = parameters::TimeStepping::Scheme;
    const std::string given = file_.value(section, scheme, parameters::name_of(Scheme::quasi_static));
    const auto now = parameters::find_value(parameters::schemes(), given);
    if (!now || parameters::type_of(*now).has_inertia)
      return false;
    const std::string where = where_of(section);
    file_.remove(section, scheme);
    file_.add_subsection(section, where);
    file_.add_entry(section, scheme, parameters::name_of(Scheme::implicit_dynamics), where);
    keys_.insert({{}, scheme});
    is_dynamic_ = true;
    return true;
  }

  /// Gives a body a material that stands for its own.
  bool replace_material(const std::string &body) {
    const std::vector<std::pair<std::string, std::string>> entries{
        {"Young modulus", "1"}, {"Poisson ratio", "0.3"}, {"Density", "1"}};
    return replace({"Bodies", body, "Material"}, entries);
  }

  /// Gives a body a mesh that stands for its own until meshes matter.
  bool replace_mesh(const std::string &body) {
    const std::vector<std::pair<std::string, std::string>> entries{{"Primitive", "hyper_cube"}};
    if (!replace({"Bodies", body, "Mesh"}, entries))
      return false;
    meshless_.insert(body);
    return true;
  }

  /// Replaces a subsection, or if that has been done already, takes out the body.
  bool replace(const Path &path, const std::vector<std::pair<std::string, std::string>> &entries) {
    const std::vector<std::string> bodies = file_.names_below({path[0]});
    if (std::find(bodies.begin(), bodies.end(), path[1]) == bodies.end()) // taken out, too
      return false;
    if (!replaced_.insert(path).second)
      return n_rounds_of_[path] == n_rounds_ || remove_part({path[0], path[1]});
    n_rounds_of_[path] = n_rounds_;
    const std::string where = where_of(path);
    remove_subsection(path);
    file_.add_subsection(path, where);
    for (const auto &[key, value] : entries)
      file_.add_entry(path, key, value, where);
    return true;
  }

  SceneFile file_;
  DiagnosticList found_;
  std::set<Path> reported_;                       ///< parts with errors
  std::map<Path, std::string> unchecked_;         ///< parts, with what of them is unchecked
  std::set<Path> changed_;                        ///< subsections of which something was taken out
  std::set<std::pair<Path, std::string>> mended_; ///< parameters whose values stand for wrong ones
  std::set<Path> replaced_;                       ///< materials and meshes
  std::map<Path, unsigned int> n_rounds_of_;
  std::set<std::string> meshless_;
  std::set<std::string> names_;                 ///< of parts that were taken out
  std::set<std::pair<Path, std::string>> keys_; ///< that were taken out
  unsigned int n_rounds_ = 0;
  bool is_dynamic_ = false;  ///< whether it has been made so
  bool all_depends_ = false; ///< on a parameter with an error
};

} // namespace

DiagnosticList find_all_errors(const SceneSource &source, const DiagnosticList &first,
                               MPI_Comm communicator) {
  std::optional<SoundRest> rest;
  try {
    fail_together(communicator, [&] { rest.emplace(SceneFile::read(source.file_name, source.settings)); });
  } catch (const InputError &) { // what stands where in the file is not known
    return first;
  }
  constexpr unsigned int max_rounds = 50;
  DiagnosticList errors = first;
  bool is_sound = false;
  for (unsigned int round = 0; round < max_rounds && !is_sound && rest->take_out(errors); ++round)
    try {
      parameters::Scene scene;
      const auto read = [&] {
        fail_together(communicator,
                      [&] { scene = parameters::Scene::read(rest->file(), source.restart_file); });
      };
      read();
      if (rest->leave_out_meshless() && rest->has_bodies())
        read();
      if (rest->has_bodies())
        check_quietly(scene, communicator);
      is_sound = true;
    } catch (const InputError &error) { // on all ranks
      errors = error.diagnostics();
    } catch (const std::exception &) {
      // This occurs on all ranks: the rest is no scene that anybody would write.
      break;
    }
  return rest->report(is_sound);
}

} // namespace billet
