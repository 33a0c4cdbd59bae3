// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_BODY_CHECKS_H
#define BILLET_CONTACT_BODY_CHECKS_H

#include "billet/contact/contact_checks.h"
#include "billet/scene/scene.h"

#include <mpi.h>

namespace billet {

class FacetContact;

/// Messages about contact between bodies.
class BodyChecks final : public ContactChecks {
public:
  /// `pair` and `contact` must outlive this object.
  BodyChecks(const BodyPair &pair, const FacetContact &contact, MPI_Comm communicator)
      : pair_(pair), contact_(contact), communicator_(communicator) {}

  Explanation describe_restless() const override;
  std::string describe_obstacle() const override;

private:
  const BodyPair &pair_;
  const FacetContact &contact_;
  MPI_Comm communicator_;
};

} // namespace billet

#endif
