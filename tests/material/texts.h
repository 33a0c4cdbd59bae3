// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_MATERIAL_TEXTS_H
#define BILLET_TESTS_MATERIAL_TEXTS_H

#include "billet/registered_type.h"

#include <deal.II/base/utilities.h>

#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace billet::testing {

/// Parameters of a registered type, without a scene. Files are relative to the working directory.
class Texts final : public TypeInput {
public:
  explicit Texts(std::map<std::string, std::string> texts) : texts_(std::move(texts)) {}
  Texts(const std::string &key, const std::string &text) : texts_({{key, text}}) {}

  bool is_set(const std::string &key) const override { return texts_.count(key) > 0; }
  std::string text(const std::string &key) const override { return is_set(key) ? texts_.at(key) : ""; }
  bool flag(const std::string &key) const override { return text(key) == "true"; }
  double number(const std::string &key) const override { return is_set(key) ? parse_number(text(key)) : 0.; }
  double positive(const std::string &key) const override {
    if (!(number(key) > 0.))
      reject(key, "a number > 0");
    return number(key);
  }
  double not_negative(const std::string &key) const override { return number(key); }
  std::vector<double> numbers(const std::string &key) const override {
    std::vector<double> result;
    for (const std::string &part : parts(key, ','))
      result.push_back(parse_number(part));
    return result;
  }
  dealii::Tensor<1, 3> vector(const std::string &key) const override { reject(key, "no vector"); }
  dealii::Tensor<1, 3> direction(const std::string &key) const override { reject(key, "no direction"); }
  std::vector<std::string> parts(const std::string &key, const char separator) const override {
    return dealii::Utilities::split_string_list(text(key), separator);
  }
  std::string file(const std::string &key) const override { return text(key); }
  std::string origin(const std::string &key) const override { return "'" + key + "'"; }
  [[noreturn]] void reject(const std::string &key, const std::string &allowed) const override {
    throw std::invalid_argument("'" + key + "': allowed is " + allowed);
  }

private:
  std::map<std::string, std::string> texts_;
};

} // namespace billet::testing

#endif
