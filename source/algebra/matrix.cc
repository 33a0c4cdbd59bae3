// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/algebra/matrix.h"

#include <Epetra_CrsMatrix.h>

namespace billet {

std::size_t count_owned_entries(const Matrix &matrix) {
  return static_cast<std::size_t>(matrix.trilinos_matrix().NumMyNonzeros());
}

} // namespace billet
