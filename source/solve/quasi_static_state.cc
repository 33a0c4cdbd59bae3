// SPDX-License-Identifier: LGPL-2.1-or-later
// What a quasi-static scene gives to a checkpoint, and how it goes on from one.
#include "billet/errors.h"
#include "billet/solve/quasi_static.h"

#include <Epetra_Vector.h>

#include <algorithm>
#include <cmath>

namespace billet {

namespace {

const char *scheme_of(const bool is_dynamic) { return is_dynamic ? "implicit dynamics" : "quasi-static"; }

Epetra_Vector &as_epetra(Vector &vector) { return *vector.trilinos_vector()(0); }

} // namespace

void QuasiStatic::save(StateWriter &writer) const {
  const NodeKeys keys(discretization_);
  const OwnedNodes nodes(discretization_, keys);
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(discretization_.communicator());
  writer.write_text("scheme", scheme_of(motion_ != nullptr));
  writer.write("time", {state_.time});
  writer.write("energies", to_numbers(state_.energies));
  save_nodal(writer, "displacements", nodes, u_n_);
  save_nodal(writer, "increment", nodes, last_increment_);
  save_nodal(writer, "support forces", nodes, support_forces_n_);
  writer.write("scales", {lasting_scale_, has_lost_pace_ ? 1. : 0.});
  writer.write_text("free body", body_failure_);
  soft_penalties_.save(writer);
  penalties_.save(writer);
  if (softness_.is_used())
    writer.write("softness", softness_.save());
  writer.write("forces on bodies", body_forces_n_);
  writer.write("largest forces on bodies", largest_forces_);
  save_nodal(writer, "internal forces", nodes, internal_forces_n_);
  save_nodal(writer, "contact forces", nodes, contact_forces_n_);
  writer.write("largest energy", {largest_energy_});
  writer.write("contact balance", {contact_balance_});
  writer.write("round-off", round_off_.save());
  writer.write("rejected step", step_energy_.save());
  if (!body_frames_.empty())
    writer.write("free modes", {static_cast<double>(support_.n_free)});
  save_stabilisation(writer);
  if (tangent_ != scene_.contact_tangent())
    writer.write("exact tangent", {1.});
  if (probe_ && probe_->time > state_.time)
    writer.in("probe", [&] {
      writer.write("time", {probe_->time});
      writer.write("offsets", probe_->offsets);
      save_nodal(writer, "displacements", nodes, probe_->displacements);
    });
  if (motion_) {
    writer.write("kinetic energy", {state_.energies.kinetic});
    writer.write("element balance", {element_balance_});
    writer.write("damps contact", {motion_->damps_contact() ? 1. : 0.});
    writer.write("contact losses", contact_losses_.save());
    motion_->save(writer, nodes);
  }
  for (std::size_t b = 0; b < scene_.bodies().size(); ++b)
    writer.in(group("body", b), [&] {
      writer.write_text("formulation", describe(scene_.bodies()[b].formulation));
      const ElementBlock &block = internal_.block(b);
      const std::size_t width = block.state_size();
      if (scene_.bodies()[b].formulation.points_through > 2)
        save_thickness_axes(writer, block, element_keys(discretization_, b));
      if (width == 0)
        return;
      std::vector<double> rows(width * block.size());
      for (std::size_t e = 0; e < block.size(); ++e)
        block.get_state(e, rows.data() + width * e);
      writer.write_rows("history", width, element_keys(discretization_, b), rows);
    });
  for (std::size_t i = 0; i < scene_.tools().size(); ++i)
    writer.in(group("tool", i), [&] {
      writer.write_text("name", scene_.tools()[i].name());
      const double last = i < last_offset_increments_.size() ? last_offset_increments_[i] : 0.;
      writer.write("offset", {offsets_n_[i], last});
      writer.write("flags", {stopped_[i] ? 1. : 0., fading_forces_[i] ? 1. : 0.});
      writer.write("placement", to_numbers(state_.placements[i]));
      writer.write("load", to_numbers(state_.tool_loads[i]));
      if (motion_)
        motion_->save_tool(i, writer);
      if (!fading_forces_[i])
        return;
      // The force on the nodes is less than the residual by its sign.
      std::vector<std::uint64_t> fading_keys;
      std::vector<double> forces;
      for (std::size_t n = 0; n < nodes.keys.size(); ++n) {
        const DofIndex dof = nodes.first_dofs[n];
        const std::array<double, 3> force{-(*fading_forces_[i])(dof), -(*fading_forces_[i])(dof + 1),
                                          -(*fading_forces_[i])(dof + 2)};
        if (force[0] == 0. && force[1] == 0. && force[2] == 0.)
          continue;
        fading_keys.push_back(nodes.keys[n]);
        forces.insert(forces.end(), force.begin(), force.end());
      }
      save_parts(writer, "fading", rank, fading_keys, forces);
    });
  for (std::size_t p = 0; p < contacts_.size(); ++p)
    writer.in(group("pair", p), [&] {
      save_pair(writer, scene_, scene_.pairs()[p]);
      contacts_[p].save(writer, keys);
    });
  for (std::size_t p = 0; p < body_contacts_.size(); ++p)
    writer.in(group("body pair", p), [&] {
      save_pair(writer, scene_, scene_.body_pairs()[p]);
      writer.write("load", to_numbers(state_.body_pair_loads[p]));
      body_contacts_[p]->save(writer);
      body_contacts_[p]->save_couplings(writer);
    });
  if (imbalance_) {
    writer.write("release", {imbalance_begin_, imbalance_end_});
    save_nodal(writer, "imbalance", nodes, *imbalance_);
  }
}

RestartReport QuasiStatic::load(StateReader &reader, const double release_time) {
  const NodeKeys keys(discretization_);
  const OwnedNodes nodes(discretization_, keys);
  RestartReport report;
  const std::string scheme = reader.read_text("scheme");
  const bool is_implicit = scheme != "explicit", is_own = scheme == scheme_of(motion_ != nullptr);
  report.is_exact = is_own;
  compare_parts(reader, scene_, report);
  state_.energies = to_energies(reader.read("energies"));
  load_nodal(reader, is_implicit ? "displacements" : "displacements before", nodes, u_n_);
  state_.displacements = u_n_;
  trial_ = u_n_;
  trial_ghosted_ = u_n_;
  state_.time = time_ = report.time = reader.number(is_implicit ? "time" : "time before");
  if (!motion_ && reader.has("kinetic energy"))
    report.kinetic_energy = reader.number("kinetic energy");
  for (std::size_t b = 0; b < scene_.bodies().size(); ++b)
    reader.in(group("body", b), [&] {
      ElementBlock &block = internal_.block(b);
      const ElementFormulation &formulation = scene_.bodies()[b].formulation;
      bool is_same = reader.read_text("formulation") == describe(formulation);
      if (is_same && formulation.points_through > 2) {
        const bool has_same_axes =
            load_thickness_axes(reader, element_keys(discretization_, b)) == block.thickness_axes();
        is_same = dealii::Utilities::MPI::min(has_same_axes ? 1 : 0, discretization_.communicator()) == 1;
      }
      if (is_same) {
        const std::size_t width = block.state_size();
        if (width == 0)
          return;
        const auto rows = reader.read_rows("history", width, element_keys(discretization_, b));
        for (std::size_t e = 0; e < block.size(); ++e)
          block.set_state(e, rows.data() + width * e);
        return;
      }
      report.is_exact = false;
      const auto stresses = load_stress(reader, scene_, b, discretization_, state_.displacements);
      for (std::size_t e = 0; e < block.size(); ++e)
        block.set_stress(e, gather(state_.displacements, discretization_.elements(b)[e].dofs), stresses[e]);
    });
  load_tools(reader);
  load_contacts(reader);
  update_contacts(reader, report.is_exact);
  spring_round_off_ = find_spring_round_off(); // of penalties as they are by now
  if (is_own) {
    load_nodal(reader, "increment", nodes, last_increment_);
    load_nodal(reader, "support forces", nodes, support_forces_n_);
    load_nodal(reader, "contact forces", nodes, contact_forces_n_);
    load_nodal(reader, "internal forces", nodes, internal_forces_n_);
    largest_energy_ = reader.number("largest energy");
    contact_balance_ = reader.number("contact balance");
    round_off_.load(reader.read("round-off"));
    step_energy_.load(reader.read("rejected step"));
    if (motion_) {
      element_balance_ = reader.number("element balance");
      contact_losses_.load(reader.read("contact losses"));
      if (reader.number("damps contact") != 0.)
        motion_->damp_contact(contact_forces_n_); // the next step begins with that anew
    }
    soft_penalties_.load(reader);
    penalties_.load(reader);
    load_stabilisation(reader);
    if (report.is_exact && reader.has("forces on bodies")) {
      body_forces_n_ = reader.read("forces on bodies");
      largest_forces_ = reader.read("largest forces on bodies");
    }
    if (report.is_exact && softness_.is_used() && reader.has("softness"))
      softness_.load(reader.read("softness"));
    if (report.is_exact && reader.has("probe"))
      reader.in("probe", [&] {
        probe_ =
            std::make_unique<ProbedState>(ProbedState{reader.number("time"), u_n_, reader.read("offsets")});
        load_nodal(reader, "displacements", nodes, probe_->displacements);
      });
    if (reader.has("exact tangent"))
      take_exact_tangent();
    const std::vector<double> scales = reader.read("scales");
    lasting_scale_ = scales.at(0);
    has_lost_pace_ = scales.at(1) != 0.;
    if (report.is_exact)
      body_failure_ = reader.read_text("free body");
    if (reader.has("release")) {
      imbalance_ = std::make_unique<Vector>(discretization_.make_owned_vector());
      load_nodal(reader, "imbalance", nodes, *imbalance_);
      imbalance_begin_ = reader.read("release").at(0);
      imbalance_end_ = reader.read("release").at(1);
    }
  }
  if (!report.is_exact)
    balance(report);
  if (!body_frames_.empty()) {
    if (report.is_exact && reader.has("free modes"))
      support_.n_free = static_cast<std::size_t>(reader.number("free modes"));
    else if (!report.is_exact)
      support_ = find_support();
  }
  if (motion_)
    load_motion(reader, report);
  else if (!report.is_exact) {
    const double end = scene_.parameters().time_stepping.end_time;
    imbalance_end_ = release_time > 0. ? std::min(end, imbalance_begin_ + release_time) : end;
  }
  report.release_end = imbalance_ ? imbalance_end_ : state_.time;
  return report;
}

void QuasiStatic::load_tools(StateReader &reader) {
  last_offset_increments_.assign(offsets_.size(), 0.);
  const NodeKeys keys(discretization_);
  const OwnedNodes nodes(discretization_, keys);
  for (std::size_t i = 0; i < scene_.tools().size(); ++i) {
    state_.placements[i] = scene_.tools()[i].placement(state_.time);
    const auto found = find_group(reader, "tool", scene_.tools()[i].name());
    if (!found)
      continue;
    reader.in(group("tool", *found), [&] {
      const std::vector<double> offset = reader.read("offset"), flags = reader.read("flags");
      offsets_n_[i] = offset.at(0);
      last_offset_increments_[i] = offset.at(1);
      state_.placements[i] = to_placement(reader.read("placement"));
      state_.tool_loads[i] = to_contact_load(reader.read("load"));
      if (flags.at(0) != 0.)
        stopped_[i] = std::make_unique<Placement>(state_.placements[i]);
      if (flags.at(1) == 0.)
        return;
      const std::vector<double> forces = load_sums(reader, "fading", nodes.keys);
      fading_forces_[i] = std::make_unique<Vector>(discretization_.make_owned_vector());
      for (std::size_t n = 0; n < nodes.keys.size(); ++n)
        for (unsigned int c = 0; c < 3; ++c)
          (*fading_forces_[i])(nodes.first_dofs[n] + c) = -forces[3 * n + c];
      fading_forces_[i]->compress(dealii::VectorOperation::insert);
    });
  }
  offsets_ = offsets_n_;
}

void QuasiStatic::load_contacts(StateReader &reader) {
  const NodeKeys keys(discretization_);
  for (std::size_t p = 0; p < contacts_.size(); ++p) {
    const ContactPair &pair = scene_.pairs()[p];
    contacts_[p].set_allowed_part(pair.overlap.allowed_part(state_.time));
    const auto found = find_group(reader, "pair", pair.name);
    if (found)
      reader.in(group("pair", *found), [&] {
        check_partners(reader, pair.name, partners(scene_, pair));
        contacts_[p].load(reader, keys);
      });
    else
      contacts_[p].begin(state_.placements[pair.tool], state_.displacements);
  }
  for (std::size_t p = 0; p < body_contacts_.size(); ++p) {
    const BodyPair &pair = scene_.body_pairs()[p];
    const auto found = find_group(reader, "body pair", pair.name);
    if (found)
      reader.in(group("body pair", *found), [&] {
        check_partners(reader, pair.name, partners(scene_, pair));
        body_contacts_[p]->load(reader);
        if (reader.has("load"))
          state_.body_pair_loads[p] = to_contact_load(reader.read("load"));
      });
    else {
      body_contacts_[p]->begin(state_.displacements);
      body_contacts_[p]->update(state_.displacements, 0.);
      body_contacts_[p]->allow_overlap();
    }
  }
}

void QuasiStatic::update_contacts(StateReader &reader, const bool is_exact) {
  if (body_contacts_.empty())
    return;
  bool couplings_are_known = is_exact;
  for (std::size_t p = 0; p < body_contacts_.size(); ++p) {
    BodyContact &contact = *body_contacts_[p];
    contact.start_step(state_.time, state_.time);
    contact.update(state_.displacements, 0.);
    if (const auto found = find_group(reader, "body pair", scene_.body_pairs()[p].name);
        couplings_are_known && found)
      reader.in(group("body pair", *found),
                [&] { couplings_are_known = contact.load_couplings(reader, tangent_); });
  }
  build_matrix(couplings_are_known);
}

void QuasiStatic::balance(RestartReport &report) {
  for (auto &contact : contacts_) {
    const Placement &now = state_.placements[contact.tool()];
    contact.start_step(now, now, 0.);
  }
  duration_ = 0.;
  imbalance_.reset();
  choose_unknown_tools({});
  Vector residual = discretization_.make_owned_vector();
  if (!compute_residual(as_epetra(u_n_), as_epetra(residual)))
    throw InputError("its state is not admissible here: elements are inside out, or forces not finite");
  report.imbalance = residual.l2_norm();
  report.force_scale = force_scale_;
  lasting_scale_ = std::max(lasting_scale_, 1e-3 * force_scale_);
  support_forces_n_ = support_forces_;
  contact_forces_n_ = contact_forces_;
  internal_forces_n_ = internal_forces_;
  std::fill(state_.tool_loads.begin(), state_.tool_loads.end(), ContactLoad());
  state_.energies.contact = 0.;
  for (const auto &contact : contacts_)
    state_.tool_loads[contact.tool()] += contact.compute_load();
  for (const auto &load : state_.tool_loads)
    state_.energies.contact += load.stored_energy;
  for (std::size_t p = 0; p < body_contacts_.size(); ++p) {
    state_.body_pair_loads[p] = body_contacts_[p]->compute_load();
    state_.energies.contact += state_.body_pair_loads[p].stored_energy;
  }
  // What has gone with the interruption is no drift.
  EnergyLedger &energies = state_.energies;
  const double drift = energies.drift();
  const auto now = internal_.compute_energies(state_.displacements);
  if (!motion_)
    energies.kinetic = 0.;
  energies.hourglass = now.hourglass;
  energies.elastic = now.elastic;
  energies.plastic = now.plastic;
  energies.initial += drift - energies.drift();
  if (motion_)
    return;
  imbalance_ = std::make_unique<Vector>(residual);
  imbalance_begin_ = state_.time;
}

void QuasiStatic::load_motion(StateReader &reader, RestartReport &report) {
  const OwnedNodes nodes(discretization_, NodeKeys(discretization_));
  if (report.is_exact) {
    motion_->load(reader, nodes);
  } else {
    report.imbalance = 0.; // it accelerates the bodies
    motion_->begin(reader, nodes, state_.time);
  }
  for (std::size_t i = 0; i < scene_.tools().size(); ++i)
    if (const auto found = find_group(reader, "tool", scene_.tools()[i].name()))
      reader.in(group("tool", *found), [&] { motion_->load_tool(i, reader, report.is_exact); });
  if (report.is_exact) {
    motion_->update_state(state_);
    return;
  }
  update_accelerations();
  const double drift = state_.energies.drift();
  motion_->update_state(state_);
  state_.energies.initial += drift - state_.energies.drift(); // velocities that begin are no drift
}

double QuasiStatic::imbalance_left(const double t) const {
  if (!imbalance_ || t >= imbalance_end_)
    return 0.;
  return 1. - (t - imbalance_begin_) / (imbalance_end_ - imbalance_begin_);
}

} // namespace billet
