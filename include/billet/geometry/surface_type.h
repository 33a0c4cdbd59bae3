// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_SURFACE_TYPE_H
#define BILLET_GEOMETRY_SURFACE_TYPE_H

#include "billet/geometry/surface_patch.h"

#include <functional>
#include <memory>
#include <string>

namespace billet {

/// What a user wrote about a surface. Every member but text() and is_set() refuses, with the place of the
/// parameter in the scene file, what is not of its kind.
class SurfaceInput {
public:
  virtual ~SurfaceInput() = default;

  virtual bool is_set(const std::string &key) const = 0;
  virtual std::string text(const std::string &key) const = 0;
  virtual bool flag(const std::string &key) const = 0;
  virtual double number(const std::string &key) const = 0;
  virtual double positive(const std::string &key) const = 0;
  virtual double not_negative(const std::string &key) const = 0;
  virtual std::vector<double> numbers(const std::string &key) const = 0;
  virtual dealii::Tensor<1, 3> vector(const std::string &key) const = 0;
  /// Of unit length.
  virtual dealii::Tensor<1, 3> direction(const std::string &key) const = 0;
  /// Parts between semicolons, trimmed.
  virtual std::vector<std::string> parts(const std::string &key, char separator = ';') const = 0;
  /// The name of a file, relative to the scene file, as one that can be opened from here.
  virtual std::string file(const std::string &key) const = 0;
  /// "file:line: 'Key' in 'path': found 'value', allowed is `allowed`", thrown.
  [[noreturn]] virtual void reject(const std::string &key, const std::string &allowed) const = 0;
};

/// A parameter of a surface.
struct SurfaceParameter {
  enum class Kind { number, text, choice, flag };

  std::string key;
  std::string default_value;
  Kind kind;
  std::string meaning; ///< with the unit at its end; of a choice, the choices come first, "a|b: meaning"
};

/// A kind of surface that a scene file can name. A new one is a file in source/geometry/ with a function that
/// returns this, and its name in the list of surface_type.cc.
struct SurfaceType {
  std::string name;
  std::string meaning;
  std::vector<SurfaceParameter> parameters;
  std::function<SurfacePatches(const SurfaceInput &)> make;
};

const std::vector<SurfaceType> &surface_types();

/// Parameters that many surfaces share, and what they say.
extern const SurfaceParameter side_parameter; ///< Side = outside|inside
double side_sign(const SurfaceInput &input);  ///< 1 or −1

} // namespace billet

#endif
