// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/body_checks.h"

#include "billet/contact/facet_contact.h"
#include "billet/contact/restless_report.h"

namespace billet {

Explanation BodyChecks::describe_restless() const {
  const std::string what = describe_restless_nodes(contact_.measures().find_restless(), pair_.name,
                                                   "facet or status", communicator_);
  if (what.empty())
    return {};
  return {what, contact_.method() == FacetMethod::overlap
                    ? "Try a lower penalty, with a 'Penetration tolerance' if penetration is then too large"
                    : "Try smaller steps, a lower penalty, 'Facets = overlap' or a larger 'Smoothing'"};
}

std::string BodyChecks::describe_obstacle() const {
  return "nodes of contact pair '" + pair_.name + "' would go through the other body";
}

} // namespace billet
