// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_REGISTERED_TYPE_H
#define BILLET_REGISTERED_TYPE_H

#include <deal.II/base/tensor.h>

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace billet {

// A RegisteredType describes one type that a scene file can name, such as a surface or a hardening
// law. It has its name, its parameters and its factory function. The parameters are declared,
// documented and printed from it. A new type is one file with a function that returns its
// RegisteredType, and one line in the table of its kind. Outside the library, it is one call of
// TypeTable::add() before the scene is read.

/// Returns a finite number. Throws std::invalid_argument.
double parse_number(const std::string &text);

/// Values of the parameters that a user wrote in one subsection. All getters except text() and
/// is_set() refuse values of the wrong type and name the parameter's place in the scene file.
class TypeInput {
public:
  virtual ~TypeInput() = default;

  virtual bool is_set(const std::string &key) const = 0;
  virtual std::string text(const std::string &key) const = 0;
  virtual bool flag(const std::string &key) const = 0;
  virtual double number(const std::string &key) const = 0;
  virtual double positive(const std::string &key) const = 0;
  virtual double not_negative(const std::string &key) const = 0;
  virtual std::vector<double> numbers(const std::string &key) const = 0;
  virtual dealii::Tensor<1, 3> vector(const std::string &key) const = 0;
  /// Returns a vector of unit length.
  virtual dealii::Tensor<1, 3> direction(const std::string &key) const = 0;
  /// Returns the trimmed parts between separators.
  virtual std::vector<std::string> parts(const std::string &key, char separator = ';') const = 0;
  /// Returns the name of a file, which is relative to the scene file, as a path from the working
  /// directory.
  virtual std::string file(const std::string &key) const = 0;
  /// Returns "file:line: 'Key' in 'path'", for messages of later checks.
  virtual std::string origin(const std::string &key) const = 0;
  /// Throws "file:line: 'Key' in 'path' is 'value'; allowed is `allowed`".
  [[noreturn]] virtual void reject(const std::string &key, const std::string &allowed) const = 0;
};

/// Parameter of a registered type. Types of one table may share a parameter: they then give the
/// same default, kind and meaning.
struct TypeParameter {
  enum class Kind { number, text, choice, flag };

  std::string key;
  std::string default_value;
  Kind kind;
  /// Text with the unit at its end; a choice begins with its values, "a|b: meaning".
  std::string meaning;
};

/// Type of `Product` that a scene can select by name.
template <class Product> struct RegisteredType {
  std::string name;
  std::string meaning;
  std::vector<TypeParameter> parameters;
  std::function<Product(const TypeInput &)> make;
};

/// Table of all types of `Product`, in the order of their registration. `T`: a RegisteredType, or
/// derived from it.
template <class Product, class T = RegisteredType<Product>> class TypeTable {
public:
  using Type = T;

  TypeTable(std::initializer_list<Type> types) : types_(types) {}

  /// Adds a type. Throws std::logic_error if the name is taken.
  void add(Type type) {
    if (find(type.name) != nullptr)
      throw std::logic_error("the type '" + type.name + "' is registered twice");
    types_.push_back(std::move(type));
  }

  /// Returns the type with this name; null if there is none.
  const Type *find(const std::string &name) const {
    for (const Type &type : types_)
      if (type.name == name)
        return &type;
    return nullptr;
  }

  /// Returns all names: "name|name|name".
  std::string names() const {
    std::string result;
    for (const Type &type : types_)
      result += (result.empty() ? "" : "|") + type.name;
    return result;
  }

  auto begin() const { return types_.begin(); }
  auto end() const { return types_.end(); }

private:
  std::vector<Type> types_;
};

} // namespace billet

#endif
