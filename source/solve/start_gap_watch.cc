// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/start_gap_watch.h"

#include "billet/contact/facing_gaps.h"
#include "billet/diagnostic_kinds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace billet {

namespace {

StartGaps sum_over_ranks(const StartGaps &own, const MPI_Comm communicator) {
  std::vector<double> sums{own.force, own.area, own.slide, own.facets}, ends{-own.least, own.largest};
  dealii::Utilities::MPI::sum(sums, communicator, sums);
  dealii::Utilities::MPI::max(ends, communicator, ends);
  return {sums[0], sums[1], sums[2], sums[3], -ends[0], ends[1]};
}

} // namespace

StartGapWatch::StartGapWatch(const Scene &scene) {
  const auto add_all = [&](const auto &pairs, const bool has_tool, const auto &bodies_of) {
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      double young_modulus = std::numeric_limits<double>::infinity();
      for (const std::size_t body : bodies_of(pairs[p]))
        young_modulus = std::min(young_modulus, scene.bodies()[body].young_modulus);
      // a rising penalty adds to the gaps.
      if (changes_gaps(pairs[p].overlap) && !pairs[p].is_raised)
        pairs_.push_back({p, has_tool, pairs[p].name, young_modulus});
    }
  };
  add_all(scene.pairs(), true, [](const ContactPair &pair) { return std::vector<std::size_t>{pair.body}; });
  add_all(scene.body_pairs(), false, [](const BodyPair &pair) {
    return std::vector<std::size_t>{pair.bodies[0], pair.bodies[1]};
  });
}

void StartGapWatch::add(const Contacts &contacts, const double t, const MPI_Comm communicator) {
  constexpr double large = 0.5; // part of the largest force so far
  for (Pair &pair : pairs_) {
    const StartGaps own = pair.has_tool ? contacts.of_tools()[pair.index].measures().start_gaps()
                                        : contacts.of_bodies()[pair.index].start_gaps();
    const StartGaps gaps = sum_over_ranks(own, communicator);
    pair.max_force = std::max(pair.max_force, gaps.force);
    if (!(gaps.force > large * pair.max_force) || !(gaps.slide > gaps.facets))
      continue;
    const double indentation = gaps.force / (pair.young_modulus * std::sqrt(gaps.area)),
                 part = (gaps.largest - gaps.least) / indentation;
    if (part > pair.part) {
      pair.part = part;
      pair.difference = gaps.largest - gaps.least;
      pair.slide = gaps.slide / gaps.force;
      pair.time = t;
    }
  }
}

DiagnosticList StartGapWatch::judge() const {
  constexpr double much = 0.1;
  DiagnosticList diagnostics;
  for (const Pair &pair : pairs_) {
    if (!(pair.part > much))
      continue;
    std::ostringstream text;
    text.precision(2);
    text << "The gaps or overlaps that count as none since the start differ by up to " << pair.difference
         << ", which is " << 100. * pair.part << " % of the elastic indentation, and the partner has slid by "
         << pair.slide;
    diagnostics.push_back(Diagnostic(diagnostic::uneven_start_gaps, text.str())
                              .pair(pair.name)
                              .time(pair.time)
                              .measure("difference / indentation", pair.part));
  }
  return diagnostics;
}

void StartGapWatch::save(StateWriter &writer) const {
  std::vector<double> numbers;
  for (const Pair &pair : pairs_)
    numbers.insert(numbers.end(), {pair.max_force, pair.part, pair.difference, pair.slide, pair.time});
  writer.write("start gaps", numbers);
}

void StartGapWatch::load(const StateReader &reader) {
  constexpr std::size_t of_pair = 5;
  if (!reader.has("start gaps"))
    return;
  const std::vector<double> numbers = reader.read("start gaps");
  if (numbers.size() != of_pair * pairs_.size())
    return; // saved for other pairs
  const double *next = numbers.data();
  for (Pair &pair : pairs_) {
    pair.max_force = next[0];
    pair.part = next[1];
    pair.difference = next[2];
    pair.slide = next[3];
    pair.time = next[4];
    next += of_pair;
  }
}

} // namespace billet
