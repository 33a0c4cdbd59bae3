// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_GUARDED_CALL_H
#define BILLET_MATERIAL_GUARDED_CALL_H

#include <string>

namespace billet {

/// End of a guarded call.
enum class CallEnd {
  returned, ///< as usual
  left,     ///< by leave_guarded_call()
  crashed   ///< by a signal such as SIGSEGV
};

struct CallResult {
  CallEnd end = CallEnd::returned;
  int signal = 0; ///< of a crash

  /// Returns a clause such as "ended by a segmentation fault"; empty if the call has returned.
  std::string describe() const;
};

/// Calls `function(data)`, which is code of a user's library, and returns when it returns, leaves
/// or crashes by SIGSEGV, SIGBUS, SIGFPE, SIGILL or SIGABRT. Objects with destructors in the
/// interrupted code leak, and its data may be damaged: do not call it again. `name` stands in the
/// message if the code ends the whole program, as STOP in Fortran does; it must live as long as the
/// call. Not for several threads.
CallResult call_guarded(void (*function)(void *), void *data, const char *name);

/// Ends the guarded call from within. Returns if there is none.
void leave_guarded_call();

} // namespace billet

#endif
