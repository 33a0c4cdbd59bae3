// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_MAKE_SURFACE_H
#define BILLET_TESTS_MAKE_SURFACE_H

#include "billet/parameters/tool.h"

#include <deal.II/base/parameter_handler.h>

#include <sstream>

namespace billet::testing {

using SharedSurface = std::shared_ptr<const RigidSurface>;

/// The surface that a user gets who writes these lines into a scene file: name, shape and further lines of
/// each part.
struct SurfacePart {
  std::string shape, lines;
};
inline SharedSurface make_surface(const std::vector<SurfacePart> &parts, const std::string &folder = "") {
  std::ostringstream text;
  std::vector<std::pair<std::string, std::string>> shapes;
  text << "subsection Surfaces\n";
  for (std::size_t i = 0; i < parts.size(); ++i) {
    shapes.emplace_back("part " + std::to_string(i), parts[i].shape);
    text << "subsection part " << i << "\nset Shape = " << parts[i].shape << "\n"
         << parts[i].lines << "\nend\n";
  }
  text << "end\n";
  std::istringstream stream(text.str());
  const SceneFile file = SceneFile::scan(stream, folder + "scene.prm");
  dealii::ParameterHandler prm;
  parameters::Tool::declare(prm, shapes);
  file.set_all(prm);
  Reader reader(prm, file);
  parameters::Tool tool;
  tool.parse(reader);
  return tool.surface;
}
inline SharedSurface make_surface(const std::string &shape, const std::string &lines,
                                  const std::string &folder = "") {
  return make_surface({SurfacePart{shape, lines}}, folder);
}

} // namespace billet::testing

#endif
