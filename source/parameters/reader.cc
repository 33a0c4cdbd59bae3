// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/reader.h"

#include "billet/errors.h"
#include "billet/parameters/number_text.h"
#include "billet/scene_fault.h"
#include "billet/vector_text.h"

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace billet {

namespace {

constexpr auto within_reach =
    "0, or a size from 1e-60 to 1e60: products of other numbers exceed the range of the machine";

bool is_beyond_reach(const double value) {
  return std::abs(value) > max_number || (value != 0. && std::abs(value) < min_number);
}

InputError refuse(const std::string &origin, const std::string &value, const std::string &allowed,
                  const SceneFault &fault) {
  return InputError(scene_error(origin + " is '" + value + "'; allowed is " + allowed, fault));
}

/// Returns the parameters that the allowed values depend on: by convention, a text names them in
/// quotes, 'Key' or 'Key = value'.
std::vector<std::string> parameters_in(const std::string &allowed) {
  std::vector<std::string> names;
  for (std::size_t at = allowed.find('\''); at != std::string::npos; at = allowed.find('\'', at + 1)) {
    if (at > 0 && std::isalpha(static_cast<unsigned char>(allowed[at - 1])) != 0) // an apostrophe
      continue;
    const std::size_t end = allowed.find('\'', at + 1);
    if (end == std::string::npos)
      break;
    const std::string quoted = allowed.substr(at + 1, end - at - 1);
    names.push_back(dealii::Utilities::trim(quoted.substr(0, quoted.find('='))));
    at = end;
  }
  return names;
}

bool is_number(const std::string &text) {
  try {
    parse_number(text);
    return true;
  } catch (const std::invalid_argument &) {
    return false;
  }
}

std::vector<double> parse_numbers(const Reader &reader, const std::string &key,
                                  const std::vector<std::string> &texts) {
  std::vector<double> result;
  for (const auto &text : texts) {
    try {
      result.push_back(parse_number(text));
    } catch (const std::invalid_argument &) {
      reader.reject(key, "finite numbers, separated by commas" + parameters::number_remedy(text));
    }
    if (is_beyond_reach(result.back()))
      reader.reject(key, within_reach);
  }
  return result;
}

} // namespace

void Reader::enter(const std::string &name) {
  prm_.enter_subsection(name);
  path_.push_back(name);
}

void Reader::leave() {
  prm_.leave_subsection();
  path_.pop_back();
}

double Reader::replace(const std::string &key, const std::string &allowed, const double value) const {
  const InputError error = refuse(origin(key), prm_.get(key), allowed, {SceneFault::Kind::wrong_number});
  if (!collects_)
    throw error;
  errors_.add(error.diagnostics());
  return value;
}

std::string Reader::origin(const std::string &key) const {
  const SceneFile::Path &path = file_.written_path(path_, key);
  return file_.where(path_, key) + ": '" + key + "'" + (path.empty() ? "" : " in '" + join(path) + "'");
}

std::string Reader::origin() const { return file_.where(path_) + ": '" + join(path_) + "'"; }

void Reader::reject(const std::string &key, const std::string &allowed) const {
  reject_beside(parameters_in(allowed), key, allowed);
}

void Reader::reject_beside(const std::vector<std::string> &others, const std::string &key,
                           const std::string &allowed) const {
  // A number that stands for a wrong one in this subsection may be the reason: then that error
  // stays alone.
  const Diagnostic *const known = path_.empty() ? nullptr : errors_.find(" in '" + join(path_) + "' is '");
  if (known != nullptr)
    throw InputError(*known);
  const std::string value = prm_.get(key);
  const bool is_wrong_alone = is_number(value) && others.empty();
  throw refuse(origin(key), value, allowed,
               {is_wrong_alone ? SceneFault::Kind::wrong_number : SceneFault::Kind::wrong_value, "", others});
}

std::string Reader::text(const std::string &key) const { return prm_.get(key); }

bool Reader::flag(const std::string &key) const { return prm_.get_bool(key); }

double Reader::number_within(const std::string &key, const std::string &allowed, const double stand_in,
                             const std::function<bool(double)> &is_allowed) const {
  double value = std::numeric_limits<double>::quiet_NaN();
  try {
    value = prm_.get_double(key);
  } catch (const std::exception &) { // as for numbers that are not finite
  }
  if (!std::isfinite(value))
    return replace(key, "a finite number", stand_in);
  if (is_beyond_reach(value))
    return replace(key, within_reach, stand_in);
  return is_allowed(value) ? value : replace(key, allowed, stand_in);
}

double Reader::number(const std::string &key) const {
  return number_within(key, "", 0., [](const double) { return true; });
}

double Reader::positive(const std::string &key) const {
  return number_within(key, "a number > 0", 1., [](const double value) { return value > 0.; });
}

double Reader::not_negative(const std::string &key) const {
  return number_within(key, "a number >= 0", 0., [](const double value) { return value >= 0.; });
}

unsigned int Reader::count(const std::string &key, const unsigned int minimum,
                           const unsigned int maximum) const {
  const long value = prm_.get_integer(key);
  if (value < static_cast<long>(minimum) || value > static_cast<long>(maximum))
    return static_cast<unsigned int>(replace(
        key, "a whole number from " + std::to_string(minimum) + " to " + std::to_string(maximum), minimum));
  return static_cast<unsigned int>(value);
}

std::vector<std::string> Reader::parts(const std::string &key, const char separator) const {
  std::vector<std::string> result;
  for (const auto &part : dealii::Utilities::split_string_list(prm_.get(key), separator))
    if (!part.empty())
      result.push_back(part);
  return result;
}

std::vector<double> Reader::numbers(const std::string &key) const {
  const auto list = dealii::Utilities::split_string_list(prm_.get(key), ',');
  const bool is_empty = list.size() == 1 && list.front().empty();
  return is_empty ? std::vector<double>() : parse_numbers(*this, key, list);
}

unsigned int parse_count(const std::string &text) {
  if (text.empty() || text.size() > 9 || text.find_first_not_of("0123456789") != std::string::npos)
    throw std::invalid_argument("'" + text + "' is not a whole number from 0 to 999999999");
  return static_cast<unsigned int>(std::stoul(text));
}

bool is_boundary_name(const std::string &text) {
  const auto is_letter = [](const char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) > 127;
  };
  return std::any_of(text.begin(), text.end(), is_letter) && text.find(',') == std::string::npos;
}

