// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_DAMAGE_H
#define BILLET_TESTS_DAMAGE_H

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace billet::testing {

/// Damages files, in the same way on every machine.
class Damage {
public:
  explicit Damage(const unsigned int seed = std::mt19937::default_seed) : engine_(seed) {}

  std::string operator()(std::string bytes) {
    for (std::size_t n = 1 + below(3); n > 0 && !bytes.empty(); --n)
      change(bytes);
    return bytes;
  }

private:
  std::size_t below(const std::size_t n) { return n == 0 ? 0 : engine_() % n; }

  void change(std::string &bytes) {
    const std::size_t place = below(bytes.size());
    switch (below(6)) {
    case 0:
      bytes[place] = static_cast<char>(below(256));
      break;
    case 1:
      bytes.resize(place);
      break;
    case 2:
      bytes.erase(place, 1 + below(20));
      break;
    case 3:
      bytes.insert(place, bytes.substr(below(bytes.size()), below(100)));
      break;
    case 4:
      replace_number(bytes, place);
      break;
    default: // one line goes or stands twice
      const std::size_t begin = bytes.rfind('\n', place) == std::string::npos ? 0 : bytes.rfind('\n', place);
      const std::size_t end = std::min(bytes.find('\n', place + 1), bytes.size());
      if (end > begin && below(2) == 0)
        bytes.erase(begin, end - begin);
      else if (end > begin)
        bytes.insert(begin, bytes.substr(begin, end - begin));
    }
  }

  void replace_number(std::string &bytes, const std::size_t place) {
    static const std::vector<std::string> numbers{"0",
                                                  "-1",
                                                  "1",
                                                  "2",
                                                  "19",
                                                  "1000000000000",
                                                  "4294967296",
                                                  "9223372036854775807",
                                                  "-9223372036854775808",
                                                  "1e300",
                                                  "nan",
                                                  "inf",
                                                  "99999999999999999999999",
                                                  "0.5"};
    const std::size_t begin = bytes.find_first_of("0123456789", place);
    if (begin == std::string::npos)
      return;
    const std::size_t end = std::min(bytes.find_first_not_of("0123456789", begin), bytes.size());
    bytes.replace(begin, end - begin, numbers[below(numbers.size())]);
  }

  std::mt19937 engine_;
};

} // namespace billet::testing

#endif
