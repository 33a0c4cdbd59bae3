// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_SCENE_REPORT_TEXT_H
#define BILLET_RUN_SCENE_REPORT_TEXT_H

#include "billet/run/scene_report.h"

#include <iosfwd>

namespace billet {

/// Prints the report as lines of --check.
void print(const SceneReport &report, std::ostream &stream);

/// Returns it as one JSON object on one line.
std::string describe_as_json(const SceneReport &report);

} // namespace billet

#endif
