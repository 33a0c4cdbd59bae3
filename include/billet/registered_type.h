// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_REGISTERED_TYPE_H
#define BILLET_REGISTERED_TYPE_H

#include <deal.II/base/tensor.h>

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace billet {

// A kind of thing that a scene file can name, such as a surface or a hardening law, is one RegisteredType:
// its name, its parameters and how to make it. The parameters are declared, documented and printed from it. A
// new kind is one file with a function that returns its RegisteredType, and one line in the table of its
// kinds; or, outside the library, one call of TypeTable::add() before the scene is read.

/// Returns a finite number. Throws std::invalid_argument.
double parse_number(const std::string &text);

/// Values that a user wrote for one thing. Every member but text() and is_set() refuses, with the place of
/// the parameter in the scene file, what is not of its kind.
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
  /// Of unit length.
  virtual dealii::Tensor<1, 3> direction(const std::string &key) const = 0;
  /// Parts between separators, trimmed.
  virtual std::vector<std::string> parts(const std::string &key, char separator = ';') const = 0;
  /// The name of a file, relative to the scene file, as one that can be opened from here.
  virtual std::string file(const std::string &key) const = 0;
  /// Throws "file:line: 'Key' in 'path': found 'value', allowed is `allowed`".
  [[noreturn]] virtual void reject(const std::string &key, const std::string &allowed) const = 0;
};

/// A parameter of a registered type. Types of one table may share a parameter: they then give the same
/// default, kind and meaning.
struct TypeParameter {
  enum class Kind { number, text, choice, flag };

  std::string key;
  std::string default_value;
  Kind kind;
  std::string meaning; ///< with the unit at its end; of a choice, the choices come first, "a|b: meaning"
};

/// One kind of `Product`.
template <class Product> struct RegisteredType {
  std::string name;
  std::string meaning;
  std::vector<TypeParameter> parameters;
  std::function<Product(const TypeInput &)> make;
};

/// All kinds of `Product`, in the order of their registration.
template <class Product> class TypeTable {
public:
  using Type = RegisteredType<Product>;

  TypeTable(std::initializer_list<Type> types) : types_(types) {}

  /// Throws std::logic_error if the name is taken.
  void add(Type type) {
    if (find(type.name) != nullptr)
      throw std::logic_error("the type '" + type.name + "' is registered twice");
    types_.push_back(std::move(type));
  }

  /// Null for an unknown name.
  const Type *find(const std::string &name) const {
    for (const Type &type : types_)
      if (type.name == name)
        return &type;
    return nullptr;
  }

  /// "name|name|name".
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
