// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/scene_update.h"

#include "billet/diagnostic_kinds.h"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace billet {

namespace {

using Entry = SceneFile::Entry;

/// Returns "'Key'", or "'Key = value'" if the value was renamed, too.
std::string quote(const Entry &entry, const std::string &key, const std::string &value) {
  return "'" + key + (entry.value != entry.written_value ? " = " + value : "") + "'";
}

std::string old_name(const Entry &entry) { return quote(entry, entry.written_key, entry.written_value); }

std::string new_name(const Entry &entry) { return quote(entry, entry.key, entry.value); }

// Blanks between words; a statement may continue on the next line.
constexpr const char *blanks = " \t\r\n\\";

/// Positions of key, equals sign and value of the statement that begins at `begin`.
struct Places {
  Places(const std::string &text, const std::size_t begin) {
    key = text.find_first_not_of(blanks, text.find_first_not_of(blanks, begin) + std::string("set").size());
    equals = text.find('=', key);
    key_end = text.find_last_not_of(blanks, equals - 1) + 1;
    if (const std::size_t slash = text.rfind('/', key_end); slash != std::string::npos && slash > key)
      key = text.find_first_not_of(blanks, slash + 1); // behind the path
    value = std::min(text.find_first_not_of(blanks, equals + 1), text.size());
    // The value ends at a comment or at a line end without backslash.
    std::size_t end = value;
    while (end < text.size() && text[end] != '#' &&
           !(text[end] == '\n' && text[text.find_last_not_of(" \t\r", end - 1)] != '\\'))
      ++end;
    value_end = text.find_last_not_of(blanks, end - 1) + 1;
  }

  std::size_t key, key_end, equals, value, value_end;
};

std::string line_at(const std::string &text, const std::size_t begin) {
  return text.substr(begin, text.find('\n', begin) - begin);
}

/// Whether the equals sign is in the same column as that of the line before or after.
bool is_in_column(const std::string &text, const std::size_t begin, const std::size_t equals) {
  const auto has_equals_there = [&](const std::size_t line) {
    return line_at(text, line).find('=') == equals - begin;
  };
  const std::size_t next = text.find('\n', equals) + 1;
  return (begin > 1 && has_equals_there(text.rfind('\n', begin - 2) + 1)) ||
         (next != 0 && has_equals_there(next));
}

/// Replaces key and value of the statement in the line that begins at `begin`.
void replace_names(std::string &text, const std::size_t begin, const Entry &entry) {
  const Places places(text, begin);
  if (entry.value != entry.written_value)
    text.replace(places.value, places.value_end - places.value, entry.value);
  const std::size_t gap = places.equals - places.key_end, old_size = places.key_end - places.key,
                    new_size = entry.key.size();
  std::string after_key = text.substr(places.key_end, gap);
  if (gap > 0 && after_key == std::string(gap, ' ') && (gap > 1 || is_in_column(text, begin, places.equals)))
    after_key = std::string(old_size + gap > new_size + 1 ? old_size + gap - new_size : 1, ' ');
  text.replace(places.key, places.equals - places.key, entry.key + after_key);
}

} // namespace

DiagnosticList describe_old_names(const SceneFile &file) {
  DiagnosticList warnings;
  for (const Entry &entry : file.entries())
    if (entry.has_old_name())
      warnings.push_back(
          Diagnostic(diagnostic::old_name,
                     old_name(entry) + " in '" + join(entry.path) + "' is the old name of " + new_name(entry))
              .origin(entry.where)
              .advice("Write " + new_name(entry) + ", or convert the scene by 'billet --update-scene'"));
  return warnings;
}

SceneUpdate update_scene(const std::string &file_name) {
  const SceneFile file = SceneFile::read(file_name);
  file.require_sound();
  SceneUpdate update;
  std::ifstream stream(file_name, std::ios::binary);
  update.text.assign(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  const std::string mark = "\xEF\xBB\xBF"; // byte-order mark
  std::vector<std::size_t> lines = {update.text.compare(0, mark.size(), mark) == 0 ? mark.size() : 0};
  for (std::size_t i = 0; i < update.text.size(); ++i)
    if (update.text[i] == '\n')
      lines.push_back(i + 1);
  // Backwards, so that replacements do not move the lines still to be processed.
  for (auto entry = file.entries().rbegin(); entry != file.entries().rend(); ++entry) {
    if (!entry->has_old_name())
      continue;
    (entry->is_included ? update.left : update.changes)
        .push_back(entry->where + ": " + old_name(*entry) + " is now " + new_name(*entry));
    if (!entry->is_included)
      replace_names(update.text, lines[entry->line - 1], *entry);
  }
  std::reverse(update.changes.begin(), update.changes.end());
  std::reverse(update.left.begin(), update.left.end());
  return update;
}

} // namespace billet
