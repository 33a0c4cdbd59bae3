// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/certificate.h"

#include "billet/material/law_trials.h"
#include "billet/material/law_type.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace billet {

Finding Finding::judge(std::string property, const double value, const double allowed, std::string remark) {
  return {std::move(property), value, allowed, std::move(remark),
          value <= allowed ? Verdict::passed : Verdict::failed}; // not a number: failed
}

bool Certificate::has_passed() const {
  return std::none_of(findings.begin(), findings.end(),
                      [](const Finding &finding) { return finding.verdict == Finding::Verdict::failed; });
}

Certificate certify(const PointLaw &law, const CertificationSettings &settings) {
  const auto start = std::chrono::steady_clock::now();
  Certificate certificate;
  certificate.law = describe_law(law);
  for (const auto trial : {&try_objectivity, &try_tangent, &try_energies, &try_steps, &try_repeated_stretches,
                           &try_units, &try_checkpoint, &try_cost})
    for (Finding &finding : trial(law, settings))
      certificate.findings.push_back(std::move(finding));
  certificate.ranges = find_safe_ranges(law, settings);
  certificate.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return certificate;
}

} // namespace billet
