// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_GIVEN_VALUES_H
#define BILLET_TESTS_GIVEN_VALUES_H

#include "billet/registered_type.h"

#include <map>
#include <stdexcept>
#include <string>
#include <utility>

namespace billet::testing {

/// Numbers for a registered type, without a scene file.
class GivenValues final : public TypeInput {
public:
  explicit GivenValues(std::map<std::string, double> values) : values_(std::move(values)) {}

  bool is_set(const std::string &key) const override { return values_.count(key) > 0; }
  double number(const std::string &key) const override {
    if (!is_set(key))
      reject(key, "a number");
    return values_.at(key);
  }
  double positive(const std::string &key) const override { return number(key); }
  double not_negative(const std::string &key) const override { return number(key); }
  std::string text(const std::string &key) const override { reject(key, "no text"); }
  bool flag(const std::string &key) const override { reject(key, "no flag"); }
  std::vector<double> numbers(const std::string &key) const override { reject(key, "no list"); }
  dealii::Tensor<1, 3> vector(const std::string &key) const override { reject(key, "no vector"); }
  dealii::Tensor<1, 3> direction(const std::string &key) const override { reject(key, "no direction"); }
  std::vector<std::string> parts(const std::string &key, char) const override { reject(key, "no parts"); }
  std::string file(const std::string &key) const override { reject(key, "no file"); }
  std::string origin(const std::string &key) const override { return "'" + key + "'"; }
  [[noreturn]] void reject(const std::string &key, const std::string &allowed) const override {
    throw std::invalid_argument("'" + key + "': allowed is " + allowed);
  }

private:
  std::map<std::string, double> values_;
};

} // namespace billet::testing

#endif
