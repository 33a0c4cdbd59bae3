// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_USER_SUBROUTINE_H
#define BILLET_MATERIAL_USER_SUBROUTINE_H

#include <string>

namespace billet {

class PointLaw;

/// Reason for which a law has returned no stress.
struct LawRefusal {
  std::string what;      ///< a sentence without its full stop; empty: its last update has succeeded
  bool is_final = false; ///< a shorter step does not help, as after a crash
};

/// Interface of laws that are subroutines of a user's library, whose refusals need words.
class UserSubroutine {
public:
  virtual ~UserSubroutine() = default;

  /// Returns why the last update has failed.
  virtual const LawRefusal &refusal() const = 0;
  /// Returns words that name the law and its library.
  virtual std::string title() const = 0;
  /// Whether it computes its stored energy. Else all work of its stresses counts as stored.
  virtual bool computes_energies() const = 0;
  /// Returns the norm of C - transposed C over that of C, for the last tangent C. Returns 0 unless
  /// its symmetric part has taken its place.
  virtual double lost_asymmetry() const = 0;
  /// Returns the names of subroutines in its library that the program does not call; empty: there
  /// are none.
  virtual std::string idle_subroutines() const = 0;
};

/// Returns what a law tells of itself as a subroutine of a user's library; null for other laws.
const UserSubroutine *find_user_subroutine(const PointLaw &law);

} // namespace billet

#endif
