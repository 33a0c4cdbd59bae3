// SPDX-License-Identifier: LGPL-2.1-or-later
// Where this is linked into a program, invalid operations and divisions by zero end it, by SIGFPE, where they happen
// (BILLET_FLOATING_POINT_TRAPS; glibc).
#include <cfenv>

namespace {

const int traps = feenableexcept(FE_INVALID | FE_DIVBYZERO);

} // namespace
