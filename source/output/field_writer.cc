// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/field_writer.h"

#include "billet/errors.h"
#include "billet/fail_together.h"
#include "billet/output/hdf5_grids.h"
#include "billet/output/paraview_script.h"
#include "billet/output/preview_grids.h"
#include "billet/output/snapshot_grids.h"
#include "billet/output/vtu_file.h"

#include <fstream>
#include <iomanip>
#include <sstream>

namespace billet {

using Format = parameters::Output::Format;

namespace {

std::string numbered(const std::string &name, const unsigned int number, const std::string &ending) {
  std::ostringstream stream;
  stream << name << "_" << std::setw(5) << std::setfill('0') << number << ending;
  return stream.str();
}

std::string cannot_write(const std::string &file) {
  return file + " cannot be written. Check whether the disk is full";
}

void write_text(const std::string &file, const std::string &text) {
  std::ofstream out(file);
  out << text;
  out.close();
  if (!out)
    throw SolutionFailure(cannot_write(file));
}

} // namespace

FieldWriter::FieldWriter(const Scene &scene, const MPI_Comm communicator, std::string folder)
    : scene_(scene), communicator_(communicator), folder_(std::move(folder)),
      is_first_rank_(dealii::Utilities::MPI::this_mpi_process(communicator) == 0) {}

std::string FieldWriter::index() const {
  switch (scene_.parameters().output.format) {
  case Format::vtu:
    return "scene.pvd";
  case Format::hdf5:
    return "fields.xdmf";
  case Format::none:
    break;
  }
  return "";
}

std::vector<std::string> FieldWriter::groups() const {
  std::vector<std::string> names = block_group::all;
  if (is_preview_)
    names.insert(names.end(), preview_group::all.begin(), preview_group::all.end());
  return names;
}

std::string FieldWriter::file_to_open(const std::string &folder) const {
  return index().empty()
             ? ""
             : folder + "/" + index() + " (or paraview --script=" + folder + "/" + paraview_script_name + ")";
}

void FieldWriter::write(const Solution &solution) {
  if (scene_.parameters().output.format != Format::none)
    write(solution, make_snapshot_grids(scene_, solution));
}

void FieldWriter::write_preview(const Solution &solution, const std::vector<Grid> &grids) {
  is_preview_ = true;
  write(solution, grids);
}

void FieldWriter::write(const Solution &solution, const std::vector<Grid> &grids) {
  const Format format = scene_.parameters().output.format;
  const double time = solution.state().time;
  if (format == Format::vtu)
    write_blocks(grids, time);
  else {
    const std::string file = numbered("fields", n_written_, ".h5");
    xdmf_grids_.push_back(write_hdf5(communicator_, folder_, file, time, groups(), grids));
    if (xdmf_grids_.back().empty())
      throw SolutionFailure(cannot_write(folder_ + "/" + file));
    snapshots_.push_back({time, file});
  }
  ++n_written_;
  fail_together(communicator_, [this] {
    if (is_first_rank_)
      write_index();
  });
}

void FieldWriter::write_blocks(const std::vector<Grid> &grids, const double time) {
  std::vector<GridFile> files;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    files.push_back(
        {grids[i].group, grids[i].name, numbered("fields", n_written_, "." + std::to_string(i) + ".vtu")});
    if (!write_vtu(communicator_, folder_ + "/" + files.back().file, grids[i]))
      throw SolutionFailure(cannot_write(folder_ + "/" + files.back().file));
  }
  snapshots_.push_back({time, numbered("fields", n_written_, ".vtm")});
  fail_together(communicator_, [&] {
    if (is_first_rank_)
      write_text(folder_ + "/" + snapshots_.back().file, multiblock_index(groups(), files));
  });
}

void FieldWriter::save(StateWriter &writer) const {
  std::vector<double> times;
  std::string names, grids;
  for (const auto &snapshot : snapshots_) {
    times.push_back(snapshot.time);
    names += snapshot.file + "\n";
  }
  for (const std::string &grid : xdmf_grids_)
    grids += grid;
  writer.write("written", {static_cast<double>(n_written_)});
  writer.write("times", times);
  writer.write_text("names", names);
  writer.write_text("xdmf", grids);
}

void FieldWriter::load(const StateReader &reader) {
  n_written_ = reader.count("written");
  std::istringstream names(reader.read_text("names"));
  for (const double time : reader.read("times")) {
    snapshots_.push_back({time, {}});
    std::getline(names, snapshots_.back().file);
  }
  xdmf_grids_ = {reader.read_text("xdmf")};
}

void FieldWriter::write_index() const {
  write_text(folder_ + "/" + paraview_script_name, paraview_script(index(), scene_, is_preview_));
  std::ostringstream out;
  if (scene_.parameters().output.format == Format::hdf5) {
    for (const std::string &grid : xdmf_grids_)
      out << grid;
    write_text(folder_ + "/" + index(), xdmf_index(out.str()));
    return;
  }
  out << std::setprecision(12) << "<?xml version=\"1.0\"?>\n"
      << "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const auto &snapshot : snapshots_)
    out << R"(<DataSet timestep=")" << snapshot.time << R"(" part="0" name="scene" file=")" << snapshot.file
        << "\"/>\n";
  out << "</Collection>\n</VTKFile>\n";
  write_text(folder_ + "/" + index(), out.str());
}

} // namespace billet
