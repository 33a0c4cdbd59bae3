// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/scene_file.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/nearest_name.h"
#include "billet/parameters/number_text.h"
#include "billet/parameters/renames.h"
#include "billet/parameters/unmatched_ends.h"
#include "billet/scene_fault.h"
#include "billet/shipped.h"

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

namespace billet {

namespace {

using dealii::Utilities::trim;

std::string folder_of(const std::string &file_name) {
  const auto slash = file_name.rfind('/');
  return slash == std::string::npos ? "" : file_name.substr(0, slash + 1);
}

/// Removes the keyword from the start of `line`. Returns false if `line` does not start with it,
/// followed by a blank or nothing.
bool take_keyword(std::string &line, const std::string &keyword) {
  if (line.compare(0, keyword.size(), keyword) != 0 ||
      (line.size() > keyword.size() && line[keyword.size()] != ' ' && line[keyword.size()] != '\t'))
    return false;
  line = trim(line.substr(keyword.size()));
  return true;
}

std::string describe_second(const SceneFile::Entry &entry, const SceneFile::Entry &first) {
  if (entry.written_key != first.written_key)
    return entry.where + ": '" + entry.written_key + "' is the same parameter as '" + first.written_key +
           "' at " + first.where + "; allowed is '" + entry.key + "' alone";
  return entry.where + ": '" + entry.written_key + "' is set twice, first at " + first.where;
}

/// Removes what editors of other systems add: a byte-order mark in the first line, a carriage
/// return at the end of each. Throws InputError for text in UTF-16.
void clean_line(std::string &line, const bool is_first, const std::string &where) {
  const std::string mark = "\xEF\xBB\xBF";
  if (is_first && (line.compare(0, 2, "\xFF\xFE") == 0 || line.compare(0, 2, "\xFE\xFF") == 0))
    throw InputError(where +
                     ": the file's encoding is UTF-16; allowed is plain text or UTF-8. Save it as UTF-8");
  if (is_first && line.compare(0, mark.size(), mark) == 0)
    line.erase(0, mark.size());
  while (!line.empty() && line.back() == '\r')
    line.pop_back();
}

/// Reads a statement, which continues on the next line after a backslash; counts lines. Returns
/// false at the end.
bool read_statement(std::istream &text, const std::string &name, std::string &line, unsigned int &number) {
  if (!std::getline(text, line))
    return false;
  ++number;
  clean_line(line, number == 1, name + ":1");
  std::string next;
  while (!trim(line).empty() && trim(line).back() == '\\' && std::getline(text, next)) {
    line = trim(line);
    line.pop_back();
    line += " " + trim(next);
    ++number;
  }
  return true;
}

/// Replaces control characters by blanks, since messages quote a statement. Returns what is wrong
/// with the first one that is no tab, or nothing.
std::string remove_control_characters(std::string &statement) {
  std::string error;
  for (char &c : statement) {
    const auto code = static_cast<unsigned char>(c);
    if (code >= ' ' && code != 0x7F)
      continue;
    if (error.empty() && c != '\t')
      error = ": a control character, of code " + std::to_string(code) +
              ", stands in the statement; allowed is text. Write the line anew";
    c = ' ';
  }
  statement = trim(statement);
  return error;
}

std::string single_spaced(const std::string &text);

/// Returns a statement "Name/Name/Key = value" without its path, and appends this to `path`.
std::string take_path(const std::string &statement, SceneFile::Path &path) {
  std::size_t key = 0;
  const std::size_t equals = statement.find('=');
  for (std::size_t slash = statement.find('/'); slash < equals && equals != std::string::npos;
       slash = statement.find('/', key)) {
    path.push_back(single_spaced(trim(statement.substr(key, slash - key))));
    key = slash + 1;
  }
  return statement.substr(key);
}

std::string single_spaced(const std::string &text) {
  std::string result;
  for (const char c : text) {
    const bool blank = c == ' ' || c == '\t';
    if (!(blank && (result.empty() || result.back() == ' ')))
      result += blank ? ' ' : c;
  }
  return result;
}

enum class Keyword { none, include, subsection, set, end };

/// Statement of a file, which may continue over several lines.
struct FileLine {
  std::string line;
  std::string statement; ///< what follows its keyword
  Keyword keyword;
  std::string error; ///< what is wrong with its characters
  unsigned int number;
};

std::vector<FileLine> read_lines(std::istream &text, const std::string &name) {
  std::vector<FileLine> lines;
  std::string line;
  for (unsigned int number = 0, first = 1; read_statement(text, name, line, number); first = number + 1) {
    std::string statement = trim(line.substr(0, line.find('#')));
    const std::string error = remove_control_characters(statement);
    Keyword keyword = Keyword::none;
    if (take_keyword(statement, "include"))
      keyword = Keyword::include;
    else if (take_keyword(statement, "subsection"))
      keyword = Keyword::subsection;
    else if (take_keyword(statement, "set"))
      keyword = Keyword::set;
    else if (statement == "end")
      keyword = Keyword::end;
    lines.push_back({line, statement, keyword, error, first});
  }
  return lines;
}

/// Returns the statements that show the structure of a file.
std::vector<Statement> statements_of(const std::vector<FileLine> &lines) {
  std::vector<Statement> statements;
  for (const FileLine &one : lines) {
    const std::size_t indentation = one.line.find_first_not_of(" \t");
    const std::string name = single_spaced(trim(one.statement.substr(0, one.statement.find('='))));
    if (one.keyword == Keyword::subsection)
      statements.push_back(
          {Statement::Kind::subsection, single_spaced(one.statement), indentation, one.number});
    else if (one.keyword == Keyword::set)
      statements.push_back({Statement::Kind::set, name, indentation, one.number});
    else if (one.keyword == Keyword::end)
      statements.push_back({Statement::Kind::end, "", indentation, one.number});
  }
  return statements;
}

/// End of a message about a value, and the message as data.
struct PatternError {
  std::string text;
  SceneFault fault;
};

/// Returns what ParameterHandler's pattern allows, in plain words.
PatternError describe_pattern(const std::string &message, const std::string &value) {
  using Kind = SceneFault::Kind;
  // The message is "... does not match the given pattern <[Double ...]>."; deal.II breaks it into
  // lines at any blank.
  std::istringstream words(message);
  std::string text, word;
  while (words >> word)
    text += word + ' ';
  const std::string before = "the given pattern <[";
  const auto begin = text.rfind(before);
  const auto end = text.find("]>", begin);
  if (begin == std::string::npos || end == std::string::npos)
    return {"; " + text, {Kind::wrong_value}};
  const std::string pattern = text.substr(begin + before.size(), end - begin - before.size());
  if (pattern.find("List of <[Double") != std::string::npos)
    return {"; allowed is numbers, separated by commas", {Kind::wrong_value}};
  if (pattern.find("List of <[Integer") != std::string::npos)
    return {"; allowed is whole numbers, separated by commas", {Kind::wrong_value}};
  if (pattern.compare(0, 6, "Double") == 0)
    return {"; allowed is a number" + parameters::number_remedy(value), {Kind::wrong_number}};
  if (pattern.compare(0, 7, "Integer") == 0)
    return {"; allowed is a whole number, not negative", {Kind::wrong_value}};
  if (pattern.compare(0, 4, "Bool") == 0)
    return {"; allowed is true or false", {Kind::wrong_value}};
  if (pattern.compare(0, 9, "Selection") != 0)
    return {"; allowed is " + pattern, {Kind::wrong_value}};
  const std::string names = trim(pattern.substr(10));
  const std::vector<std::string> known = dealii::Utilities::split_string_list(names, '|');
  const std::string advice = did_you_mean(value, known);
  return {(advice.empty() ? "; allowed" : advice + " Allowed") +
              " is one of: " + dealii::Utilities::replace_in_string(names, "|", ", "),
          {Kind::wrong_value, nearest_name(value, known)}};
}

} // namespace

std::string join(const SceneFile::Path &path) {
  std::string result;
  for (const auto &name : path)
    result += (result.empty() ? "" : " / ") + name;
  return result;
}

/// Whether an entry is one of the command line without a value, which takes away those of the
/// files.
static bool must_take_away(const SceneFile::Entry &entry) {
  return entry.files.empty() && entry.value.empty();
}

bool SceneFile::Entry::overrides(const Entry &other) const {
  return files.size() < other.files.size() && std::equal(files.begin(), files.end(), other.files.begin());
}

SceneFile SceneFile::read(const std::string &file_name, const std::vector<Setting> &settings) {
  std::ifstream stream(file_name);
  if (!stream || std::filesystem::is_directory(file_name))
    throw InputError(file_name + ": the program cannot read the scene file. Check its name");
  SceneFile file;
  file.file_name_ = file_name;
  Path path;
  file.scan_file(stream, file_name, path, {});
  for (const Setting &setting : settings)
    file.add_setting(setting);
  file.resolve_overrides();
  file.note_parts_of_no_file();
  return file;
}

SceneFile SceneFile::scan(std::istream &text, const std::string &name) {
  SceneFile file;
  file.file_name_ = name;
  Path path;
  file.scan_file(text, name, path, {});
  file.resolve_overrides();
  file.require_sound();
  return file;
}

void SceneFile::require_sound() const {
  if (!errors_.empty())
    throw InputError(errors_);
}

void SceneFile::fail(const std::string &error) {
  note(error);
  throw InputError(errors_);
}

void SceneFile::note(const std::string &error) { errors_.emplace_back(diagnostic::bad_input, error); }

void SceneFile::note_unmatched(const std::string &error) {
  unmatched_.push_back(error);
  note(error);
  constexpr std::size_t max_errors = 20; // a file with more is no scene
  if (unmatched_.size() == max_errors)
    require_sound();
}

void SceneFile::note(const std::string &error, const std::string &where, const Path &path) {
  faulty_.push_back({path, where});
  note(error);
}

void SceneFile::scan_file(std::istream &text, const std::string &name, Path &path,
                          const std::vector<unsigned int> &outer_files) {
  const std::size_t outer = path.size();
  std::vector<unsigned int> files = outer_files;
  files.push_back(n_files_++);
  const std::vector<FileLine> lines = read_lines(text, name);
  const std::vector<EndRepair> repairs = find_end_repairs(statements_of(lines), path);
  const auto is_to = [&repairs](const EndRepair::Kind kind, const unsigned int line) {
    return std::count_if(repairs.begin(), repairs.end(),
                         [&](const EndRepair &one) { return one.kind == kind && one.line == line; });
  };
  std::vector<std::string> opened_at;
  const auto close_unclosed = [&](const std::string &before) {
    note_unmatched(opened_at.back() + ": subsection '" + join(path) + "' has no 'end'" +
                   (files.size() > 1 ? " in this file" : "") + before);
    opened_at.pop_back();
    path.pop_back();
    lines_.emplace_back("end", no_entry);
  };
  for (const auto &[line, statement, keyword, error, number] : lines) {
    const std::string where = name + ":" + std::to_string(number);
    for (auto n = is_to(EndRepair::Kind::insert, number); n > 0; --n)
      close_unclosed("; it is probably missing before line " + std::to_string(number));
    if (!error.empty())
      note(where + error, where, path);
    if (keyword == Keyword::include) {
      include(statement, where, name, path, files);
      continue;
    }
    lines_.emplace_back(line, no_entry);
    if (keyword == Keyword::subsection) {
      if (statement.empty())
        fail(where + ": 'subsection' needs a name");
      if (path.size() >= max_nesting)
        fail(where + ": subsections are nested more than " + std::to_string(max_nesting) +
             " deep; an 'end' is probably missing");
      path.push_back(single_spaced(statement));
      subsections_.push_back({path, where, files.size()});
      opened_at.push_back(where);
    } else if (keyword == Keyword::set) {
      Path target = path; // of 'set Bodies/block/Material/Density = 1'
      const std::string setting = take_path(statement, target);
      add_entry(setting, target,
                {target, "", "", where, "", "", number, files.size() > 1, files, folder_of(name)});
    } else if (keyword == Keyword::end) {
      if (opened_at.empty() || is_to(EndRepair::Kind::ignore, number) > 0) {
        lines_.back().first = "# " + line;
        note_unmatched(where + (opened_at.empty() ? ": 'end' closes no subsection"
                                                  : ": 'end' is probably one too many; it would close '" +
                                                        join(path) + "', which goes on"));
      } else {
        opened_at.pop_back();
        path.pop_back();
      }
    } else if (!statement.empty())
      note(where + ": the statement is '" + statement +
               "'; allowed are 'set', 'subsection', 'end', 'include' and comments after '#'",
           where, path);
  }
  while (path.size() > outer)
    close_unclosed("");
}

namespace {

/// Returns what to do where no file of materials has this name.
std::string advise_on_material(const std::string &name) {
  std::vector<std::string> known;
  std::error_code ignored;
  for (const auto &entry :
       std::filesystem::directory_iterator(find_shipped({"share/billet/materials", "materials"}), ignored))
    known.push_back("materials/" + entry.path().filename().string());
  return did_you_mean(name, known) + "; 'billet --list materials' names those of the program";
}

} // namespace

void SceneFile::include(const std::string &statement, const std::string &where, const std::string &name,
                        Path &path, const std::vector<unsigned int> &files) {
  if (statement.empty())
    fail(where + ": 'include' needs the name of a file");
  constexpr std::size_t max_depth = 20;
  if (files.size() > max_depth)
    fail(where + ": files include each other in a cycle");
  std::string included = statement.front() == '/' ? statement : folder_of(name) + statement;
  const std::string materials = "materials/"; // of the program, unless the scene has its own
  if (statement.compare(0, materials.size(), materials) == 0 && !std::filesystem::exists(included)) {
    const std::string shipped = find_shipped({"share/billet/" + statement, statement});
    included = shipped.empty() ? included : shipped;
  }
  std::ifstream stream(included);
  if (!stream || std::filesystem::is_directory(included))
    fail(where + ": the included file '" + included + "' cannot be read" +
         (statement.compare(0, materials.size(), materials) == 0 ? advise_on_material(statement) : ""));
  scan_file(stream, included, path, files);
}

void SceneFile::add_entry(const std::string &statement, const Path &path, Entry entry) {
  const auto equals = statement.find('=');
  if (equals == std::string::npos)
    return note(entry.where + ": the statement is 'set " + statement +
                    "'; allowed is 'set parameter = value'",
                entry.where, path);
  entry.written_key = single_spaced(trim(statement.substr(0, equals)));
  entry.written_value = trim(statement.substr(equals + 1));
  const CurrentNames names = current_names(path, entry.written_key, entry.written_value);
  entry.key = names.key;
  entry.value = names.value;
  lines_.back().second = entries_.size();
  entries_.push_back(std::move(entry));
}

void SceneFile::add_setting(const Setting &setting) {
  Path path;
  for (const auto &name : dealii::Utilities::split_string_list(setting.path, '/'))
    path.push_back(single_spaced(trim(name)));
  const std::string key = path.empty() ? "" : path.back();
  if (std::count(path.begin(), path.end(), "") > 0 || key.empty())
    return note(setting.where + ": the path is '" + setting.path +
                "'; allowed are names of subsections and of a parameter, such as 'Time stepping/End time'");
  path.pop_back();
  std::string indentation;
  lines_.emplace_back("# command line: " + setting.where, no_entry);
  for (const auto &name : path) {
    lines_.emplace_back(indentation + "subsection " + name, no_entry);
    indentation += "  ";
  }
  lines_.emplace_back(indentation + "set " + key + " = " + setting.value, no_entry);
  add_entry(key + " = " + setting.value, path, {path, "", "", setting.where, "", "", 0, true, {}, ""});
  for (std::size_t i = path.size(); i > 0; --i)
    lines_.emplace_back(std::string(2 * (i - 1), ' ') + "end", no_entry);
}

void SceneFile::resolve_overrides() {
  const auto is_same = [](const Entry &a, const Entry &b) { return a.key == b.key && a.path == b.path; };
  std::vector<std::string> overridden_at(entries_.size());
  // An entry without a value takes the place of another for the default.
  const auto take_place = [&](const std::size_t taken, const std::size_t by) {
    overridden_at[taken] = entries_[by].where;
    if (entries_[by].value.empty() && !must_take_away(entries_[by]))
      overridden_at[by] = entries_[by].where;
  };
  for (std::size_t i = 0; i < entries_.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (is_same(entries_[i], entries_[j])) {
        if (entries_[i].overrides(entries_[j]))
          take_place(j, i);
        else if (entries_[j].overrides(entries_[i]))
          take_place(i, j);
      }
  for (std::size_t i = 0; i < entries_.size(); ++i)
    if (must_take_away(entries_[i])) {
      if (std::find(overridden_at.begin(), overridden_at.end(), entries_[i].where) == overridden_at.end())
        note(entries_[i].where + ": the scene does not set '" + entries_[i].key + "'" +
             (entries_[i].path.empty() ? "" : " in '" + join(entries_[i].path) + "'") +
             "; allowed are a value, and no value where the scene has one that is to be taken away");
      overridden_at[i] = entries_[i].where;
    }
  std::vector<Entry> kept;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (!overridden_at[i].empty())
      continue;
    const auto first = std::find_if(kept.begin(), kept.end(),
                                    [&](const Entry &entry) { return is_same(entry, entries_[i]); });
    if (first == kept.end())
      kept.push_back(entries_[i]);
    else
      note(describe_second(entries_[i], *first), entries_[i].where, entries_[i].path);
  }
  for (const auto &[line, entry] : lines_)
    text_ += entry != no_entry && !overridden_at[entry].empty()
                 ? "# " + line + " (overridden by " + overridden_at[entry] + ")\n"
                 : line + "\n";
  entries_ = std::move(kept);
  lines_.clear();
}

void SceneFile::note_parts_of_no_file() {
  struct List {
    std::string name, of_one;
    std::vector<std::string> needs; ///< subsections and parameters of a new one
  };
  const std::vector<List> lists{{"Bodies", "body", {"Mesh", "Material"}},
                                {"Tools", "tool", {"Surfaces"}},
                                {"Contact pairs", "pair", {"Body"}}};
  for (const auto &[list, of_one, needs] : lists) {
    std::size_t n_files = 1; // of the parts that stand deepest
    for (const Subsection &one : subsections_)
      if (one.path.size() == 2 && one.path[0] == list)
        n_files = std::max(n_files, one.n_files);
    std::vector<std::string> known;
    std::string all, needed;
    for (const Subsection &one : subsections_)
      if (one.path.size() == 2 && one.path[0] == list && one.n_files == n_files) {
        known.push_back(one.path[1]);
        all += known.back() + ", ";
      }
    for (const std::string &name : needs)
      needed += (needed.empty() ? "'" : " and '") + name + "'";
    for (const std::string &name : names_below({list})) {
      const bool is_whole = std::all_of(needs.begin(), needs.end(), [&](const std::string &need) {
        return is_set({list, name}, need) || first_entry({list, name, need}) != nullptr ||
               !names_below({list, name, need}).empty();
      });
      if (is_whole || std::find(known.begin(), known.end(), name) != known.end())
        continue;
      const std::string advice = did_you_mean(name, known);
      errors_.push_back(scene_error(where(Path{list, name}) + ": no included file has the " + of_one + " '" +
                                        name + "'" + (advice.empty() ? "; allowed" : advice + " Allowed") +
                                        " are: " + all + "and a new " + of_one + " with " + needed,
                                    {SceneFault::Kind::unknown_name, nearest_name(name, known)}));
    }
  }
}

namespace {

/// Returns the text between the first quotes at or after a place; empty if there are none.
std::string quoted(const std::string &text, const std::size_t from) {
  const std::size_t begin = text.find('\'', from);
  const std::size_t end = begin == std::string::npos ? begin : text.find('\'', begin + 1);
  return end == std::string::npos ? "" : text.substr(begin + 1, end - begin - 1);
}

/// Returns the path whose join() this is.
SceneFile::Path split(const std::string &joined) {
  SceneFile::Path path;
  const std::string separator = " / ";
  for (std::size_t begin = 0; !joined.empty();) {
    const std::size_t end = joined.find(separator, begin);
    path.push_back(joined.substr(begin, end - begin));
    if (end == std::string::npos)
      break;
    begin = end + separator.size();
  }
  return path;
}

} // namespace

std::optional<SceneFile::Place> SceneFile::find_place(const std::string &message) const {
  if (std::find(unmatched_.begin(), unmatched_.end(), message) != unmatched_.end())
    return {}; // the subsection itself is sound
  const std::string of_default = " (default): '";
  if (const std::size_t found = message.find(of_default); found != std::string::npos) {
    // "file:line (default): 'Key' in 'Bodies / block'"
    const std::size_t key = found + of_default.size() - 1;
    const std::string name = quoted(message, key), in = "' in '";
    const std::size_t behind = key + 1 + name.size();
    return Place{message.compare(behind, in.size(), in) == 0 ? split(quoted(message, behind + 1)) : Path(),
                 name, true};
  }
  const auto begins_at = [&message](const std::string &where) {
    return message.compare(0, where.size(), where) == 0 && message[where.size()] == ':';
  };
  for (const Entry &entry : entries_)
    if (begins_at(entry.where))
      return Place{entry.path, entry.key};
  for (const auto *list : {&faulty_, &subsections_})
    for (const Subsection &subsection : *list)
      if (begins_at(subsection.where))
        return Place{subsection.path, "", true};
  return {};
}

bool SceneFile::remove(const Path &path, const std::string &key) {
  const std::size_t before = entries_.size() + subsections_.size();
  const auto is_below = [&path](const Path &other) {
    return other.size() >= path.size() && std::equal(path.begin(), path.end(), other.begin());
  };
  const auto erase_if = [](auto &list, const auto &goes) {
    list.erase(std::remove_if(list.begin(), list.end(), goes), list.end());
  };
  erase_if(entries_, [&](const Entry &entry) {
    return key.empty() ? is_below(entry.path) : entry.path == path && entry.key == key;
  });
  if (key.empty())
    erase_if(subsections_, [&](const Subsection &subsection) { return is_below(subsection.path); });
  return entries_.size() + subsections_.size() < before;
}

const SceneFile::Entry *SceneFile::find(const Path &path, const std::string &key) const {
  const auto entry = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry &e) { return e.key == key && e.path == path; });
  return entry == entries_.end() ? nullptr : &*entry;
}

