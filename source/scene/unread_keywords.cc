// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/unread_keywords.h"

#include "billet/diagnostic_kinds.h"
#include "billet/printable.h"

#include <cctype>
#include <vector>

namespace billet {

namespace {

/// Keywords by their beginnings, and what a scene has in their place.
struct Replacement {
  const char *in_scene;
  std::vector<std::string> beginnings;
};

const std::vector<Replacement> &replacements() {
  // The first that fits counts.
  static const std::vector<Replacement> table{
      {"'Output' and 'Probes' stand",
       {"output", "node output", "element output", "contact output", "energy output", "node file",
        "node print", "el file", "el print", "contact file", "contact print", "restart", "monitor",
        "section print", "section file"}},
      {"'Supports' of the body stands", {"boundary"}},
      {"'Loads' of the body stands",
       {"cload", "dload", "dsload", "spring", "dashpot", "element, type=spring", "element, type=dashpot"}},
      {"'Type = rigid face' in 'Loads' of the body stands",
       {"kinematic", "coupling", "distributing", "rigid body"}},
      {"'Material' of the body, with its 'Density', stands",
       {"material", "elastic", "plastic", "density", "hyperelastic", "rate dependent", "solid section",
        "shell section", "mass", "element, type=mass"}},
      {"'Initial velocity' of the body stands", {"initial conditions"}},
      {"'Contact pairs', and 'Tools' for rigid surfaces, stand",
       {"contact", "surface interaction", "surface behavior", "friction", "clearance", "change friction",
        "surface, type="}},
      {"'Amplitudes' stands", {"amplitude"}},
      {"'Time stepping' and the subsection of the method stand",
       {"step", "static", "dynamic", "visco", "controls", "time points", "bulk viscosity",
        "fixed mass scaling", "variable mass scaling", "solution technique"}}};
  return table;
}

std::string replacement_of(const std::string &keyword) {
  for (const Replacement &replacement : replacements())
    for (const std::string &beginning : replacement.beginnings)
      if (keyword.compare(0, beginning.size(), beginning) == 0)
        return replacement.in_scene;
  return "Nothing stands";
}

std::string upper_case(std::string text) {
  for (char &c : text)
    c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

} // namespace

DiagnosticList describe_unread_keywords(const std::map<std::string, std::size_t> &unread,
                                        const Located<std::string> &file, const std::string &body) {
  if (unread.empty())
    return {};
  constexpr std::size_t max_keyword = 40, max_list = 1000; // characters
  std::map<std::string, std::string> keywords;             // by what replaces them
  std::size_t total = 0;
  for (const auto &[name, n] : unread) {
    std::string &list = keywords[replacement_of(name)];
    list += (list.empty() ? "*" : ", *") + upper_case(printable(name, max_keyword)) +
            (n > 1 ? " (" + std::to_string(n) + " times)" : "");
    total += n;
  }
  std::string advice;
  for (const auto &[replacement, list] : keywords)
    append_sentences(advice, replacement + " for " + printable(list, max_list));
  return {Diagnostic(diagnostic::keywords_unread, "The program reads the mesh of '" +
                                                      printable(file.value, max_list) + "' and leaves out " +
                                                      std::to_string(total) +
                                                      (total == 1 ? " keyword" : " keywords") + " beside it")
              .body(body)
              .origin(file.origin)
              .advice(advice + " in a scene")
              .value("keywords", static_cast<double>(total))};
}

} // namespace billet
