// SPDX-License-Identifier: LGPL-2.1-or-later
// What is written is what was computed: the contact fields are read back from the HDF5 file. Over the slave
// nodes the tractions times the areas are the tool's force; the pressure is the penalty times the
// penetration; the gap is the node's height over the plane; nodes that slide have slip and obey Coulomb's
// law; nodes that no pair names have none. The stress, constant in the elements, carries the same force
// through a section.
#include "../snapshot_file.h"
#include "scene_run.h"

#include "billet/output/field_writer.h"

#include <deal.II/base/mpi.h>

#include <filesystem>
#include <map>

namespace written_fields_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;
using dealii::Tensor;

namespace {

/// Returns a vector field at the corners of the elements.
std::vector<Tensor<1, 3>> read_vector(testing::SnapshotFile &file, const std::string &name) {
  std::vector<Tensor<1, 3>> values;
  for (unsigned int i = 0; i < 3; ++i) {
    const auto component = name.empty() ? file.positions(i) : file.read(name, i);
    values.resize(component.size());
    for (std::size_t k = 0; k < component.size(); ++k)
      values[k][i] = component[k];
  }
  return values;
}

} // namespace

BILLET_MPI_TEST(written_fields) {
  if (!testing::is_first_rank())
    std::cout.setstate(std::ios::failbit); // one rank speaks
  auto parameters = parameters::Scene::read(std::string(SOURCE_DIR) + "/block_on_plane.prm");
  // Pressed, then dragged until it slides.
  const double mu = 0.3;
  parameters.pairs[0].friction = make_coulomb(mu);
  parameters.bodies[0].supports[0].displacement.value = {"0.03*turn/pi", "0", "-0.01*press"};
  parameters.tools[0].motion.rotation_angle.value = "0";
  parameters.tools[0].motion.translation.value = {"0", "0", "0"};
  parameters.output.format = parameters::Output::Format::hdf5;
  SceneRun scene(parameters);
  const std::string folder = "written_fields";
  if (testing::is_first_rank())
    std::filesystem::create_directory(folder);
  MPI_Barrier(MPI_COMM_WORLD);
  FieldWriter writer(scene.scene, MPI_COMM_WORLD, folder);
  scene.finish();
  writer.write(scene.problem);

  testing::SnapshotFile fields(folder + "/fields_00000.h5", 1);
  const auto positions = read_vector(fields, "");
  const auto tractions = read_vector(fields, "contact_traction"),
             displacements = read_vector(fields, "displacement");
  const auto pressures = fields.read("contact_pressure"), gaps = fields.read("contact_gap");
  const auto slips = fields.read("contact_slip"), states = fields.read("contact_status");
  const auto areas = fields.read("contact_area"), pairs = fields.read("contact_pair");
  const auto stresses_zz = fields.read("stress_zz"), stresses_xz = fields.read("stress_xz");

  check("nodes are shared", fields.n_nodes() == 27);
  std::map<std::array<long, 3>, std::size_t> nodes;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Tensor<1, 3> start = positions[i] - displacements[i];
    nodes[{std::lround(4. * start[0]), std::lround(4. * start[1]), std::lround(4. * start[2])}] = i;
  }
  const double penalty = 10. * 1000. / 0.5; // 10 E/h
  Tensor<1, 3> force;
  double area = 0.;
  unsigned int n_slave = 0;
  bool all_slide = true;
  testing::WorstError gap_error, pressure_error, friction_error, idle_error;
  double min_slip = 1.;
  for (const auto &[start, i] : nodes) {
    if (start[2] != 0) {
      idle_error.add(std::abs(pressures[i]) + std::abs(gaps[i]) + std::abs(slips[i]) + std::abs(areas[i]) +
                     tractions[i].norm() + std::abs(states[i] + 1.) + std::abs(pairs[i] + 1.));
      continue;
    }
    ++n_slave;
    force += areas[i] * tractions[i];
    area += areas[i];
    gap_error.add(std::abs(gaps[i] - positions[i][2]));
    pressure_error.add(std::abs(pressures[i] + penalty * gaps[i]) / std::abs(pressures[i]));
    friction_error.add(std::abs(std::hypot(tractions[i][0], tractions[i][1]) / (mu * pressures[i]) - 1.));
    min_slip = std::min(min_slip, slips[i]);
    all_slide = all_slide && states[i] == static_cast<double>(ContactStatus::slip) && pairs[i] == 0.;
  }
  check("nodes of the block", nodes.size() == 27);
  check("nodes at the plane", n_slave == 9);
  check("status and pair: all slide on the one plane", all_slide);
  check("gap: height over the plane", gap_error.value(), 1e-6); // of the size of a float's last bit
  check("pressure: penalty times penetration", pressure_error.value(), 1e-6);
  check("traction: Coulomb's law", friction_error.value(), 1e-6);
  check("slip: there is some", min_slip > 1e-3);
  check("area: the face's, to first order in the strain", std::abs(area - 1.), 0.05);
  check("traction times area: the tool's force", (force - scene.load().force).norm() / force.norm(), 1e-6);
  check("other nodes: nothing", idle_error.value(), 1e-12);

  // The four lower elements; the vertices of each follow each other. Their stress balances the tool's force.
  double normal = 0., shear = 0.;
  unsigned int n_lower = 0;
  for (std::size_t e = 0; e < positions.size(); e += 8) {
    double height = 0.;
    for (std::size_t v = e; v < e + 8; ++v)
      height += (positions[v][2] - displacements[v][2]) / 8.;
    if (height > 0.5)
      continue;
    ++n_lower;
    normal += stresses_zz[e] / 4.;
    shear += stresses_xz[e] / 4.;
  }
  check("lower elements", n_lower == 4);
  check("stress: carries the normal force", std::abs(-normal * area / force[2] - 1.), 0.02);
  check("stress: carries the friction", std::abs(-shear * area / force[0] - 1.), 0.02);
}

} // namespace written_fields_test