std::vector<std::string> SceneFile::names_below(const Path &path) const {
  std::vector<std::string> names;
  for (const auto &subsection : subsections_)
    if (subsection.path.size() == path.size() + 1 &&
        std::equal(path.begin(), path.end(), subsection.path.begin()) &&
        std::find(names.begin(), names.end(), subsection.path.back()) == names.end())
      names.push_back(subsection.path.back());
  return names;
}

const SceneFile::Entry *SceneFile::first_entry(const Path &path) const {
  const auto entry =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry &e) { return e.path == path; });
  return entry == entries_.end() ? nullptr : &*entry;
}

std::string SceneFile::where(const Path &path, const std::string &key) const {
  const Entry *entry = find(path, key);
  return entry != nullptr ? entry->where : where(path) + " (default)";
}

std::string SceneFile::value(const Path &path, const std::string &key, const std::string &otherwise) const {
  const Entry *entry = find(path, key);
  return entry != nullptr ? entry->value : otherwise;
}

void SceneFile::add_subsection(const Path &path, const std::string &where) {
  subsections_.push_back({path, where});
}

void SceneFile::add_entry(const Path &path, const std::string &key, const std::string &value,
                          const std::string &where) {
  entries_.push_back({path, key, value, where, key, value, 0, false, {}, folder_of(file_name_)});
}

