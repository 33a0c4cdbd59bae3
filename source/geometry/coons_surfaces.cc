// SPDX-License-Identifier: LGPL-2.1-or-later
// Coons patches as the user defines them: one in the scene file, or many in a file of their own.
#include "billet/geometry/coons_patch.h"
#include "billet/geometry/surface_type.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace billet {

namespace {

using Kind = TypeParameter::Kind;
using Sketch = std::array<CurveSketch, 4>;

const std::string curves_meaning =
    "Four curves around the patch, separated by semicolons, each from the end of the one before. They run "
    "counter-clockwise as seen from the bodies, right-handed about the normal. A line is 'line: x, y, z to "
    "x, y, z'. An arc is 'arc: x, y, z via x, y, z to x, y, z'. A natural cubic spline is 'spline: x, y, z "
    "via x, y, z via ... to x, y, z'. A side that shrinks to a point is 'point: x, y, z'. [length]";

Sketch read_curves(const std::vector<std::string> &parts) {
  if (parts.size() != 4)
    throw std::invalid_argument("four curves, separated by semicolons; these are " +
                                std::to_string(parts.size()));
  Sketch curves;
  std::transform(parts.begin(), parts.end(), curves.begin(), read_curve);
  return curves;
}

/// Returns the non-empty parts between semicolons.
std::vector<std::string> split(const std::string &line) {
  std::vector<std::string> parts;
  std::istringstream stream(line);
  std::string part;
  while (std::getline(stream, part, ';')) {
    const auto begin = part.find_first_not_of(" \t\r");
    if (begin != std::string::npos)
      parts.push_back(part.substr(begin, part.find_last_not_of(" \t\r") + 1 - begin));
  }
  return parts;
}

/// Replaces tabs and carriage returns by blanks. Refuses other control characters, since messages
/// quote a line.
void clean(std::string &line) {
  for (char &c : line) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '\t' || c == '\r')
      c = ' ';
    else if (code < ' ' || code == 0x7F)
      throw std::invalid_argument("a control character, of code " + std::to_string(code) +
                                  ", stands in the line");
  }
}

/// Side of a patch of a set; the two adjacent patches traverse it in opposite directions.
struct Side {
  dealii::Tensor<1, 3> start, middle, end;
  unsigned int line; ///< line of the file
};

void add_sides(const Sketch &curves, const unsigned int line, std::vector<Side> &sides) {
  for (const auto &sketch : curves)
    if (sketch.kind != CurveSketch::Kind::point)
      sides.push_back({sketch.points.front(), Curve(sketch).at(0.5).position, sketch.points.back(), line});
}

/// Throws std::invalid_argument if adjacent patches have opposite orientations.
void check_sides(std::vector<Side> sides) {
  BoundingBox box = BoundingBox::empty();
  for (const auto &side : sides) {
    box.add(side.start);
    box.add(side.middle);
  }
  const double tolerance = 1e-7 * (box.high - box.low).norm();
  std::stable_sort(sides.begin(), sides.end(),
                   [](const Side &a, const Side &b) { return a.middle[0] < b.middle[0]; });
  for (std::size_t i = 0; i < sides.size(); ++i)
    for (std::size_t j = i + 1; j < sides.size() && sides[j].middle[0] - sides[i].middle[0] <= tolerance; ++j)
      if ((sides[j].middle - sides[i].middle).norm() <= tolerance &&
          (sides[j].start - sides[i].start).norm() <= tolerance &&
          (sides[j].end - sides[i].end).norm() <= tolerance)
        throw std::invalid_argument(
            "the patches of lines " + std::to_string(std::min(sides[i].line, sides[j].line)) + " and " +
            std::to_string(std::max(sides[i].line, sides[j].line)) +
            " run the same way along the side that they share, from " + print(sides[i].start) + " to " +
            print(sides[i].end) + ": their normals oppose each other");
}

} // namespace

SurfacePatches read_coons_patches(std::istream &stream, const std::string &name) {
  SurfacePatches patches;
  std::vector<Side> sides;
  std::string line;
  for (unsigned int number = 1; std::getline(stream, line); ++number) {
    line.erase(std::min(line.size(), line.find('#')));
    try {
      clean(line);
      const auto parts = split(line);
      if (parts.empty())
        continue;
      const Sketch curves = read_curves(parts);
      patches.push_back(std::make_unique<CoonsPatch>(curves));
      add_sides(curves, number, sides);
    } catch (const std::invalid_argument &error) {
      throw std::invalid_argument(name + ":" + std::to_string(number) + ": " + error.what());
    }
  }
  if (patches.empty())
    throw std::invalid_argument(name + ": it has none");
  try {
    check_sides(sides);
  } catch (const std::invalid_argument &error) {
    throw std::invalid_argument(name + ": " + error.what());
  }
  return patches;
}

SurfaceType coons_patch_type() {
  return {"coons patch",
          "Surface between four curves, bilinearly blended.",
          {{"Curves", "", Kind::text, "The " + curves_meaning}},
          [](const TypeInput &input) {
            try {
              return single_patch<CoonsPatch>(read_curves(input.parts("Curves")));
            } catch (const std::invalid_argument &error) {
              input.reject("Curves", std::string("a Coons patch; ") + error.what());
              throw;
            }
          }};
}

SurfaceType coons_patches_type() {
  return {"coons patches",
          "Coons patches of a file. The surface continues where they meet.",
          {{"File", "", Kind::text,
            "Name of a text file, relative to the scene file, with one patch a line and comments after '#'. "
            "A patch is: " +
                curves_meaning}},
          [](const TypeInput &input) {
            const std::string name = input.file("File");
            std::ifstream stream(name);
            try {
              return read_coons_patches(stream, name);
            } catch (const std::invalid_argument &error) {
              input.reject("File", std::string("a file of Coons patches; ") + error.what());
              throw;
            }
          }};
}

} // namespace billet
