// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_CERTIFY_H
#define BILLET_RUN_CERTIFY_H

#include "billet/material/certificate.h"
#include "billet/parameters/scene.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace billet {

enum class PageFormat { text, markdown };

/// Prints the findings about a law.
void print(const Certificate &certificate, const std::string &title, PageFormat format, std::ostream &stream);

/// Certifies the law of each body of a scene (certificate.h) with the scene's first step and
/// temperature. The file may also have nothing but the parameters of a material, whose law it then
/// certifies. Prints the findings. Returns whether all laws pass. Throws InputError.
bool certify_laws(const std::string &file, const std::vector<SceneFile::Setting> &settings, PageFormat format,
                  std::ostream &stream);

} // namespace billet

#endif
