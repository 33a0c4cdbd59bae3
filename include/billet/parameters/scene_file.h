// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_SCENE_FILE_H
#define BILLET_PARAMETERS_SCENE_FILE_H

#include <istream>
#include <string>
#include <vector>

namespace dealii {
class ParameterHandler;
}

namespace billet {

/// Scene file as its author wrote it: its subsections and entries, with file and line of each.
/// ParameterHandler holds the values. This class knows the names of bodies, tools and pairs before parameters
/// are declared, and gives file and line for messages.
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

    bool has_old_name() const { return key != written_key || value != written_value; }
  };
  struct Subsection {
    Path path;
    std::string where;
  };

  /// Reads `file_name` and the files that it includes, in ParameterHandler's text format. It knows `set`,
  /// `subsection`, `end`, `include` (relative to the including file), `#` comments and `\` at a line's end.
  /// Replaces old names of parameters by current ones. Throws InputError.
  static SceneFile read(const std::string &file_name);

  /// Reads a scene from a stream; `name` replaces the file's name in messages.
  static SceneFile scan(std::istream &text, const std::string &name);

  /// Returns all entries in the order of their appearance.
  const std::vector<Entry> &entries() const { return entries_; }

  /// Returns the names of the subsections directly below `path`, in the order of their appearance.
  std::vector<std::string> names_below(const Path &path) const;

  /// Returns the first entry set directly in this subsection; null if there is none.
  const Entry *first_entry(const Path &path) const;

  /// Returns the value of an entry; `otherwise` if it is not set.
  std::string value(const Path &path, const std::string &key, const std::string &otherwise) const;

  /// Sets every entry in `prm`. Throws InputError with file and line for an unknown subsection or parameter,
  /// a parameter that is set twice, or a value of the wrong type.
  void set_all(dealii::ParameterHandler &prm) const;

  /// Returns where an entry was set, "file:line". If it was not, returns "file:line (default)" with the line
  /// of the subsection.
  std::string where(const Path &path, const std::string &key) const;
  bool is_set(const Path &path, const std::string &key) const;
  /// Returns where a subsection was opened.
  std::string where(const Path &path) const;

  const std::string &file_name() const { return file_name_; }
  /// Returns the folder of the scene file, with a final slash unless it is empty.
  std::string folder() const;
  /// Returns the file's text as read, with includes resolved.
  const std::string &text() const { return text_; }

private:
  void scan_file(std::istream &text, const std::string &name, Path &path, unsigned int depth);
  std::string last_opened(const Path &path) const;
  const Entry *find(const Path &path, const std::string &key) const;

  std::string file_name_;
  std::string text_;
  std::vector<Entry> entries_;
  std::vector<Subsection> subsections_;
};

/// Returns "Bodies / billet / Material".
std::string join(const SceneFile::Path &path);

} // namespace billet

#endif