void SceneFile::copy_entry(const Entry &entry, const Path &path) {
  Entry copy = entry;
  copy.path = path;
  copy.written_key = copy.key; // the entry itself warns of old names
  copy.written_value = copy.value;
  copy.source = entry.path;
  entries_.push_back(std::move(copy));
}

const SceneFile::Path &SceneFile::written_path(const Path &path, const std::string &key) const {
  const Entry *entry = find(path, key);
  return entry == nullptr || entry->source.empty() ? path : entry->source;
}

bool SceneFile::is_set(const Path &path, const std::string &key) const { return find(path, key) != nullptr; }

std::string SceneFile::where(const Path &path) const {
  for (const auto &subsection : subsections_)
    if (subsection.path == path)
      return subsection.where;
  return file_name_;
}

std::vector<SceneFile::Path> SceneFile::paths() const {
  std::vector<Path> paths;
  for (const auto &subsection : subsections_)
    paths.push_back(subsection.path);
  return paths;
}

std::string SceneFile::resolve(const Path &path, const std::string &key, const std::string &name) const {
  if (name.empty() || name.front() == '/')
    return name;
  const Entry *entry = find(path, key);
  const std::string beside_scene = folder_of(file_name_) + name;
  if (entry == nullptr || entry->folder == folder_of(file_name_))
    return beside_scene;
  const std::string beside_entry = entry->folder + name;
  std::error_code error;
  return !std::filesystem::exists(beside_scene, error) && std::filesystem::exists(beside_entry, error)
             ? beside_entry
             : beside_scene;
}

