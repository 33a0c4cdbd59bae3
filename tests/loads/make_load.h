// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_MAKE_LOAD_H
#define BILLET_TESTS_MAKE_LOAD_H

#include "billet/parameters/body.h"

#include <deal.II/base/parameter_handler.h>

#include <sstream>
#include <string>

namespace billet::testing {

/// The load that a user gets who writes these lines into a scene file.
inline parameters::Load make_load(const std::string &type, const std::string &lines) {
  std::istringstream text("set Type = " + type + "\n" + lines + "\n");
  const SceneFile file = SceneFile::scan(text, "scene.prm");
  dealii::ParameterHandler prm;
  parameters::Load::declare(prm);
  file.set_all(prm);
  Reader reader(prm, file);
  parameters::Load load;
  load.name = type;
  load.parse(reader);
  return load;
}

} // namespace billet::testing

#endif
