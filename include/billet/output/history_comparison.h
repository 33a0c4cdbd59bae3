// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_HISTORY_COMPARISON_H
#define BILLET_OUTPUT_HISTORY_COMPARISON_H

#include <string>
#include <vector>

namespace billet {

/// Columns of numbers over time, as in history.csv.
class HistoryTable {
public:
  /// Reads a history. Throws InputError if it cannot be read.
  static HistoryTable read(const std::string &file_name);
  HistoryTable(std::vector<std::string> names, std::vector<std::vector<double>> columns);

  const std::vector<std::string> &names() const { return names_; }
  const std::vector<double> &times() const { return times_; }
  /// Returns a column; empty if there is none of this name.
  const std::vector<double> &column(const std::string &name) const;
  /// Returns the table with a row of zeros at time 0, unless it begins there.
  HistoryTable from_zero() const;

private:
  std::vector<std::string> names_;
  std::vector<std::vector<double>> columns_;
  std::vector<double> times_; ///< ascending
};

/// Difference of two histories of a scene.
struct HistoryDifference {
  double part = 0.; ///< of the results of the second history
  /// "forces", "reactions", "energies" or "travel of tools"; "moments" or "moments of supports" in
  /// place of the first two. Empty if no result differs from 0.
  std::string of_what;
};

/// Returns the largest of the differences of these groups of columns, ∫Σ|a − b| dt/∫Σ|b| dt. Both
/// are linear between their rows and from zero at time 0. The groups are forces of tools and pairs;
/// reactions of supports and symmetry planes, which would dilute them; energies; travel of tools.
/// With inertia, energies alone count, from the first row on. Forces of impacts are no functions of
/// time that two meshes share.
///
/// Forces that moments exceed by far, as in torsion, are round-off; then these moments count.
/// `reach`: the largest distance of bodies from the origin, or more [length].
HistoryDifference compare_histories(const HistoryTable &first, const HistoryTable &second, bool has_inertia,
                                    double reach);

} // namespace billet

#endif
