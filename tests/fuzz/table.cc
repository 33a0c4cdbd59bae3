// SPDX-License-Identifier: LGPL-2.1-or-later
// Tables of numbers: one row for each line with numbers, and no number that is none.
#include "fuzz.h"

#include "billet/material/csv_columns.h"

namespace table_test {

using namespace billet;
using namespace billet::testing;

std::map<std::string, std::string> corpus() {
  return {{"commas.csv", "# strain, stress\nstrain,stress,rate\n0.,200.,1\n0.1,250.5,1\n0.2,300.25e0,1\n"},
          {"semicolons.csv", "\"a\";\"b\"\r\n\"0\";\"1e3\"\r\n\"5\";\"-2e3\"\r\n"},
          {"blanks.txt", "0 1\n  1   2.5 # end\n\n2 4\n"},
          {"tabs.txt", "\xEF\xBB\xBFt\tf\n0\t1\n1\t2\n"}};
}

Outcome judge(const std::string &bytes) {
  std::istringstream text(bytes), lines(bytes);
  std::size_t n_lines = 0;
  for (std::string line; std::getline(lines, line);)
    n_lines += line.substr(0, line.find('#')).find_first_of("0123456789") != std::string::npos ? 1 : 0;
  try {
    const auto rows = read_columns(text, {1, 2});
    const bool is_finite = std::all_of(rows.begin(), rows.end(), [](const std::array<double, 2> &row) {
      return std::isfinite(row[0]) && std::isfinite(row[1]);
    });
    return rows.size() > n_lines || !is_finite ? Outcome::unsound
           : rows.empty()                      ? Outcome::refused // by what asks for it
                                               : Outcome::accepted;
  } catch (const std::invalid_argument &error) {
    return is_message(error.what()) ? Outcome::refused : Outcome::unsound;
  }
}

BILLET_FUZZ_TARGET(table)

} // namespace table_test
