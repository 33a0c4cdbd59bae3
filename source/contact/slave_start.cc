// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/slave_start.h"

#include "billet/contact/key_numbers.h"

#include <algorithm>
#include <unordered_map>

namespace billet {

namespace {

constexpr std::size_t touch_width = 9, pressed_width = 6; // of a slave

} // namespace

bool SlaveStart::pressed_anywhere() const {
  return std::any_of(pressed_.begin(), pressed_.end(), [](const Pressure &p) { return p.pressure > 0.; });
}

void SlaveStart::set(const std::size_t s, const TouchedFacet &touched,
                     const std::vector<SurfaceFacet> &facets, const Pressure &pressed) {
  touched_[s] = touched;
  if (touched.exists())
    facet_keys_[s] = facets[touched.facet].key;
  pressed_[s] = pressed;
}

void SlaveStart::find_facets(const std::vector<SurfaceFacet> &facets) {
  if (has_indices_)
    return;
  has_indices_ = true;
  std::unordered_map<std::uint64_t, unsigned int> index;
  for (unsigned int f = 0; f < facets.size(); ++f)
    index.emplace(facets[f].key, f);
  for (std::size_t s = 0; s < touched_.size(); ++s)
    if (touched_[s].exists()) {
      const auto found = index.find(facet_keys_[s]);
      touched_[s].facet = found == index.end() ? TouchedFacet::none : found->second;
    }
}

void SlaveStart::save(StateWriter &writer, const std::vector<std::uint64_t> &keys) const {
  std::vector<double> touches, pressed;
  RowWriter touch_row(touches), pressed_row(pressed);
  for (std::size_t s = 0; s < touched_.size(); ++s) {
    const TouchedFacet &touched = touched_[s];
    touch_row.number(touched.exists() ? 1. : 0.);
    write_key(touch_row, touched.exists() ? facet_keys_[s] : 0);
    touch_row.number(touched.offset)
        .number(touched.projection.parameters[0])
        .number(touched.projection.parameters[1])
        .vector(touched.projection.normal);
    const Pressure &slave = pressed_[s];
    pressed_row.number(slave.pressure).number(slave.penetration).number(slave.area).vector(slave.normal);
  }
  writer.write_rows("touched", touch_width, keys, touches);
  writer.write_rows("pressed", pressed_width, keys, pressed);
}

void SlaveStart::load(const StateReader &reader, const std::vector<std::uint64_t> &keys,
                      const bool has_started) {
  has_started_ = has_started;
  has_indices_ = false;
  // Slaves may be new if the pair had one pass before.
  std::vector<bool> is_known;
  const std::vector<double> touches = reader.read_rows("touched", touch_width, keys, &is_known);
  for (std::size_t s = 0; s < touched_.size(); ++s) {
    RowReader row(&touches[touch_width * s], touch_width);
    TouchedFacet &touched = touched_[s];
    touched = TouchedFacet();
    if (row.flag())
      touched.facet = 0; // find_facets() sets the index by its key
    facet_keys_[s] = read_key(row);
    touched.offset = row.number();
    touched.projection.parameters[0] = row.number();
    touched.projection.parameters[1] = row.number();
    row.vector(touched.projection.normal);
  }
  if (!reader.has("pressed"))
    return;
  const std::vector<double> pressed = reader.read_rows("pressed", pressed_width, keys, &is_known);
  for (std::size_t s = 0; s < pressed_.size(); ++s) {
    RowReader row(&pressed[pressed_width * s], pressed_width);
    pressed_[s].pressure = row.number();
    pressed_[s].penetration = row.number();
    pressed_[s].area = row.number();
    row.vector(pressed_[s].normal);
  }
}

} // namespace billet