std::string Reader::file(const std::string &key) const {
  std::string name = file_.resolve(path_, key, text(key));
  std::ifstream stream(name);
  if (!stream || std::filesystem::is_directory(name))
    reject(key, "a file that can be read ('" + name + "' cannot)");
  return name;
}

std::vector<unsigned int> Reader::counts(const std::string &key) const {
  std::vector<unsigned int> result;
  const auto list = dealii::Utilities::split_string_list(prm_.get(key), ',');
  for (const auto &part : list) {
    if (part.empty() && list.size() == 1)
      break;
    try {
      result.push_back(parse_count(part));
    } catch (const std::invalid_argument &) {
      reject(key, "whole numbers from 0 to 999999999, separated by commas");
    }
  }
  return result;
}

BoundaryIds Reader::boundaries(const std::string &key) const {
  BoundaryIds result;
  result.origin = origin(key);
  const auto list = dealii::Utilities::split_string_list(prm_.get(key), ',');
  for (const auto &part : list) {
    if (part.empty() && list.size() == 1)
      break;
    try {
      if (is_boundary_name(part))
        result.names.push_back(part);
      else
        result.value.push_back(parse_count(part));
    } catch (const std::invalid_argument &) {
      reject(key, "whole numbers from 0 to 999999999 and names of boundaries, separated by commas");
    }
  }
  return result;
}

dealii::Tensor<1, 3> Reader::vector(const std::string &key) const {
  const auto parts = split_vector(text(key));
  if (parts.size() != 3)
    reject(key, "three numbers, separated by commas or semicolons");
  const auto values = parse_numbers(*this, key, parts);
  dealii::Tensor<1, 3> result;
  for (unsigned int i = 0; i < 3; ++i)
    result[i] = values[i];
  return result;
}

dealii::Tensor<1, 3> Reader::direction(const std::string &key) const {
  const auto result = vector(key);
  if (!(result.norm() > 0.))
    reject(key, "three numbers that are not all zero");
  return result / result.norm();
}

} // namespace billet
