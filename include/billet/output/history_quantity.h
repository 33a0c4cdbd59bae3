// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_HISTORY_QUANTITY_H
#define BILLET_OUTPUT_HISTORY_QUANTITY_H

#include "billet/solve/newton.h"
#include "billet/solve/solution.h"

#include <functional>
#include <string>
#include <vector>

namespace billet {

/// Solution effort of a step of an implicit scene.
struct StepReport {
  unsigned int step = 0;
  double length = 0.;
  NewtonReport newton;
  unsigned int total_iterations = 0; ///< since time 0, including those of failed steps
  unsigned int total_cuts = 0;
};

/// Data of a line of the history.
struct HistorySample {
  const SolutionState &state;
  unsigned int step;
  double length;            ///< explicit scenes: of the next step [time]
  const StepReport *report; ///< null in explicit scenes
  const Reactions &reactions;
  const std::vector<double> &probes; ///< values of probe_columns()
  const WholeSection &whole;
  double mesh_error = 0.;     ///< from MeshErrors::error()
  double geometry_error = 0.; ///< from MeshErrors::geometry_error()
};

/// Columns of the history by their names, in which NAME and the like stand for names of the scene,
/// and what they have.
struct HistoryColumns {
  std::string names; ///< separated by commas
  std::string meaning;
};

/// Columns of the history that belong together.
struct HistoryQuantity {
  std::string name;
  std::vector<HistoryColumns> meanings; ///< of all its columns
  /// Returns the columns' names; none if the scene does not have the quantity.
  std::function<std::vector<std::string>(const Scene &)> columns;
  /// Returns one value for each column.
  std::function<std::vector<double>(const HistorySample &)> evaluate;
};

/// Quantities of the history, in the order of its columns. A new one is a file in
/// source/output/history/ with a function that returns it, and its name in the table of
/// history_quantity.cc. Outside the library, it is one call of add() before the history begins.
class HistoryQuantities {
public:
  explicit HistoryQuantities(const std::vector<HistoryQuantity> &quantities);

  /// Adds a quantity. Throws std::logic_error if the name is taken, or if no column has a meaning.
  void add(const HistoryQuantity &quantity);

  auto begin() const { return quantities_.begin(); }
  auto end() const { return quantities_.end(); }

private:
  std::vector<HistoryQuantity> quantities_;
};

HistoryQuantities &history_quantities();

/// Returns a name of the scene in the form allowed in a column's name.
std::string column_name(std::string name);

/// Appends the three components.
void add_vector(const dealii::Tensor<1, 3> &vector, std::vector<double> &values);

} // namespace billet

#endif
