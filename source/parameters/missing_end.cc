// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/missing_end.h"

#include "billet/parameters/declaration.h"

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <sstream>

namespace billet {

namespace {

using Path = SceneFile::Path;

enum class Match { none, placeholder, literal };

/// Compares a path with one in which names such as "(name of a body)" stand for any.
Match compare(const Path &pattern, const Path &path) {
  if (pattern.size() != path.size())
    return Match::none;
  Match match = Match::literal;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const bool is_placeholder = pattern[i].front() == '(';
    if (!is_placeholder && pattern[i] != path[i])
      return Match::none;
    match = is_placeholder ? Match::placeholder : Match::literal;
  }
  return match;
}

/// All subsections and parameters that a scene may have.
class KnownNames {
public:
  KnownNames() {
    dealii::ParameterHandler prm;
    parameters::declare_every_parameter(prm);
    std::ostringstream printed;
    prm.print_parameters(printed, dealii::ParameterHandler::ShortPRM);
    std::istringstream text(printed.str());
    const SceneFile all = SceneFile::scan(text, "");
    subsections_ = all.paths();
    for (const auto &entry : all.entries()) {
      parameters_.push_back(entry.path);
      parameters_.back().push_back(entry.key);
    }
  }

  /// Returns how well a statement fits into the subsection `path`.
  Match match(const Statement &statement, Path path) const {
    const bool is_set = statement.kind == Statement::Kind::set;
    path.push_back(statement.name);
    Match best = Match::none;
    for (const Path &pattern : is_set ? parameters_ : subsections_)
      best = std::max(best, compare(pattern, path));
    return best;
  }

private:
  std::vector<Path> subsections_, parameters_;
};

struct Open {
  std::string name;
  std::size_t indentation;
  unsigned int line;
};

/// Returns how many of the open subsections should have been closed before this statement, by its name.
std::size_t count_by_name(const KnownNames &known, const Statement &statement, const Path &path,
                          const std::size_t n_open) {
  if (known.match(statement, path) == Match::literal)
    return 0;
  for (std::size_t n = 1; n <= n_open; ++n)
    if (known.match(statement, Path(path.begin(), path.end() - static_cast<std::ptrdiff_t>(n))) ==
        Match::literal)
      return n;
  return 0;
}

/// Returns how many of the open subsections should have been closed before this `end`, by its indentation.
std::size_t count_by_indentation(const Statement &statement, const std::vector<Open> &open) {
  for (std::size_t n = 0; n < open.size(); ++n)
    if (open[open.size() - 1 - n].indentation == statement.indentation)
      return n;
  return 0;
}

} // namespace

MissingEnd find_missing_end(const std::vector<Statement> &statements, const Path &outer) {
  const KnownNames known;
  const auto count = [&](const Statement::Kind kind) {
    return std::count_if(statements.begin(), statements.end(),
                         [&](const Statement &statement) { return statement.kind == kind; });
  };
  // More cannot be unclosed anywhere.
  const auto n_missing =
      static_cast<std::size_t>(count(Statement::Kind::subsection) - count(Statement::Kind::end));
  std::vector<Open> open;
  Path path = outer;
  for (const Statement &statement : statements) {
    if (open.empty() && statement.kind == Statement::Kind::end)
      continue;
    const std::size_t n_unclosed = statement.kind == Statement::Kind::end
                                       ? count_by_indentation(statement, open)
                                       : count_by_name(known, statement, path, open.size());
    if (n_unclosed > 0 && n_unclosed <= n_missing)
      return {path, open.back().line, statement.line};
    if (statement.kind == Statement::Kind::subsection) {
      open.push_back({statement.name, statement.indentation, statement.line});
      path.push_back(statement.name);
    } else if (statement.kind == Statement::Kind::end) {
      open.pop_back();
      path.pop_back();
    }
  }
  return {path, open.empty() ? 0 : open.back().line, 0};
}

} // namespace billet
