// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/error_report.h"

#include "billet/errors.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace billet {

double ErrorReport::total() const {
  double sum = 0.;
  for (const auto &source : sources)
    sum += source.is_known ? source.error : 0.;
  return sum;
}

std::string ErrorReport::describe() const {
  std::ostringstream text;
  text.precision(2);
  const auto percent = [](const double part) { return 100. * part; };
  if (target > 0.)
    text << "Target error " << percent(target) << " %: ";
  if (!is_known) {
    text << "nothing is believed, since there were no " << of_what << " that errors could be parts of"
         << (of_what == "energies" ? " besides that of a motion that all bodies share"
                                   : ": of a tool, between two bodies or, without these, of supports");
    return text.str();
  }
  const auto unknown =
      std::find_if(sources.begin(), sources.end(), [](const Source &source) { return !source.is_known; });
  text << "believed error " << (unknown == sources.end() ? "" : "at least ") << percent(total())
       << " % of the " << of_what;
  if (since > 0.) {
    text.precision(6);
    text << " from time " << since << " on, since the run up to then kept no account of them";
    text.precision(2);
  }
  text << " (";
  for (const auto &source : sources) {
    text << (&source == sources.data() ? "" : ", ") << source.name << " ";
    if (source.is_known)
      text << percent(source.error) << " %";
    else
      text << "unknown";
  }
  text << ")";
  text.precision(7);
  for (const auto &[name, value] : costs)
    text << (&name == &costs.front().first ? "; cost: " : ", ") << value << " " << name;
  text.precision(2);
  if (target > 0. && total() > target) {
    const auto worst = std::max_element(sources.begin(), sources.end(),
                                        [](const Source &a, const Source &b) { return a.error < b.error; });
    text << "\nThe target was not reached: " << worst->name << " make most of the error; " << worst->remedy;
  } else if (target > 0. && unknown != sources.end())
    text
        << "\nWhether the target was reached is not known: there were too few steps, or none that succeeded, "
           "to measure what "
        << unknown->name << " make; " << unknown->remedy;
  text << "\nThe mesh is not part of this. Stresses jump between elements by " << percent(stress_jumps)
       << " % in the mean: what a finer mesh would smooth";
  if (target > 0. && stress_jumps > target)
    text << ". That is more than the target: run a finer mesh, too, to see what it changes";
  return text.str();
}

void ErrorReport::write(const std::string &folder) const {
  const std::string name = folder + "/believed_error.csv";
  std::ofstream file(name);
  file << "quantity,value\n";
  if (target > 0.)
    file << "target," << target << "\n";
  const auto believed = [this](const double error, const bool source_is_known) {
    return is_known && source_is_known ? error : std::nan("");
  };
  const bool all_known =
      std::all_of(sources.begin(), sources.end(), [](const Source &source) { return source.is_known; });
  if (since > 0.)
    file << "since," << since << "\n";
  file << "error," << believed(total(), all_known) << "\n";
  for (const auto &source : sources)
    file << source.name << "," << believed(source.error, source.is_known) << "\n";
  file << "stress jumps," << stress_jumps << "\n";
  file.precision(12);
  for (const auto &[what, value] : costs)
    file << what << "," << value << "\n";
  if (!file.flush())
    throw SolutionFailure(name + " cannot be written: is the disk full?");
}

} // namespace billet
