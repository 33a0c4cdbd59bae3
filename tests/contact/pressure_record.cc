// SPDX-License-Identifier: LGPL-2.1-or-later
// Pressures of nodes on a tool at the start of a step: recorded with the tool, without multipliers, kept by
// stiffer penalties, and saved.
#include "billet/contact/pressure_record.h"

#include "memory_state.h"

#include "../testing.h"

namespace pressure_record_test {

using namespace billet;
using namespace billet::testing;
using dealii::Tensor;

BILLET_TEST(pressure_record) {
  Random random;
  Placement placement;
  placement.rotation = random.rotation();
  placement.translation = random.vector(1.);
  placement.centre = random.vector(1.);
  std::vector<ContactPoint> nodes(2);
  std::vector<ToolContactState> states(2);
  for (auto &state : states)
    state.position = random.vector(1.);
  states[0].pressure = 3.;
  states[0].gap = -0.5;
  states[0].normal = placement.rotation * Tensor<1, 3>({0., 0., 1.});
  states[1].gap = -0.2; // behind an edge, without contact
  nodes[0].multiplier_offset = 0.125;

  PressureRecord record;
  check("nothing is known at first", !record.is_known() && !record.has_pressure());
  record.record(states, nodes, placement);
  check("a recorded pressure", record.is_known() && record.has_pressure() && record[0].pressure == 3.);
  check("  its penetration is that of the spring",
        record[0].penetration == 0.375 && record[1].penetration == 0.);
  check("  in the tool's coordinates",
        (record[0].normal - Tensor<1, 3>({0., 0., 1.})).norm() +
            (placement.to_space(record[0].position) - states[0].position).norm() +
            (placement.to_space(record[1].position) - states[1].position).norm(),
        1e-14);
  record.divide_penetration(0, 3.);
  check("a stiffer penalty is pressed less deep", record[0].penetration == 0.125 && record[0].pressure == 3.);

  MemoryState saved;
  MemoryWriter writer(saved);
  record.save(writer, {"", 0, 2, {5, 4}});
  PressureRecord loaded;
  loaded.record({ToolContactState(), ToolContactState()}, nodes, Placement());
  check("without pressure", loaded.is_known() && !loaded.has_pressure());
  loaded.load(MemoryReader(saved), {"", 0, 2, {4, 5}});
  check("a saved record", loaded[1].pressure == 3. && loaded[1].penetration == 0.125 &&
                              loaded[1].normal == record[0].normal &&
                              loaded[0].position == record[1].position);
  loaded.set_known(false);
  loaded.divide_penetration(1, 2.);
  MemoryState empty;
  MemoryWriter writer_of_nothing(empty);
  loaded.save(writer_of_nothing, {"", 0, 2, {5, 4}});
  check("a record that is not known is not saved", empty.rows.empty() && !loaded.has_pressure());
}

} // namespace pressure_record_test
