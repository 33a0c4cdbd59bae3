// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/scene_file.h"

#include "billet/errors.h"
#include "billet/parameters/number_text.h"
#include "billet/parameters/renames.h"

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace billet {

namespace {

using dealii::Utilities::trim;

std::string folder_of(const std::string &file_name) {
  const auto slash = file_name.rfind('/');
  return slash == std::string::npos ? "" : file_name.substr(0, slash + 1);
}

/// Removes the keyword from the start of `line`. Returns false if `line` does not start with it, followed by
/// a blank or nothing.
bool take_keyword(std::string &line, const std::string &keyword) {
  if (line.compare(0, keyword.size(), keyword) != 0 ||
      (line.size() > keyword.size() && line[keyword.size()] != ' ' && line[keyword.size()] != '\t'))
    return false;
  line = trim(line.substr(keyword.size()));
  return true;
}

[[noreturn]] void refuse_second(const SceneFile::Entry &entry, const SceneFile::Entry &first) {
  if (entry.written_key != first.written_key)
    throw InputError(entry.where + ": '" + entry.written_key + "' is the same parameter as '" +
                     first.written_key + "' at " + first.where + "; allowed is '" + entry.key + "' alone");
  throw InputError(entry.where + ": '" + entry.written_key + "' is set twice, first at " + first.where);
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

/// Returns a description of a ParameterHandler pattern in plain words.
std::string describe_pattern(const std::string &message) {
  // The message is "... does not match the given pattern <[Double ...]>."; deal.II breaks it into lines at
  // any blank.
  std::istringstream words(message);
  std::string text, word;
  while (words >> word)
    text += word + ' ';
  const std::string before = "the given pattern <[";
  const auto begin = text.rfind(before);
  const auto end = text.find("]>", begin);
  if (begin == std::string::npos || end == std::string::npos)
    return text;
  std::string pattern = text.substr(begin + before.size(), end - begin - before.size());
  if (pattern.find("List of <[Double") != std::string::npos)
    return "numbers, separated by commas";
  if (pattern.find("List of <[Integer") != std::string::npos)
    return "whole numbers, separated by commas";
  if (pattern.compare(0, 6, "Double") == 0)
    return "a number";
  if (pattern.compare(0, 7, "Integer") == 0)
    return "a whole number, not negative";
  if (pattern.compare(0, 4, "Bool") == 0)
    return "true or false";
  if (pattern.compare(0, 9, "Selection") == 0)
    return "one of: " + dealii::Utilities::replace_in_string(trim(pattern.substr(10)), "|", ", ");
  return pattern;
}

} // namespace

std::string join(const SceneFile::Path &path) {
  std::string result;
  for (const auto &name : path)
    result += (result.empty() ? "" : " / ") + name;
  return result;
}

SceneFile SceneFile::read(const std::string &file_name) {
  std::ifstream stream(file_name);
  if (!stream || std::filesystem::is_directory(file_name))
    throw InputError(file_name + ": the program cannot read the scene file. Check its name");
  return scan(stream, file_name);
}

SceneFile SceneFile::scan(std::istream &text, const std::string &name) {
  SceneFile file;
  file.file_name_ = name;
  Path path;
  file.scan_file(text, name, path, 0);
  if (!path.empty())
    throw InputError(file.last_opened(path) + ": subsection '" + join(path) + "' has no 'end'");
  return file;
}

void SceneFile::scan_file(std::istream &text, const std::string &name, Path &path, const unsigned int depth) {
  const std::size_t outer_depth = path.size();
  std::string line;
  for (unsigned int number = 1; std::getline(text, line); ++number) {
    const unsigned int first_line = number;
    const std::string where = name + ":" + std::to_string(number);
    std::string next;
    while (!trim(line).empty() && trim(line).back() == '\\' && std::getline(text, next)) {
      line = trim(line);
      line.pop_back();
      line += " " + trim(next);
      ++number;
    }
    std::string statement = trim(line.substr(0, line.find('#')));
    if (take_keyword(statement, "include")) {
      if (statement.empty())
        throw InputError(where + ": 'include' needs the name of a file");
      if (depth == 20)
        throw InputError(where + ": files include each other in a cycle");
      const std::string included = statement.front() == '/' ? statement : folder_of(name) + statement;
      std::ifstream stream(included);
      if (!stream || std::filesystem::is_directory(included))
        throw InputError(where + ": the included file '" + included + "' cannot be read");
      scan_file(stream, included, path, depth + 1);
      continue;
    }
    text_ += line + "\n";
    if (statement.empty())
      continue;
    if (take_keyword(statement, "subsection")) {
      if (statement.empty())
        throw InputError(where + ": 'subsection' needs a name");
      path.push_back(single_spaced(statement));
      subsections_.push_back({path, where});
    } else if (take_keyword(statement, "set")) {
      const auto equals = statement.find('=');
      if (equals == std::string::npos)
        throw InputError(where + ": the statement is 'set " + statement +
                         "'; allowed is 'set parameter = value'");
      const std::string key = single_spaced(trim(statement.substr(0, equals))),
                        value = trim(statement.substr(equals + 1));
      const CurrentNames names = current_names(path, key, value);
      const Entry entry{path, names.key, names.value, where, key, value, first_line, depth > 0};
      if (const Entry *first = find(path, entry.key))
        refuse_second(entry, *first);
      entries_.push_back(entry);
    } else if (statement == "end") {
      if (path.size() == outer_depth)
        throw InputError(where + ": 'end' closes no subsection");
      path.pop_back();
    } else
      throw InputError(where + ": the statement is '" + statement +
                       "'; allowed are 'set', 'subsection', 'end', 'include' and comments after '#'");
  }
  if (depth > 0 && path.size() != outer_depth)
    throw InputError(last_opened(path) + ": subsection '" + join(path) + "' has no 'end' in this file");
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

bool SceneFile::is_set(const Path &path, const std::string &key) const { return find(path, key) != nullptr; }

std::string SceneFile::where(const Path &path) const {
  for (const auto &subsection : subsections_)
    if (subsection.path == path)
      return subsection.where;
  return file_name_;
}

std::string SceneFile::last_opened(const Path &path) const {
  const auto last = std::find_if(subsections_.rbegin(), subsections_.rend(),
                                 [&](const Subsection &subsection) { return subsection.path == path; });
  return last->where;
}

std::string SceneFile::folder() const { return folder_of(file_name_); }

void SceneFile::set_all(dealii::ParameterHandler &prm) const {
  using dealii::ParameterHandler;
  // Returns what is allowed below a path, from ParameterHandler's own print-out.
  const auto known = [&prm](const Path &path) {
    std::ostringstream printed;
    prm.print_parameters(printed, ParameterHandler::ShortPRM);
    std::istringstream text(printed.str());
    const SceneFile all = SceneFile::scan(text, "");
    std::string list;
    for (const auto &entry : all.entries_)
      if (entry.path == path)
        list += (list.empty() ? "" : ", ") + entry.key;
    for (const auto &name : all.names_below(path))
      list += (list.empty() ? "subsection " : ", subsection ") + name;
    return list;
  };

  for (const auto &subsection : subsections_)
    if (!prm.subsection_path_exists(subsection.path)) {
      const Path above(subsection.path.begin(), subsection.path.end() - 1);
      throw InputError(subsection.where + ": there is no subsection '" + join(subsection.path) +
                       "'; allowed " + (above.empty() ? "at the top level" : "in '" + join(above) + "'") +
                       " are: " + known(above));
    }

  for (const auto &entry : entries_) {
    for (const auto &name : entry.path)
      prm.enter_subsection(name);
    const auto leave = [&] {
      for (std::size_t i = 0; i < entry.path.size(); ++i)
        prm.leave_subsection();
    };
    const std::string place = entry.path.empty() ? "" : " in '" + join(entry.path) + "'";
    try {
      prm.set(entry.key, entry.value);
    } catch (const ParameterHandler::ExcEntryUndeclared &) {
      leave();
      throw InputError(entry.where + ": there is no parameter '" + entry.key + "'" + place +
                       "; allowed here are: " + known(entry.path));
    } catch (const ParameterHandler::ExcValueDoesNotMatchPattern &error) {
      leave();
      const std::string allowed = describe_pattern(error.what());
      throw InputError(entry.where + ": '" + entry.key + "'" + place + " is '" + entry.value +
                       "'; allowed is " + allowed +
                       (allowed == "a number" ? parameters::number_remedy(entry.value) : ""));
    }
    leave();
  }
}

} // namespace billet
