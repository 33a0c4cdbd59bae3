// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_FAULT_H
#define BILLET_SCENE_FAULT_H

#include "billet/diagnostics.h"

#include <string>
#include <vector>

namespace billet {

/// Subject of an error in a scene file, as data. The search for further errors
/// (run/all_errors.h) decides on this, never on the words of the message.
struct SceneFault {
  enum class Kind {
    other,
    wrong_value,  ///< a parameter has a value that is not allowed
    wrong_number, ///< the same, and another number is allowed, whatever other parameters are
    excluded,     ///< the parameters in `depends_on` exclude this one, and more probably are wrong
    unknown_name  ///< there is no such parameter or subsection
  };

  bool is_of_value() const { return kind == Kind::wrong_value || kind == Kind::wrong_number; }

  Kind kind = Kind::other;
  std::string suggestion = {}; ///< value or name that the user probably meant; may be empty
  /// Other parameters, and names of bodies, tools and other parts, on which the error depends. If
  /// one of them is wrong, this error may only follow from that.
  std::vector<std::string> depends_on = {};
};

/// Returns the error with what it is about, which is kept between ranks and not printed.
Diagnostic with_fault(Diagnostic error, const SceneFault &fault);
/// Returns an error 'bad-input' with this text.
Diagnostic scene_error(const std::string &text, const SceneFault &fault);
/// Returns what an error is about; of kind `other` if it does not say so.
SceneFault fault_of(const Diagnostic &error);

} // namespace billet

#endif
