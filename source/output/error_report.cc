// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/error_report.h"

#include "billet/diagnostic_kinds.h"

#include "billet/errors.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace billet {

bool ErrorReport::knows_all() const {
  return is_known &&
         std::all_of(sources.begin(), sources.end(), [](const Source &source) { return source.is_known; });
}

double ErrorReport::total() const {
  double sum = 0.;
  for (const auto &source : sources)
    sum += source.is_known ? source.error : 0.;
  return sum;
}

namespace {

double percent(const double part) { return 100. * part; }

std::string mesh_is_not_part(const double mesh, const bool is_known) {
  std::ostringstream text;
  text.precision(2);
  text << "The estimate excludes the error of the mesh, about " << percent(mesh) << " % of the forces"
       << (is_known ? "" : " or far more, as the note 'mesh-error' says");
  return text.str();
}

} // namespace

Diagnostic ErrorReport::estimate() const {
  std::ostringstream text;
  text.precision(2);
  if (!is_known) {
    text << "There is no error estimate, since the scene has no " << of_what << " to normalise by"
         << (of_what == "energies" ? " except those of a common motion of all bodies"
                                   : ", neither of tools, nor between bodies, nor of supports");
    return Diagnostic(diagnostic::error_estimate, text.str());
  }
  const bool has_unknown =
      std::any_of(sources.begin(), sources.end(), [](const Source &source) { return !source.is_known; });
  text << "Estimated error " << (has_unknown ? "at least " : "") << percent(total()) << " % of the "
       << of_what;
  if (target > 0.)
    text << ", target " << percent(target) << " %";
  if (since > 0.) {
    text.precision(6);
    text << ", from time " << since << " on";
    text.precision(2);
  }
  text << ":";
  for (const auto &source : sources) {
    text << (&source == sources.data() ? " " : ", ") << source.name << " ";
    if (source.is_known)
      text << percent(source.error) << " %";
    else
      text << "unknown";
  }
  for (const auto &[name, value] : costs) {
    const bool is_count = value == std::floor(value);
    text.precision(is_count ? 15 : 3);
    text << (&name == &costs.front().first ? "; cost: " : ", ") << value << " " << name;
  }
  text << ". " << mesh_is_not_part(mesh, is_mesh_known);
  Diagnostic result(diagnostic::error_estimate, text.str());
  result.value("error", total()).value("target", target).value("mesh", mesh);
  for (const auto &source : sources)
    result.value(source.name, source.is_known ? source.error : std::nan(""));
  return result;
}

DiagnosticList ErrorReport::diagnostics() const {
  DiagnosticList messages{estimate()};
  if (!(target > 0.))
    return messages;
  const auto unknown =
      std::find_if(sources.begin(), sources.end(), [](const Source &source) { return !source.is_known; });
  std::ostringstream text;
  text.precision(2);
  const DiagnosticList excess = mesh_target > 0. ? DiagnosticList() : missed();
  if (!excess.empty()) {
    append(messages, excess);
  } else if (!is_known) {
    messages.push_back(
        Diagnostic(diagnostic::target_error_unknown,
                   "It is unknown whether the run meets the target, since there is no error estimate")
            .value("target", target));
  } else if (unknown != sources.end()) {
    text << "It is unknown whether the run meets the target: too few steps succeed to estimate the error due "
            "to "
         << unknown->name;
    messages.push_back(Diagnostic(diagnostic::target_error_unknown, text.str())
                           .value("target", target)
                           .advice(unknown->remedy));
  } else if (mesh > target && !(mesh_target > 0.)) {
    messages.push_back(Diagnostic(diagnostic::mesh_may_exceed_target,
                                  mesh_is_not_part(mesh, is_mesh_known) + ", more than the target")
                           .value("mesh", mesh)
                           .value("target", target));
  }
  return messages;
}

DiagnosticList ErrorReport::missed(const double of_levels) const {
  const double error = total() + of_levels, allowed = target + mesh_target;
  if (!(target > 0.) || !is_known || !(error > allowed))
    return {};
  const auto worst = std::max_element(sources.begin(), sources.end(),
                                      [](const Source &a, const Source &b) { return a.error < b.error; });
  std::ostringstream text;
  text.precision(2);
  text << "The estimated error, " << percent(error) << " %";
  if (of_levels > 0.)
    text << " with the " << percent(of_levels) << " % of the mesh";
  text << ", exceeds the target, " << percent(allowed) << " %; most of "
       << (of_levels > 0. ? "what is not of the mesh" : "it") << " is due to " << worst->name;
  return {Diagnostic(diagnostic::target_error_missed, text.str())
              .value("error", error)
              .value("target", allowed)
              .advice(worst->remedy)};
}

void ErrorReport::write(const std::string &folder) const {
  const std::string name = folder + "/error_estimate.csv";
  std::ofstream file(name);
  file << "quantity,value\n";
  if (target > 0.)
    file << "target," << target << "\n";
  const auto estimated = [this](const double error, const bool source_is_known) {
    return is_known && source_is_known ? error : std::nan("");
  };
  if (since > 0.)
    file << "since," << since << "\n";
  file << "error," << estimated(total(), knows_all()) << "\n";
  for (const auto &source : sources)
    file << source.name << "," << estimated(source.error, source.is_known) << "\n";
  file << "mesh," << mesh << "\n";
  file.precision(12);
  for (const auto &[what, value] : costs)
    file << what << "," << value << "\n";
  if (!file.flush())
    throw file_lost(name);
}

} // namespace billet
