// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FAIL_TOGETHER_H
#define BILLET_FAIL_TOGETHER_H

#include "billet/errors.h"

#include <mpi.h>

#include <functional>

namespace billet {

/// Calls `action` on every rank. If it throws on any of them, every rank throws: InputError or
/// SolutionFailure with the same diagnostic if that was thrown, otherwise std::runtime_error.
/// `action` itself must not communicate.
void fail_together(MPI_Comm communicator, const std::function<void()> &action);

} // namespace billet

#endif
