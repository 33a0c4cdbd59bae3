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

/// A scene file as its author wrote it: which subsections it opens, which entries it sets, and on which line
/// of which file. ParameterHandler holds the values; this class knows the names that the user chose for
/// bodies, tools and pairs before anything is declared, and lets every message name file and line.
class SceneFile {
public:
  using Path = std::vector<std::string>;

  /// Key and value under today's names (renames.h), and as they are written.
  struct Entry {
    Path path;
    std::string key;
    std::string value;
    std::string where; ///< "file:line"
    std::string written_key, written_value;
    unsigned int line; ///< in its file, from 1
    bool is_included;  ///< it stands in a file that the scene file includes

    bool has_old_name() const { return key != written_key || value != written_value; }
  };
  struct Subsection {
    Path path;
    std::string where;
  };

  /// Reads `file_name` and what it includes. Understands ParameterHandler's text format: `set`, `subsection`,
  /// `end`, `include` (relative to the including file), `#` comments and `\` at a line's end. Old names of
  /// parameters stand for today's. Throws InputError.
  static SceneFile read(const std::string &file_name);

  /// The same for text at hand; `name` stands for the file in messages.
  static SceneFile scan(std::istream &text, const std::string &name);

  /// All entries in the order of their appearance.
  const std::vector<Entry> &entries() const { return entries_; }

  /// Names of the subsections right below `path`, in the order of their appearance.
  std::vector<std::string> names_below(const Path &path) const;

  /// The first entry that is set right in this subsection; null if there is none.
  const Entry *first_entry(const Path &path) const;

  /// What an entry is set to; `otherwise` if it is not.
  std::string value(const Path &path, const std::string &key, const std::string &otherwise) const;

  /// Hands every entry to `prm`. Throws InputError with file and line on an unknown subsection or parameter,
  /// one that is set twice, or a value of the wrong type.
  void set_all(dealii::ParameterHandler &prm) const;

  /// Where an entry was set, "file:line"; "file:line (default)" with the subsection's line if it was not.
  std::string where(const Path &path, const std::string &key) const;
  bool is_set(const Path &path, const std::string &key) const;
  /// Where a subsection was opened.
  std::string where(const Path &path) const;

  const std::string &file_name() const { return file_name_; }
  /// The folder of the scene file, with a slash at its end unless it is empty.
  std::string folder() const;
  /// The file's text as read, includes resolved.
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

/// "Bodies / billet / Material".
std::string join(const SceneFile::Path &path);

} // namespace billet

#endif
