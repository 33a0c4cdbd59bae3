// SPDX-License-Identifier: LGPL-2.1-or-later
// Files of Coons patches: one patch for each line that is not empty, with finite points and normals.
#include "fuzz.h"

#include "billet/geometry/coons_patch.h"

namespace coons_test {

using namespace billet;
using namespace billet::testing;

std::map<std::string, std::string> corpus() {
  return {{"flat.txt", "# two squares side by side\n"
                       "line: 0, 0, 0 to 1, 0, 0 ; line: 1, 0, 0 to 1, 1, 0 ; line: 1, 1, 0 to 0, 1, 0 ; "
                       "line: 0, 1, 0 to 0, 0, 0\n\n"
                       "line: 1, 0, 0 to 2, 0, 0.5 ; line: 2, 0, 0.5 to 2, 1, 0.5 ; "
                       "line: 2, 1, 0.5 to 1, 1, 0 ; line: 1, 1, 0 to 1, 0, 0 # the second\n"},
          {"curved.txt", "arc: 2, 0, -1 via 1.7320508075688772, 1, -1 to 1, 1.7320508075688772, -1 ; "
                         "line: 1, 1.7320508075688772, -1 to 1, 1.7320508075688772, 3 ; "
                         "arc: 1, 1.7320508075688772, 3 via 1.7320508075688772, 1, 3 to 2, 0, 3 ; "
                         "line: 2, 0, 3 to 2, 0, -1\r\n"},
          {"pole.txt", "spline: 0.1, 0, -0.2 via 1.6, 0.1, -0.2 to 2.9, 0, -0.1 ; "
                       "spline: 2.9, 0, -0.1 via 2.9, 1.1, -0.1 to 2.9, 2, 0 ; point: 2.9, 2, 0 ; "
                       "spline: 2.9, 2, 0 via 0.1, 1.2, -0.2 to 0.1, 0, -0.2\n"}};
}

Outcome judge(const std::string &bytes) {
  std::istringstream text(bytes), lines(bytes);
  std::size_t n_lines = 0;
  for (std::string line; std::getline(lines, line);)
    n_lines += line.substr(0, line.find('#')).find_first_not_of("; \t\r") != std::string::npos ? 1 : 0;
  try {
    const SurfacePatches patches = read_coons_patches(text, "patches.txt");
    bool is_sound = patches.size() == n_lines;
    for (const auto &patch : patches) {
      const BoundingBox box = patch->bounding_box();
      const dealii::Tensor<1, 3> centre = 0.5 * (box.low + box.high);
      const ClosestPoint closest = patch->closest_point(centre + 0.1 * (box.high - box.low));
      is_sound = is_sound && (box.high - box.low).norm() > 0. && std::isfinite((box.high - box.low).norm()) &&
                 std::isfinite(closest.position.norm()) && std::abs(closest.normal.norm() - 1.) < 1e-9;
    }
    return is_sound ? Outcome::accepted : Outcome::unsound;
  } catch (const std::invalid_argument &error) {
    return is_message(error.what()) ? Outcome::refused : Outcome::unsound;
  }
}

BILLET_FUZZ_TARGET(coons)

} // namespace coons_test
