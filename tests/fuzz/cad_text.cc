// SPDX-License-Identifier: LGPL-2.1-or-later
// What STEP and IGES files say of themselves, which is compared before OpenCASCADE sees them: entities that
// are named and defined, lines of sections. Here they are counted in another way. OpenCASCADE itself reads
// damaged files in geometry/damaged_cad, in a copy of the process.
#include "fuzz.h"

#include "billet/geometry/cad_file.h"

#include <set>

namespace cad_text_test {

using namespace billet;
using namespace billet::testing;

namespace {

std::string step() {
  return "ISO-10303-21;\nHEADER;\nFILE_NAME('it''s #7','');\nENDSEC;\nDATA;\n"
         "#1=CARTESIAN_POINT('',(0.,0.,1.E-05));\n#2=DIRECTION('',(0.,0.,1.));\n#3 = "
         "DIRECTION('',(1.,0.,0.));\n"
         "#4=AXIS2_PLACEMENT_3D('',#1,#2,#3);\n#5=PLANE('',#4); /* #8 */\n"
         "#6=ADVANCED_FACE('',(),#5,.T.);\n#7=CLOSED_SHELL('',(#6,#6));\nENDSEC;\nEND-ISO-10303-21;\n";
}

std::string iges() {
  const auto line = [](const std::string &text, const std::string &section) {
    return text + std::string(72 - text.size(), ' ') + section + "\n";
  };
  std::string text = line("part", "S      1") + line("1H,,1H;;", "G      1");
  for (unsigned int i = 1; i < 5; i += 2)
    text += line("     144       1", "D      " + std::to_string(i)) +
            line("     144       0", "D      " + std::to_string(i + 1));
  return text + line("144,1,1,0,1;", "P      1") + line("144,1,1,0,3;", "P      2") +
         line("S      1G      1D      4P      2", "T      1");
}

/// A STEP file without texts and comments.
std::string bare(const std::string &bytes) {
  std::string rest;
  char inside = ' ';
  for (std::size_t i = 0; i < bytes.size(); ++i)
    if (inside == '\'')
      inside = bytes[i] == '\'' ? ' ' : inside;
    else if (inside == '*') {
      if (bytes.compare(i, 2, "*/") == 0) {
        inside = ' ';
        ++i;
      }
    } else if (bytes[i] == '\'')
      inside = '\'';
    else if (bytes.compare(i, 2, "/*") == 0) {
      inside = '*';
      ++i;
    } else
      rest += bytes[i];
  return rest;
}

bool is_sound_step(const std::string &bytes) {
  const std::string text = bare(bytes);
  std::multiset<std::string> defined, named;
  for (std::size_t place = text.find('#'); place != std::string::npos; place = text.find('#', place + 1)) {
    const std::size_t end = std::min(text.find_first_not_of("0123456789", place + 1), text.size());
    std::size_t first = std::min(text.find_first_not_of('0', place + 1), end);
    const std::size_t next = text.find_first_not_of(" \n\r\t\v\f", end);
    (next != std::string::npos && text[next] == '=' ? defined : named)
        .insert(text.substr(first, end - first));
  }
  bool holds = text.find("END-ISO-10303-21") != std::string::npos;
  for (const std::string &name : defined)
    holds = holds && defined.count(name) == 1;
  for (const std::string &name : named)
    holds = holds && defined.count(name) == 1;
  return holds;
}

bool is_sound_iges(const std::string &bytes) {
  std::map<char, int> n;
  std::istringstream lines(bytes);
  std::string line;
  while (std::getline(lines, line) && (line.size() < 73 || line[72] != 'T'))
    if (line.size() > 72)
      ++n[line[72]];
  bool holds = line.size() > 72;
  for (std::size_t i = 0; holds && i < 4; ++i)
    holds = line[8 * i] == "SGDP"[i] && std::atoi(line.substr(8 * i + 1, 7).c_str()) == n["SGDP"[i]];
  return holds;
}

} // namespace

std::map<std::string, std::string> corpus() { return {{"part.step", step()}, {"part.iges", iges()}}; }

Outcome judge(const std::string &bytes) {
  const bool is_step = bytes.compare(0, 3, "ISO") == 0;
  const std::string fault = is_step ? check_step_file(bytes).fault : check_iges_file(bytes).fault;
  if (!fault.empty())
    return is_message(fault) ? Outcome::refused : Outcome::unsound;
  return (is_step ? is_sound_step(bytes) : is_sound_iges(bytes)) ? Outcome::accepted : Outcome::unsound;
}

BILLET_FUZZ_TARGET(cad_text)

} // namespace cad_text_test
