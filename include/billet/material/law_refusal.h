// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_LAW_REFUSAL_H
#define BILLET_MATERIAL_LAW_REFUSAL_H

#include <string>

namespace billet {

/// Why a law has returned no stress.
struct LawRefusal {
  std::string what;      ///< a sentence without its full stop; empty: its last update has succeeded
  bool is_final = false; ///< a shorter step does not help, as after a crash
};

/// Base of laws whose code is a user's, so that their refusals need words.
class ExplainsRefusals {
public:
  virtual ~ExplainsRefusals() = default;

  /// Returns why the last update has failed.
  virtual const LawRefusal &refusal() const = 0;
  /// Returns words that name the law and its library.
  virtual std::string title() const = 0;
};

} // namespace billet

#endif
