// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_SCENE_FILE_H
#define BILLET_PARAMETERS_SCENE_FILE_H

#include "billet/diagnostics.h"

#include <istream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace dealii {
class ParameterHandler;
}

namespace billet {

/// Scene file as its author wrote it: its subsections and entries, with file and line of each.
/// ParameterHandler holds the values. This class knows the names of bodies, tools and pairs before
/// parameters are declared, and gives file and line for messages.
class SceneFile {
public:
  using Path = std::vector<std::string>;

  /// Key and value with their current names (renames.h), and as written.
  struct Entry {
    Path path;
    std::string key;
    std::string value;
    std::string where; ///< "file:line"
    std::string written_key, written_value;
    unsigned int line; ///< in its file, from 1
    bool is_included;  ///< from a file that the scene file includes
    /// Numbers of the files from the scene file to the one that sets it, each included by the one
    /// before; empty for the command line.
    std::vector<unsigned int> files;
    std::string folder; ///< of its file, with a final slash unless it is empty
    Path source{};      ///< subsection of the entry that this one copies; empty if it is none

    bool has_old_name() const { return key != written_key || value != written_value; }
    /// Whether this entry overrides the other one: that is in a file which the file of this one
    /// includes.
    bool overrides(const Entry &other) const;
  };
  struct Subsection {
    Path path;
    std::string where;
    std::size_t n_files = 1; ///< from the scene file to the one that opens it
  };
  /// Place in the file that an error is about.
  struct Place {
    Path path;
    std::string key; ///< of an entry; empty: the subsection itself
    /// The file does not set the entry, or something is missing in the subsection.
    bool is_missing = false;
  };
  /// Value from the command line, which overrides the files.
  struct Setting {
    std::string path; ///< "Time stepping/End time"
    std::string value;
    std::string where; ///< its source for messages, such as "--set Time stepping/End time=2"
  };

  /// Reads `file_name` and the files that it includes, in ParameterHandler's text format. It knows
  /// `set`, `subsection`, `end`, `include` (relative to the including file), `#` comments and `\`
  /// at a line's end. A file overrides what the files that it includes set; `settings` override
  /// all.
  ///
  /// Replaces old names of parameters by current ones. Repairs an `end` that is missing or one too
  /// many. Throws InputError for a file that cannot be read; other errors wait for set_all() or
  /// require_sound().
  static SceneFile read(const std::string &file_name, const std::vector<Setting> &settings = {});

  /// Reads a scene from a stream; `name` replaces the file's name in messages. Throws InputError.
  static SceneFile scan(std::istream &text, const std::string &name);

  /// Throws InputError with all errors found so far.
  void require_sound() const;

  /// Returns the place with which an error message begins, "file:line: ..."; none if it begins
  /// otherwise.
  std::optional<Place> find_place(const std::string &message) const;
  /// Takes an entry away; with an empty key, a subsection with all that is in it. Returns whether
  /// there was one.
  bool remove(const Path &path, const std::string &key = "");
  /// Forgets the errors found so far.
  void forget_errors() { errors_.clear(); }

  /// Returns all entries in the order of their appearance, without overridden ones.
  const std::vector<Entry> &entries() const { return entries_; }

  /// Returns the names of the subsections directly below `path`, in the order of their appearance.
  std::vector<std::string> names_below(const Path &path) const;

  /// Returns the first entry set directly in this subsection; null if there is none.
  const Entry *first_entry(const Path &path) const;

  /// Returns the value of an entry; `otherwise` if it is not set.
  std::string value(const Path &path, const std::string &key, const std::string &otherwise) const;

  /// Returns the paths of all subsections in the order of their appearance.
  std::vector<Path> paths() const;

  /// Adds a subsection as if it stood at `where`.
  void add_subsection(const Path &path, const std::string &where);
  /// Sets a parameter as if that stood at `where`.
  void add_entry(const Path &path, const std::string &key, const std::string &value,
                 const std::string &where);
  /// Sets what an entry sets, in another subsection. Messages name its own.
  void copy_entry(const Entry &entry, const Path &path);

  /// Sets every entry in `prm`. Throws InputError with all unknown subsections and parameters,
  /// parameters that are set twice, and values of the wrong type, each with file and line.
  void set_all(dealii::ParameterHandler &prm) const;

  /// Returns where an entry was set, "file:line". If it was not, returns "file:line (default)" with
  /// the line of the subsection.
  std::string where(const Path &path, const std::string &key) const;
  bool is_set(const Path &path, const std::string &key) const;
  /// Returns the subsection in which the user set an entry: `path`, unless it is a copy.
  const Path &written_path(const Path &path, const std::string &key) const;
  /// Returns where a subsection was opened.
  std::string where(const Path &path) const;

  const std::string &file_name() const { return file_name_; }
  /// Returns a file that an entry names, as a path from the working directory. It is beside the
  /// scene file, or else, if an included file names it, beside that one.
  std::string resolve(const Path &path, const std::string &key, const std::string &name) const;
  /// Returns the file's text as read, with includes resolved, overridden lines as comments, and the
  /// settings of the command line at its end.
  const std::string &text() const { return text_; }

private:
  void scan_file(std::istream &text, const std::string &name, Path &path,
                 const std::vector<unsigned int> &files);
  void include(const std::string &statement, const std::string &where, const std::string &name, Path &path,
               const std::vector<unsigned int> &files);
  void add_entry(const std::string &statement, const Path &path, Entry entry);
  void add_setting(const Setting &setting);
  void resolve_overrides();
  /// Notes bodies, tools and pairs of a variant that the files which it includes do not have, and
  /// that are no new ones.
  void note_parts_of_no_file();
  /// Notes an error; `where` and `path`: of a statement that sets nothing, for find_place().
  void note(const std::string &error);
  void note(const std::string &error, const std::string &where, const Path &path);
  /// Notes an `end` that is missing or one too many.
  void note_unmatched(const std::string &error);
  /// Throws InputError with this and all earlier errors.
  [[noreturn]] void fail(const std::string &error);
  const Entry *find(const Path &path, const std::string &key) const;

  std::string file_name_;
  std::string text_;
  std::vector<Entry> entries_;
  std::vector<Subsection> subsections_;
  DiagnosticList errors_;
  /// Statements that set nothing, and the subsections that they stand in.
  std::vector<Subsection> faulty_;
  std::vector<std::string> unmatched_; ///< errors about `end`s
  unsigned int n_files_ = 0;
  /// Lines of the text, each with its entry or no_entry.
  std::vector<std::pair<std::string, std::size_t>> lines_;
  static constexpr std::size_t no_entry = static_cast<std::size_t>(-1);
};

/// Returns "Bodies / billet / Material".
std::string join(const SceneFile::Path &path);

} // namespace billet

#endif
