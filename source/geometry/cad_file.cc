// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/cad_file.h"

#include "billet/geometry/step_entities.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <sstream>
#include <vector>

namespace billet {

namespace {

bool is_digit(const char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_blank(const char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
bool is_letter(const char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Names of entities in a STEP file, "#1", and its keywords; text in quotes and comments are left
/// out.
class StepScan {
public:
  explicit StepScan(const std::string &text) : text_(text) {
    while (at_ < text_.size())
      take();
    std::sort(defined_.begin(), defined_.end());
  }

  CadFileReport report() const {
    CadFileReport result;
    result.n_faces = n_faces_;
    if (!has_end_)
      result.fault = "it is cut short: it does not end with END-ISO-10303-21";
    else if (const auto second = std::adjacent_find(defined_.begin(), defined_.end());
             second != defined_.end())
      result.fault = "it defines #" + std::to_string(*second) + " twice";
    else
      for (const std::uint64_t name : used_)
        if (!std::binary_search(defined_.begin(), defined_.end(), name)) {
          result.fault = "it names #" + std::to_string(name) + ", which it does not define";
          break;
        }
    return result;
  }

private:
  void take() {
    const char c = text_[at_];
    // A quote in a text is written twice, as if a text ended and another began.
    if (c == '\'')
      at_ = after("'", at_ + 1);
    else if (text_.compare(at_, 2, "/*") == 0)
      at_ = after("*/", at_ + 2);
    else if (c == '#')
      take_name();
    else if (is_letter(c))
      take_keyword();
    else
      ++at_;
  }

  std::size_t after(const char *what, const std::size_t from) const {
    const std::size_t place = text_.find(what, from);
    return place == std::string::npos ? text_.size() : place + std::char_traits<char>::length(what);
  }

  void take_name() {
    std::uint64_t name = 0;
    for (++at_; at_ < text_.size() && is_digit(text_[at_]); ++at_)
      name = 10 * name + static_cast<std::uint64_t>(text_[at_] - '0');
    std::size_t next = at_;
    while (next < text_.size() && is_blank(text_[next]))
      ++next;
    (next < text_.size() && text_[next] == '=' ? defined_ : used_).push_back(name);
  }

  void take_keyword() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]) || text_[at_] == '-'))
      ++at_;
    const std::string word = text_.substr(begin, at_ - begin);
    if (word == "ADVANCED_FACE")
      ++n_faces_;
    has_end_ = has_end_ || word == "END-ISO-10303-21";
  }

  const std::string &text_;
  std::size_t at_ = 0;
  std::vector<std::uint64_t> defined_, used_;
  std::size_t n_faces_ = 0;
  bool has_end_ = false;
};

} // namespace

CadFileReport check_step_file(const std::string &text) {
  CadFileReport result = StepScan(text).report();
  if (result.fault.empty())
    result.fault = find_faulty_entity(text);
  return result;
}

CadFileReport check_iges_file(const std::string &text) {
  constexpr std::size_t place_of_section = 72;
  constexpr std::array<char, 4> sections{'S', 'G', 'D', 'P'};
  constexpr std::size_t width_of_count = 8;
  std::array<std::size_t, sections.size()> counts{};
  CadFileReport result;
  std::string last;
  std::istringstream lines(text);
  for (std::string line; last.empty() && std::getline(lines, line);) {
    if (line.size() <= place_of_section)
      continue;
    const char section = line[place_of_section];
    if (section == 'T')
      last = line;
    const auto *place = std::find(sections.begin(), sections.end(), section);
    if (place == sections.end())
      continue;
    const std::size_t n = ++counts[static_cast<std::size_t>(place - sections.begin())];
    const std::string type = line.substr(0, width_of_count);
    // Every other line of the directory names the type of its entity; 144 and 510 are bounded
    // faces.
    if (section == 'D' && n % 2 == 1 && (type == "     144" || type == "     510"))
      ++result.n_faces;
  }
  if (last.empty())
    result.fault = "it is cut short: it has no terminate section";
  for (std::size_t i = 0; i < sections.size() && result.fault.empty(); ++i) {
    std::istringstream count(last.substr(i * width_of_count + 1, width_of_count - 1));
    std::size_t n = 0;
    if (last[i * width_of_count] != sections[i] || !(count >> n) || n != counts[i])
      result.fault = std::string("its section ") + sections[i] + " has " + std::to_string(counts[i]) +
                     " lines, but its last line tells another number";
  }
  return result;
}

} // namespace billet