namespace {

/// Entries that ParameterHandler knows, from its own print-out.
class Declared {
public:
  explicit Declared(const dealii::ParameterHandler &prm) {
    std::ostringstream printed;
    prm.print_parameters(printed, dealii::ParameterHandler::ShortPRM);
    std::istringstream text(printed.str());
    all_ = SceneFile::scan(text, "");
  }

  std::vector<std::string> subsections(const SceneFile::Path &path) const { return all_.names_below(path); }

  std::vector<std::string> parameters(const SceneFile::Path &path) const {
    std::vector<std::string> names;
    for (const auto &entry : all_.entries())
      if (entry.path == path)
        names.push_back(entry.key);
    return names;
  }

  /// Returns the end of a message about an unknown name: the nearest known one, and all that are
  /// known.
  std::string advice(const std::string &nearest, const std::string &here, const SceneFile::Path &path) const {
    std::string list;
    for (const auto &name : parameters(path))
      list += (list.empty() ? "" : ", ") + name;
    for (const auto &name : subsections(path))
      list += (list.empty() ? "subsection " : ", subsection ") + name;
    return nearest.empty() ? "; allowed " + here + " are: " + list
                           : nearest + " Allowed " + here + " are: " + list;
  }

  /// Returns "; 'Key' belongs to 'Path'." if one other subsection alone has such a parameter.
  std::string other_place(const std::string &key) const {
    const SceneFile::Entry *found = nullptr;
    for (const auto &entry : all_.entries())
      if (entry.key == key) {
        if (found != nullptr)
          return "";
        found = &entry;
      }
    return found == nullptr      ? ""
           : found->path.empty() ? "; '" + key + "' belongs to the top level."
                                 : "; '" + key + "' belongs to '" + join(found->path) + "'.";
  }

private:
  SceneFile all_;
};

struct SetResult {
  bool is_declared = true;
  std::optional<PatternError> error; ///< none: the value is allowed
};

SetResult try_to_set(dealii::ParameterHandler &prm, const SceneFile::Entry &entry) {
  SetResult result;
  for (const auto &name : entry.path)
    prm.enter_subsection(name);
  try {
    prm.set(entry.key, entry.value);
  } catch (const dealii::ParameterHandler::ExcEntryUndeclared &) {
    result.is_declared = false;
  } catch (const dealii::ParameterHandler::ExcValueDoesNotMatchPattern &error) {
    result.error = describe_pattern(error.what(), entry.value);
  }
  for (std::size_t i = 0; i < entry.path.size(); ++i)
    prm.leave_subsection();
  return result;
}

} // namespace

