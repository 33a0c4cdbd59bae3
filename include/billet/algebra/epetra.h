// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_ALGEBRA_EPETRA_H
#define BILLET_ALGEBRA_EPETRA_H

#include "billet/algebra/vector.h"

#include <Epetra_Vector.h>

namespace billet {

/// Returns the vector in the type that Trilinos' packages expect, with the same values. For
/// algebra/ alone.
inline Epetra_Vector &as_epetra(Vector &vector) { return *vector.trilinos_vector()(0); }
inline const Epetra_Vector &as_epetra(const Vector &vector) { return *vector.trilinos_vector()(0); }

} // namespace billet

#endif
