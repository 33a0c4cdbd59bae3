// SPDX-License-Identifier: LGPL-2.1-or-later
// Messages: each is printed once for its key and its names, then counted; all are on file as JSON lines, with
// a summary at the end, and a checkpoint takes the account along.
#include "../testing.h"
#include "billet/diagnostic_kinds.h"

#include <cstdio>
#include <fstream>
#include <limits>
#include <regex>
#include <set>
#include <sstream>

namespace diagnostics_test {

using billet::Diagnostic;
using billet::Diagnostics;
using billet::Severity;
using billet::testing::check;

namespace {

constexpr const char *file_name = "diagnostics_test.jsonl";

std::vector<std::string> lines_of_file() {
  std::ifstream file(file_name);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);)
    lines.push_back(line);
  return lines;
}

Diagnostic penetration(const std::string &pair, const double time, const double depth) {
  return Diagnostic(billet::diagnostic::penalty_too_low, "Nodes penetrate")
      .pair(pair)
      .time(time)
      .measure("penetration [facet sizes]", depth);
}

/// Prints to `printed`.
void print_to(Diagnostics &diagnostics, std::vector<std::string> &printed) {
  diagnostics.set_print([&printed](Severity, const std::string &text) { printed.push_back(text); });
}

/// Saved messages keep all that they say; those of a kind that the program does not know are left out.
void check_saved() {
  Diagnostics diagnostics(true);
  Diagnostic whole = penetration("top", 0.1, 0.2);
  whole.at(dealii::Tensor<1, 3>({1., 2., 3.}))
      .value("none", std::numeric_limits<double>::quiet_NaN())
      .advice("Do this.");
  diagnostics.report(whole);
  diagnostics.report(penetration("top", 0.3, 0.4));
  diagnostics.report(Diagnostic(billet::diagnostic::solver_memory, "A \xff that is no UTF-8"));
  const std::string state = diagnostics.save();
  Diagnostics resumed(true);
  resumed.load(state);
  check("a saved message keeps its position, values and advice", resumed.save() == state);

  std::string unknown = state;
  const std::string key = "solver-memory", other = "another-thing"; // of the same length
  for (std::size_t at = 0; (at = unknown.find(key, at)) != std::string::npos;)
    unknown.replace(at, key.size(), other);
  Diagnostics without(true);
  without.load(unknown);
  check("a saved message of an unknown kind is skipped",
        unknown != state && without.count(Severity::note) == 0 && without.count(Severity::warning) == 1);
}

void check_kinds() {
  std::set<std::string> keys;
  bool are_words = true, have_meanings = true;
  for (const billet::DiagnosticKind *kind : billet::all_diagnostic_kinds()) {
    keys.insert(kind->key);
    are_words = are_words && std::regex_match(kind->key, std::regex("[a-z]+(-[a-z]+)*"));
    const std::string meaning = kind->meaning;
    have_meanings = have_meanings && meaning.size() > 20 && meaning.back() == '.';
  }
  check("keys are unique", keys.size() == billet::all_diagnostic_kinds().size() && keys.size() > 10);
  check("keys are words", are_words);
  check("each has a meaning", have_meanings);
  check("a kind is found by its key",
        &billet::diagnostic_kind("penalty-too-low") == &billet::diagnostic::penalty_too_low);
}

void check_text() {
  Diagnostic message = penetration("top", 0.25, 0.5);
  message.at(dealii::Tensor<1, 3>({1., 2., 3.})).advice("Do this.");
  check("a text has its four parts", message.text() ==
                                         "warning[penalty-too-low]: Nodes penetrate (pair 'top', at (1, "
                                         "2, 3), time 0.25). Do this.");
  check("else the advice is that of the kind",
        penetration("top", 0., 1.).text() ==
            "warning[penalty-too-low]: Nodes penetrate (pair 'top', time 0). Increase 'Normal penalty'.");
  check("JSON has the same",
        message.json() ==
            R"({"key":"penalty-too-low","severity":"warning","message":"Nodes penetrate","pair":"top",)"
            R"("time":0.25,"values":{"penetration [facet sizes]":0.5},"advice":"Do this.",)"
            R"("position":[1.0,2.0,3.0]})");
  Diagnostic odd(billet::diagnostic::penalty_too_low, "A \"quote\"\nand a line");
  odd.value("none", std::numeric_limits<double>::quiet_NaN()).pair("");
  check("what JSON cannot say is null, and one line stays one",
        odd.json().find(R"("values":{"none":null})") != std::string::npos &&
            odd.json().find('\n') == std::string::npos && odd.json().find("pair") == std::string::npos);
}

void check_counts() {
  Diagnostics diagnostics(true);
  std::vector<std::string> printed;
  print_to(diagnostics, printed);
  diagnostics.report(penetration("top", 0.1, 0.2));
  diagnostics.open(file_name, false);
  diagnostics.report(penetration("top", 0.2, 0.4));
  diagnostics.report(penetration("top", 0.3, 0.3));
  diagnostics.report(penetration("side", 0.3, 0.3));
  diagnostics.report(Diagnostic(billet::diagnostic::solver_memory, "It takes 3 MB"));
  diagnostics.report(Diagnostic(billet::diagnostic::solution_failed, "It failed"));
  check("each is printed once, but for errors",
        printed.size() == 3 && printed[1].find("'side'") != std::string::npos);
  check("it counts", diagnostics.count(Severity::warning) == 2 && diagnostics.count(Severity::note) == 1 &&
                         diagnostics.count_in_words() == "1 error, 2 warnings");
  check("it knows kinds", diagnostics.has(billet::diagnostic::solver_memory) &&
                              !diagnostics.has(billet::diagnostic::unstable_law));
  check("what got worse is in the last lines",
        diagnostics.repetitions() ==
            std::vector<std::string>{
                "warning[penalty-too-low] pair 'top': 3 times, penetration [facet sizes] up to "
                "0.4 at time 0.2"});
  check("the summary is written", diagnostics.write_summary(3));
  const auto lines = lines_of_file();
  check("what was reported before the file is on it, too",
        lines.size() == 5 && lines[0] == penetration("top", 0.1, 0.2).json());
  check("the last line is a summary",
        lines.back().find(
            R"({"summary":{"exit code":3,"errors":1,"warnings":2,"notes":1,"messages":[)"
            R"({"key":"penalty-too-low","pair":"top","count":3,"largest":0.4,"at time":0.2})") == 0);

  Diagnostics resumed(true);
  printed.clear();
  print_to(resumed, printed);
  resumed.load(diagnostics.save());
  resumed.open(file_name, true);
  resumed.report(penetration("top", 0.4, 0.5));
  check("after a restart it is counted on, and not printed again",
        printed.empty() && resumed.count(Severity::warning) == 2 &&
            resumed.repetitions().front() ==
                "warning[penalty-too-low] pair 'top': 4 times, penetration [facet sizes] "
                "up to 0.5 at time 0.4");
  check("the file goes on", resumed.write_summary(0) && lines_of_file().size() == 6);

  Diagnostics other_rank(false);
  print_to(other_rank, printed);
  other_rank.report(penetration("top", 0.1, 0.2));
  check("other ranks count and say nothing", printed.empty() && other_rank.count(Severity::warning) == 1 &&
                                                 other_rank.write_summary(0) && lines_of_file().size() == 6);
  std::remove(file_name);
}

} // namespace

BILLET_TEST(diagnostics) {
  check_kinds();
  check_text();
  check_counts();
  check_saved();
}

} // namespace diagnostics_test