void SceneFile::set_all(dealii::ParameterHandler &prm) const {
  DiagnosticList errors = errors_;
  const auto add = [&errors](const std::string &error, const SceneFault &fault) {
    errors.push_back(scene_error(error, fault));
  };
  const auto unknown_name = [](const std::string &name, const std::vector<std::string> &known) {
    return SceneFault{SceneFault::Kind::unknown_name, nearest_name(name, known)};
  };
  std::vector<Path> unknown;
  const auto refuse_subsection = [&](const Path &path, const std::string &where) {
    const Path above(path.begin(), path.end() - 1);
    if (!above.empty() && !prm.subsection_path_exists(above)) // one message for what is in it
      return;
    const Declared declared(prm);
    if (std::find(unknown.begin(), unknown.end(), path) == unknown.end())
      add(where + ": there is no subsection '" + join(path) + "'" +
              declared.advice(did_you_mean(path.back(), declared.subsections(above)),
                              above.empty() ? "at the top level" : "in '" + join(above) + "'", above),
          unknown_name(path.back(), declared.subsections(above)));
    unknown.push_back(path);
  };
  for (const auto &subsection : subsections_)
    if (!prm.subsection_path_exists(subsection.path))
      refuse_subsection(subsection.path, subsection.where);

  const auto has_unknown_shape = [&](const Path &path) {
    const Entry *shape = find(path, "Shape");
    return shape != nullptr && try_to_set(prm, *shape).error.has_value();
  };
  for (const auto &entry : entries_) {
    if (!entry.path.empty() && !prm.subsection_path_exists(entry.path)) {
      for (std::size_t n = 1; n <= entry.path.size(); ++n) { // a path of names opens no subsections
        const Path part(entry.path.begin(), entry.path.begin() + static_cast<std::ptrdiff_t>(n));
        if (!prm.subsection_path_exists(part)) {
          refuse_subsection(part, entry.where);
          break;
        }
      }
      continue;
    }
    const auto [is_declared, error] = try_to_set(prm, entry);
    if (!entry.source.empty()) // what is wrong with it is told of the entry that it copies
      continue;
    const std::string place = entry.path.empty() ? "" : " in '" + join(entry.path) + "'";
    if (!is_declared && has_unknown_shape(entry.path))
      continue; // the shape decides which parameters there are
    if (!is_declared) {
      const Declared declared(prm);
      const std::string near = did_you_mean(entry.key, declared.parameters(entry.path));
      add(entry.where + ": there is no parameter '" + entry.key + "'" + place +
              declared.advice(near.empty() ? declared.other_place(entry.key) : near, "here", entry.path),
          unknown_name(entry.key, declared.parameters(entry.path)));
    } else if (error)
      add(entry.where + ": '" + entry.key + "'" + place + " is '" + entry.value + "'" + error->text,
          error->fault);
  }
  if (!errors.empty())
    throw InputError(errors);
}

} // namespace billet
