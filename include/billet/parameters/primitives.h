// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_PRIMITIVES_H
#define BILLET_PARAMETERS_PRIMITIVES_H

#include <optional>
#include <string>
#include <vector>

namespace billet::parameters {

/// Argument of a primitive.
struct PrimitiveArgument {
  enum class Kind {
    number,
    length,     ///< a number > 0
    count,      ///< a whole number > 0
    any_count,  ///< a whole number >= 0
    counts,     ///< whole numbers > 0, `n` of them, separated by commas
    any_counts, ///< whole numbers >= 0, `n` of them, separated by commas
    sizes,      ///< as `counts`, or lists of sizes of elements, separated by semicolons
    point,      ///< a number for each dimension, separated by commas
    points,     ///< `n` points, separated by semicolons
    flag        ///< true or false
  };

  std::string name;
  Kind kind;
  std::optional<std::string> default_value; ///< none: the argument is necessary
  std::string meaning;                      ///< with the unit at its end
  unsigned int n = 1;                       ///< for `counts`, `sizes` and `points`
};

/// Simple body that a scene selects by name: a function of dealii::GridGenerator.
struct Primitive {
  struct Boundary {
    unsigned int id;
    std::string meaning;
  };

  std::string name;
  unsigned int dimension; ///< 2: section of an extruded body; 3: body
  std::string meaning;
  std::vector<PrimitiveArgument> arguments;
  std::vector<Boundary> boundaries;

  /// Returns "first corner : opposite corner [: boundary ids]", with optional arguments in
  /// brackets.
  std::string usage() const;
};

/// All primitives, bodies first.
const std::vector<Primitive> &primitives();

/// Returns the primitive of this name and dimension; null if there is none.
const Primitive *find_primitive(const std::string &name, unsigned int dimension);

/// Returns the names of all primitives of this dimension.
std::vector<std::string> primitive_names(unsigned int dimension);

/// Returns all arguments of the primitive, separated by colons. Arguments that `text` omits at its
/// end or leaves empty have their defaults, and 'name = value' sets an argument by its name. Throws
/// std::invalid_argument with what is allowed.
std::string complete_arguments(const Primitive &primitive, const std::string &text);

} // namespace billet::parameters

#endif
