// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_couplings.h"

#include "billet/contact/key_numbers.h"
#include "billet/contact/node_list.h"
#include "billet/contact/slave_tangents.h"

#include <algorithm>

namespace billet {

std::vector<unsigned int> FacetCouplings::facets_of(const std::size_t s) const {
  const FacetSearch &search = parts_.surfaces.search();
  const SlaveState &state = parts_.touching[s];
  std::vector<unsigned int> facets;
  const auto add = [&](const unsigned int f) { facets.push_back(f); };
  if (parts_.overlaps)
    search.visit_around(parts_.slaves.node(s), [&](const unsigned int own) {
      parts_.overlaps->pairs().visit_facing(search, parts_.surfaces.positions_n(), own, add);
    });
  else {
    search.visit_candidates(s, add);
    if (state.presses()) { // where it may slide next
      add(state.touched.facet);
      search.visit_ring(state.touched.facet, add);
    }
  }
  if (state.presses())
    for (std::size_t i = state.first_share; i < state.end_of_shares; ++i)
      add(parts_.touching.shares()[i].facet);
  return facets;
}

void FacetCouplings::find(const ContactTangent kind,
                          const std::function<void(const std::vector<unsigned int> &)> &add) {
  const FacetSearch &search = parts_.surfaces.search();
  coupled_.assign(parts_.slaves.size(), {});
  for (std::size_t s = 0; s < parts_.slaves.size(); ++s) {
    const std::vector<unsigned int> facets = facets_of(s);
    if (facets.empty())
      continue;
    std::vector<unsigned int> nodes{parts_.slaves.node(s)};
    for (const unsigned int f : facets) {
      add_once(nodes, search.facets()[f].nodes);
      coupled_[s].push_back(search.facets()[f].key);
    }
    std::sort(coupled_[s].begin(), coupled_[s].end());
    if (follows_own_facets(kind) || parts_.overlaps)
      search.visit_around(parts_.slaves.node(s),
                          [&](const unsigned int f) { add_once(nodes, search.facets()[f].nodes); });
    add(nodes);
  }
}

bool FacetCouplings::has_new() const {
  for (std::size_t s = 0; s < parts_.touching.size(); ++s) {
    const SlaveState &state = parts_.touching[s];
    if (!state.presses() || !(state.own_area > 0.))
      continue;
    for (std::size_t i = state.first_share; i < state.end_of_shares; ++i)
      if (coupled_.empty() ||
          !std::binary_search(coupled_[s].begin(), coupled_[s].end(),
                              parts_.surfaces.facet(parts_.touching.shares()[i].facet).key))
        return true;
  }
  return false;
}

std::vector<double> FacetCouplings::numbers() const {
  std::vector<double> numbers;
  RowWriter row(numbers);
  for (const auto &keys : coupled_) {
    row.number(static_cast<double>(keys.size()));
    for (const std::uint64_t key : keys)
      write_key(row, key);
  }
  return numbers;
}

void FacetCouplings::set(const std::vector<double> &numbers) {
  coupled_.assign(parts_.slaves.size(), {});
  RowReader row(numbers);
  for (auto &keys : coupled_) {
    keys.resize(to_count(row.number(), numbers.size()));
    for (std::uint64_t &key : keys)
      key = read_key(row);
  }
}

} // namespace billet
