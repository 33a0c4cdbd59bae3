// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_SUBROUTINE_MESSAGES_H
#define BILLET_MATERIAL_SUBROUTINE_MESSAGES_H

#include <cstddef>
#include <string>
#include <vector>

namespace billet {

/// Message that a material subroutine gives by STDB_ABQERR or XPLB_ABQERR of Abaqus.
struct SubroutineMessage {
  /// LOP: 1 is a note, -1 a warning, -2 an error, -3 an error that ends the analysis.
  int level;
  std::string format; ///< as the subroutine gives it, with %I, %R and %S for values
  std::string text;   ///< with the values of the first time
  std::size_t n = 1;  ///< number of times
};

/// Keeps a message of this rank. Messages with the same level and format count as one.
void keep_subroutine_message(int level, const std::string &format, const std::string &text);

/// Returns the messages of this rank since the last call, in the order of their first times.
std::vector<SubroutineMessage> take_subroutine_messages();

} // namespace billet

#endif
