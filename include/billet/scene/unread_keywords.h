// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_UNREAD_KEYWORDS_H
#define BILLET_SCENE_UNREAD_KEYWORDS_H

#include "billet/diagnostics.h"
#include "billet/parameters/reader.h"

#include <cstddef>
#include <map>
#include <string>

namespace billet {

/// Returns a note about the keywords of a mesh file that are not read, with what takes their place
/// in a scene. Returns nothing if there are none.
DiagnosticList describe_unread_keywords(const std::map<std::string, std::size_t> &unread,
                                        const Located<std::string> &file, const std::string &body);

} // namespace billet

#endif
