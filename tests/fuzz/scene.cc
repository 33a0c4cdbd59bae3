// SPDX-License-Identifier: LGPL-2.1-or-later
// Scene files, read with all parameters: what is accepted ends each subsection once.
#include "fuzz.h"

#include "billet/errors.h"
#include "billet/parameters/scene.h"

namespace scene_test {

using namespace billet;
using namespace billet::testing;

namespace {

const std::string folder = SOURCE_DIR "/../../prm/templates/";

/// Whether each subsection has an end, counted in the text alone.
bool is_balanced(const std::string &bytes) {
  std::istringstream lines(bytes);
  int depth = 0;
  bool continues = false;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string first, last;
    words >> first;
    last = first;
    for (std::string word; words >> word;)
      last = word;
    if (!continues)
      depth += first == "subsection" ? 1 : first == "end" ? -1 : 0;
    if (depth < 0)
      return false;
    continues = !last.empty() && last.back() == '\\';
  }
  return depth == 0;
}

} // namespace

std::map<std::string, std::string> corpus() {
  std::map<std::string, std::string> files;
  for (const std::string name : {"bending.prm", "drawing.prm", "impact.prm"})
    files[name] = bytes_of(folder + name);
  return files;
}

Outcome judge(const std::string &bytes) {
  write_bytes("damaged.prm", bytes);
  try {
    const auto scene = parameters::Scene::read("damaged.prm");
    return is_balanced(bytes) && !scene.bodies.empty() ? Outcome::accepted : Outcome::unsound;
  } catch (const InputError &error) {
    return is_message(error.what()) ? Outcome::refused : Outcome::unsound;
  }
}

BILLET_FUZZ_TARGET_OF(scene, 50) // all parameters are declared for each: 15 ms

} // namespace scene_test
