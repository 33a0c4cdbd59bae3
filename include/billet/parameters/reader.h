// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_READER_H
#define BILLET_PARAMETERS_READER_H

#include "billet/error_notes.h"
#include "billet/parameters/scene_file.h"
#include "billet/registered_type.h"

#include <deal.II/base/tensor.h>

#include <functional>
#include <string>
#include <vector>

namespace billet {

/// Parameter with the place where the user set it, for checks that can only be made later.
template <class T> struct Located {
  T value{};
  /// "file:line: 'Boundary ids' in 'Bodies / billet'", the beginning of a message.
  std::string origin;
};

/// Boundary ids and names of boundaries of one body. The scene adds the ids of the names once it
/// knows the mesh.
struct BoundaryIds : Located<std::vector<unsigned int>> {
  BoundaryIds() = default;
  BoundaryIds(Located<std::vector<unsigned int>> ids) : Located(std::move(ids)) {}

  std::vector<std::string> names; ///< as the scene file has them
  bool are_all = false;           ///< all exterior faces, except those on symmetry planes

  /// Whether the scene file has neither ids nor names.
  bool is_empty() const { return value.empty() && names.empty() && !are_all; }
};

/// Range of input numbers. Powers and products of numbers outside it may leave the range of double.
constexpr double max_number = 1e60, min_number = 1e-60;

/// Returns a whole number from 0 to 999999999, such as a boundary id. Throws std::invalid_argument.
unsigned int parse_count(const std::string &text);

/// Whether a text can be the name of a boundary: it has a letter, and no comma.
bool is_boundary_name(const std::string &text);

/// Reads typed values from a ParameterHandler and knows where each of them was set. Every getter
/// throws InputError with file, line, parameter, the value found and the allowed values.
class Reader : public TypeInput {
public:
  Reader(dealii::ParameterHandler &prm, const SceneFile &file) : prm_(prm), file_(file) {}

  /// Calls `read` inside the subsection `name`. Its errors are noted if they are collected.
  template <class Function> void in(const std::string &name, const Function &read) {
    enter(name);
    try {
      note_errors(read);
    } catch (...) {
      leave();
      throw;
    }
    leave();
  }
  /// Makes later calls of in() and note_errors() note errors instead of throwing them. They note
  /// single numbers that are not allowed as well. What is read with errors is not to be used.
  void collect_errors() { collects_ = true; }
  /// Calls `read` and notes its errors if they are collected, so that those of other parts follow.
  template <class Function> void note_errors(const Function &read) {
    if (collects_)
      errors_.note(read);
    else
      read();
  }
  /// Throws InputError with all errors noted so far.
  void require_sound() const { errors_.require_none(); }
  /// Returns the names of the subsections that the user opened here.
  std::vector<std::string> names() const { return file_.names_below(path_); }

  std::string text(const std::string &key) const override;
  bool flag(const std::string &key) const override;
  double number(const std::string &key) const override;
  double positive(const std::string &key) const override;
  double not_negative(const std::string &key) const override;
  unsigned int count(const std::string &key, unsigned int minimum = 0,
                     unsigned int maximum = 999999999) const;
  std::vector<double> numbers(const std::string &key) const override;
  std::vector<unsigned int> counts(const std::string &key) const;
  /// Returns ids and names of boundaries, separated by commas. A name has a letter.
  BoundaryIds boundaries(const std::string &key) const;
  /// Returns three numbers.
  dealii::Tensor<1, 3> vector(const std::string &key) const override;
  /// Returns a normalised vector of three numbers that are not all zero.
  dealii::Tensor<1, 3> direction(const std::string &key) const override;
  /// Returns the trimmed parts between separators, without empty ones.
  std::vector<std::string> parts(const std::string &key, char separator = ';') const override;
  /// Returns the name of a file as a path from the working directory. Refuses a file that cannot be
  /// read.
  std::string file(const std::string &key) const override;

  template <class T> Located<T> located(const std::string &key, T value) const {
    return {std::move(value), origin(key)};
  }
  std::string origin(const std::string &key) const override;
  /// Returns the place of the current subsection, for messages about missing parameters.
  std::string origin() const;
  bool is_set(const std::string &key) const override { return file_.is_set(path_, key); }

  /// Names in quotes in `allowed` are parameters on which the error depends.
  [[noreturn]] void reject(const std::string &key, const std::string &allowed) const override;
  /// The same, with the parameters on which the error depends.
  [[noreturn]] void reject_beside(const std::vector<std::string> &others, const std::string &key,
                                  const std::string &allowed) const;

private:
  void enter(const std::string &name);
  void leave();
  /// Returns a number that stands for one that is not allowed, whose error is noted, so that errors
  /// of other parameters are found. Throws the error if errors are not collected.
  double replace(const std::string &key, const std::string &allowed, double value) const;
  double number_within(const std::string &key, const std::string &allowed, double stand_in,
                       const std::function<bool(double)> &is_allowed) const;

  dealii::ParameterHandler &prm_;
  const SceneFile &file_;
  SceneFile::Path path_;
  bool collects_ = false;
  mutable ErrorNotes errors_; ///< what is read does not depend on it
};

} // namespace billet

#endif
