// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/contact_interface.h"

namespace billet {

ContactInterface::ContactInterface(const Scene &scene, const ContactPair &pair)
    : settings_(pair), bodies_{pair.body}, rigid_tool_(pair.tool),
      partners_("body '" + scene.bodies()[pair.body].name + "' and tool '" + scene.tools()[pair.tool].name() +
                "'"),
      group_kind_("pair"), group_index_(static_cast<std::size_t>(&pair - scene.pairs().data())) {}

ContactInterface::ContactInterface(const Scene &scene, const BodyPair &pair)
    : settings_(pair), bodies_{pair.bodies[0], pair.bodies[1]},
      partners_("body '" + scene.bodies()[pair.bodies[0]].name + "' and body '" +
                scene.bodies()[pair.bodies[1]].name + "'"),
      group_kind_("body pair"), group_index_(static_cast<std::size_t>(&pair - scene.body_pairs().data())) {}

} // namespace billet
