// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/unmatched_ends.h"

#include "billet/parameters/declaration.h"
#include "billet/parameters/renames.h"

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <sstream>
#include <utility>

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
    path.push_back(is_set ? current_names(path, statement.name, "").key : statement.name);
    Match best = Match::none;
    for (const Path &pattern : is_set ? parameters_ : subsections_)
      best = std::max(best, compare(pattern, path));
    return best;
  }

private:
  std::vector<Path> subsections_, parameters_;
};

/// Subsections that are open.
class Open {
public:
  Open(const KnownNames &known, Path outer) : known_(&known), path_(std::move(outer)) {}

  const Statement &innermost() const { return *statements_.back(); }

  void open(const Statement &statement) {
    statements_.push_back(&statement);
    path_.push_back(statement.name);
  }
  void close() {
    statements_.pop_back();
    path_.pop_back();
  }

  /// Returns how well a statement fits in after `n` subsections are closed.
  Match match(const Statement &statement, const std::size_t n = 0) const {
    return known_->match(statement, Path(path_.begin(), path_.end() - static_cast<std::ptrdiff_t>(n)));
  }

  /// Returns how many subsections should have been closed before this statement.
  std::size_t count_unclosed(const Statement &statement) const {
    return statement.kind == Statement::Kind::end ? count_by_indentation(statement)
                                                  : count_by_name(statement);
  }

private:
  const Statement &opened(const std::size_t n) const { return *statements_[statements_.size() - 1 - n]; }

  std::size_t count_by_indentation(const Statement &end) const {
    for (std::size_t n = 0; n < statements_.size(); ++n)
      if (opened(n).indentation == end.indentation)
        return n;
    return 0;
  }

  std::size_t count_by_name(const Statement &statement) const {
    const Match here = match(statement);
    if (here == Match::literal)
      return 0;
    for (std::size_t n = 1; n <= statements_.size(); ++n) {
      const Match above = match(statement, n);
      const bool stands_beside = opened(n - 1).indentation == statement.indentation;
      if (above == Match::literal || (above == Match::placeholder && here == Match::none && stands_beside))
        return n;
    }
    return 0;
  }

  const KnownNames *known_;
  std::vector<const Statement *> statements_;
  Path path_;
};

/// Statements of a file, which repairs balance step by step.
class Balance {
public:
  Balance(std::vector<Statement> statements, Path outer)
      : statements_(std::move(statements)), outer_(std::move(outer)) {}

  /// Makes the next repair; returns none if nothing shows where one belongs, or all is balanced.
  std::optional<EndRepair> repair(const KnownNames &known) {
    const auto [n_open, surplus] = count();
    if (surplus < statements_.size())
      return ignore_one(known, surplus);
    return n_open > 0 ? insert_one(known, n_open) : std::nullopt;
  }

  /// Whether subsections are nested too deeply, for which the scan refuses the file.
  bool is_too_deep() const {
    std::ptrdiff_t depth = 0;
    return std::any_of(statements_.begin(), statements_.end(), [&depth](const Statement &statement) {
      depth += statement.kind == Statement::Kind::subsection ? 1 : 0;
      depth -= statement.kind == Statement::Kind::end ? 1 : 0;
      return depth > static_cast<std::ptrdiff_t>(max_nesting);
    });
  }

  bool is_balanced() const {
    const auto [n_open, surplus] = count();
    return n_open == 0 && surplus == statements_.size();
  }

private:
  /// Returns how many subsections are open at the end of the file, and the index of the first `end`
  /// that closes none. If there is none, the index is the number of statements.
  std::pair<std::size_t, std::size_t> count() const {
    std::size_t n_open = 0;
    for (std::size_t i = 0; i < statements_.size(); ++i)
      if (statements_[i].kind == Statement::Kind::subsection)
        ++n_open;
      else if (statements_[i].kind == Statement::Kind::end && n_open-- == 0)
        return {0, i};
    return {n_open, statements_.size()};
  }

  std::optional<EndRepair> insert_one(const KnownNames &known, const std::size_t n_missing) {
    Open open(known, outer_);
    for (std::size_t i = 0; i < statements_.size(); ++i) {
      const Statement &statement = statements_[i];
      const std::size_t n_unclosed = open.count_unclosed(statement);
      if (n_unclosed > 0 && n_unclosed <= n_missing) { // more cannot be unclosed anywhere
        const EndRepair made{EndRepair::Kind::insert, statement.line};
        const Statement end{Statement::Kind::end, "", open.innermost().indentation, statement.line};
        statements_.insert(statements_.begin() + static_cast<std::ptrdiff_t>(i), end);
        return made;
      }
      if (statement.kind == Statement::Kind::subsection)
        open.open(statement);
      else if (statement.kind == Statement::Kind::end)
        open.close();
    }
    return std::nullopt;
  }

  /// Takes away an `end` up to the one at `last`, which closes nothing.
  EndRepair ignore_one(const KnownNames &known, const std::size_t last) {
    Open open(known, outer_), before_ends = open;
    std::size_t n_ends = 0; // directly before the statement
    for (std::size_t i = 0; i < last; ++i) {
      const Statement &statement = statements_[i];
      if (statement.kind == Statement::Kind::end) {
        if (statement.indentation > open.innermost().indentation)
          return ignore(i);
        if (n_ends++ == 0)
          before_ends = open;
        open.close();
        continue;
      }
      for (std::size_t n = 0; n < n_ends; ++n)
        if (open.match(statement) != Match::literal && before_ends.match(statement, n) == Match::literal)
          return ignore(i - 1);
      n_ends = 0;
      if (statement.kind == Statement::Kind::subsection)
        open.open(statement);
    }
    return ignore(last);
  }

  EndRepair ignore(const std::size_t i) {
    const EndRepair made{EndRepair::Kind::ignore, statements_[i].line};
    statements_.erase(statements_.begin() + static_cast<std::ptrdiff_t>(i));
    return made;
  }

  std::vector<Statement> statements_;
  Path outer_;
};

} // namespace

std::vector<EndRepair> find_end_repairs(std::vector<Statement> statements, const Path &outer) {
  Balance balance(std::move(statements), outer);
  std::vector<EndRepair> repairs;
  if (balance.is_balanced() || balance.is_too_deep())
    return repairs;
  const KnownNames known;
  constexpr std::size_t max_repairs = 20;
  while (repairs.size() < max_repairs)
    if (const std::optional<EndRepair> made = balance.repair(known))
      repairs.push_back(*made);
    else
      break;
  return repairs;
}

} // namespace billet
