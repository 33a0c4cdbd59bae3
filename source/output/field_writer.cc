// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/field_writer.h"

#include "billet/errors.h"
#include "billet/output/field_quantity.h"

#include <deal.II/fe/mapping_q_eulerian.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/data_out.h>

#include <boost/archive/text_iarchive.hpp>
#include <boost/archive/text_oarchive.hpp>
#include <boost/serialization/map.hpp>
#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <fstream>
#include <iomanip>
#include <sstream>

namespace billet {

using Format = parameters::Output::Format;

namespace {

/// Fields that are constant in an element, with their names and values.
struct CellFields {
  std::vector<std::string> names;
  std::vector<dealii::Vector<double>> values;
};

/// Quantities that are written, in the order of the files.
struct WrittenQuantities {
  explicit WrittenQuantities(const Scene &scene) {
    for (const ElementQuantity &quantity : field_quantities().of_elements())
      if (quantity.is_written(scene))
        of_elements.push_back(quantity);
    for (ElementQuantity &quantity : state_quantities(scene))
      of_elements.push_back(std::move(quantity));
    for (const ElementQuantity &quantity : of_elements) {
      if (quantity.has_layers)
        of_layers.push_back(quantity);
      read_states = read_states || quantity.reads_state;
    }
  }

  std::vector<ElementQuantity> of_elements, of_layers;
  bool read_states = false;
};

/// Averages of the elements of a body.
class BodyAverages {
public:
  BodyAverages(const Solution &solution, const Scene &scene, const std::size_t body,
               const WrittenQuantities &written, const bool has_layers)
      : body_(body), summaries_(solution.discretization().elements(body).size()) {
    if (!written.of_layers.empty())
      summaries_ = solution.summarize(body);
    if (has_layers && !written.of_layers.empty())
      layers_ = solution.summarize_layers(body);
    if (written.read_states) {
      fields_ = scene.bodies()[body].law->fields();
      states_ = solution.average_states(body);
    }
  }

  std::size_t size() const { return summaries_.size(); }
  ElementAverage operator()(const std::size_t element) const {
    return average(summaries_[element], element, 0);
  }
  /// Returns the average of a layer. With two points all layers have the element's.
  ElementAverage of_layer(const std::size_t element, const std::size_t layer) const {
    return layers_.empty() ? (*this)(element) : average(layers_[element][layer], element, 1 + layer);
  }

private:
  template <class Summary>
  ElementAverage average(const Summary &summary, const std::size_t element, const std::size_t place) const {
    ElementAverage result{body_, summary.cauchy_stress, summary.equivalent_plastic_strain, {}};
    if (!states_.empty())
      result.state = {fields_, states_[element][place]};
    return result;
  }

  std::size_t body_;
  std::vector<ElementSummary> summaries_;
  std::vector<LayerSummaries> layers_;
  std::vector<StateField> fields_;
  std::vector<StateAverages> states_;
};

CellFields collect_cell_fields(const Scene &scene, const Discretization &discretization,
                               const Solution &solution) {
  const WrittenQuantities written(scene);
  CellFields fields;
  const auto add_names = [&](const std::string &layer, const auto &quantities) {
    for (const ElementQuantity &quantity : quantities)
      for (const std::string &component : quantity.components)
        fields.names.push_back(layer + component);
  };
  add_names("", written.of_elements);
  const bool has_layers = std::any_of(scene.bodies().begin(), scene.bodies().end(),
                                      [](const Body &body) { return body.formulation.points_through > 2; }) &&
                          !scene.parameters().is_explicit();
  if (has_layers)
    for (const std::string name : layer_names)
      add_names(name + "_", written.of_layers);
  const auto n_cells = discretization.dof_handler().get_triangulation().n_active_cells();
  fields.values.assign(fields.names.size(), dealii::Vector<double>(n_cells));

  for (std::size_t body = 0; body < scene.bodies().size(); ++body) {
    const BodyAverages averages(solution, scene, body, written, has_layers);
    for (std::size_t e = 0; e < averages.size(); ++e) {
      const auto cell = discretization.elements(body)[e].cell->active_cell_index();
      std::size_t next = 0;
      const auto add = [&](const ElementAverage &average, const auto &quantities) {
        for (const ElementQuantity &quantity : quantities)
          for (const double value : quantity.evaluate(average))
            fields.values[next++](cell) = value;
      };
      add(averages(e), written.of_elements);
      if (has_layers)
        for (std::size_t layer = 0; layer < layer_names.size(); ++layer)
          add(averages.of_layer(e, layer), written.of_layers);
    }
  }
  return fields;
}

std::string numbered(const std::string &name, const unsigned int number, const std::string &ending) {
  std::ostringstream stream;
  stream << name << "_" << std::setw(5) << std::setfill('0') << number << ending;
  return stream.str();
}

} // namespace

FieldWriter::FieldWriter(const Scene &scene, const MPI_Comm communicator, std::string folder)
    : scene_(scene), communicator_(communicator), folder_(std::move(folder)),
      is_first_rank_(dealii::Utilities::MPI::this_mpi_process(communicator) == 0) {}

std::string FieldWriter::file_to_open() const {
  switch (scene_.parameters().output.format) {
  case Format::vtu:
    return folder_ + "/scene.pvd";
  case Format::hdf5:
    return folder_ + "/fields.xdmf (and " + folder_ + "/tools.pvd)";
  case Format::none:
    break;
  }
  return "";
}

void FieldWriter::write(const Solution &solution) {
  const Format format = scene_.parameters().output.format;
  if (format == Format::none)
    return;
  const SolutionState &state = solution.state();
  const Discretization &discretization = solution.discretization();

  // The snapshots show the deformed bodies.
  const dealii::MappingQEulerian<3, Vector> mapping(1, discretization.dof_handler(), state.displacements);
  dealii::DataOut<3> data_out;
  using Interpretation = dealii::DataComponentInterpretation::DataComponentInterpretation;
  std::vector<NodalField> nodal_fields;
  for (const NodalQuantity &quantity : field_quantities().nodal())
    for (NodalField &field : quantity.evaluate(scene_, discretization, solution))
      nodal_fields.push_back(std::move(field));
  for (const NodalField &field : nodal_fields)
    data_out.add_data_vector(
        discretization.dof_handler(), field.values,
        std::vector<std::string>(field.components.begin(), field.components.end()),
        std::vector<Interpretation>(3, field.is_vector
                                           ? dealii::DataComponentInterpretation::component_is_part_of_vector
                                           : dealii::DataComponentInterpretation::component_is_scalar));
  const CellFields cell_fields = collect_cell_fields(scene_, discretization, solution);
  for (std::size_t i = 0; i < cell_fields.names.size(); ++i)
    data_out.add_data_vector(cell_fields.values[i], cell_fields.names[i], dealii::DataOut<3>::type_cell_data);
  data_out.build_patches(mapping);

  Snapshot snapshot;
  snapshot.time = state.time;
  snapshot.tools = numbered("tools", n_written_, ".vtp");
  snapshot.fields = numbered("fields", n_written_, format == Format::vtu ? ".pvtu" : ".h5");
  std::string failure;
  try {
    if (format == Format::vtu)
      data_out.write_vtu_with_pvtu_record(folder_ + "/", "fields", n_written_, communicator_, 5, 1);
    else {
      // Vertices are not merged: cell data would be averaged across body interfaces.
      dealii::DataOutBase::DataOutFilter filter(dealii::DataOutBase::DataOutFilterFlags(false, true));
      data_out.write_filtered_data(filter);
      data_out.write_hdf5_parallel(filter, folder_ + "/" + snapshot.fields, communicator_);
      xdmf_entries_.push_back(data_out.create_xdmf_entry(filter, snapshot.fields, state.time, communicator_));
      data_out.write_xdmf_file(xdmf_entries_, folder_ + "/fields.xdmf", communicator_);
    }
  } catch (const std::exception &) { // deal.II throws various types
    failure = folder_ + "/" + snapshot.fields + " cannot be written. Check whether the disk is full";
  }
  fail_together(communicator_, [&failure] {
    if (!failure.empty())
      throw SolutionFailure(failure);
  });
  snapshots_.push_back(snapshot);
  ++n_written_;
  fail_together(communicator_, [&] {
    if (is_first_rank_) {
      write_tools(solution, snapshot.tools);
      write_index();
    }
  });
}

void FieldWriter::save(StateWriter &writer) const {
  std::vector<double> times;
  std::string names;
  for (const auto &snapshot : snapshots_) {
    times.push_back(snapshot.time);
    names += snapshot.fields + "\n" + snapshot.tools + "\n";
  }
  std::ostringstream entries;
  {
    boost::archive::text_oarchive archive(entries);
    archive << xdmf_entries_;
  }
  writer.write("written", {static_cast<double>(n_written_)});
  writer.write("times", times);
  writer.write_text("names", names);
  writer.write_text("xdmf", entries.str());
}

void FieldWriter::load(const StateReader &reader) {
  n_written_ = reader.count("written");
  std::istringstream names(reader.read_text("names"));
  for (const double time : reader.read("times")) {
    Snapshot snapshot;
    snapshot.time = time;
    std::getline(names, snapshot.fields);
    std::getline(names, snapshot.tools);
    snapshots_.push_back(snapshot);
  }
  std::istringstream entries(reader.read_text("xdmf"));
  boost::archive::text_iarchive archive(entries);
  archive >> xdmf_entries_;
}

void FieldWriter::write_tools(const Solution &solution, const std::string &name) const {
  const SolutionState &state = solution.state();
  const Discretization &discretization = solution.discretization();
  std::vector<dealii::Tensor<1, 3>> points;
  std::vector<std::vector<std::size_t>> facets;
  std::vector<std::size_t> tool_of_facet;
  for (std::size_t t = 0; t < scene_.tools().size(); ++t) {
    const SurfaceMesh surface_mesh = scene_.tools()[t].surface().surface_mesh(
        {state.placements[t].to_tool(discretization.centre()), 1.5 * discretization.radius()});
    for (const auto &facet : surface_mesh.facets) {
      facets.emplace_back();
      for (const unsigned int point : facet)
        facets.back().push_back(points.size() + point);
      tool_of_facet.push_back(t);
    }
    for (const auto &point : surface_mesh.points)
      points.push_back(state.placements[t].to_space(point));
  }
  std::ofstream out(folder_ + "/" + name);
  out << std::setprecision(9);
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
         "byte_order=\"LittleEndian\">\n<PolyData>\n"
      << "<Piece NumberOfPoints=\"" << points.size() << "\" NumberOfPolys=\"" << facets.size() << "\">\n"
      << "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n";
  for (const auto &point : points)
    out << point << "\n";
  out << "</DataArray></Points>\n<Polys>\n<DataArray type=\"Int32\" Name=\"connectivity\" "
         "format=\"ascii\">\n";
  for (const auto &facet : facets) {
    for (const auto point : facet)
      out << point << " ";
    out << "\n";
  }
  out << "</DataArray>\n<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">\n";
  std::size_t offset = 0;
  for (const auto &facet : facets)
    out << (offset += facet.size()) << " ";
  out << "\n</DataArray>\n</Polys>\n<CellData Scalars=\"tool\">\n<DataArray type=\"Int32\" Name=\"tool\" "
         "format=\"ascii\">\n";
  for (const auto tool : tool_of_facet)
    out << tool << " ";
  out << "\n</DataArray>\n</CellData>\n</Piece>\n</PolyData>\n</VTKFile>\n";
  out.close();
  if (!out)
    throw SolutionFailure(folder_ + "/" + name + " cannot be written. Check whether the disk is full");
}

void FieldWriter::write_index() const {
  const bool with_fields = scene_.parameters().output.format == Format::vtu;
  const std::string name = folder_ + (with_fields ? "/scene.pvd" : "/tools.pvd");
  std::ofstream out(name);
  out << std::setprecision(12) << "<?xml version=\"1.0\"?>\n"
      << "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n";
  const auto data_set = [&out](const double time, const std::string &part, const std::string &file) {
    out << R"(<DataSet timestep=")" << time << R"(" )" << part << R"( file=")" << file << "\"/>\n";
  };
  for (const auto &snapshot : snapshots_) {
    if (with_fields)
      data_set(snapshot.time, R"(part="0" name="bodies")", snapshot.fields);
    if (!scene_.tools().empty())
      data_set(snapshot.time, R"(part="1" name="tools")", snapshot.tools);
  }
  out << "</Collection>\n</VTKFile>\n";
  out.close();
  if (!out)
    throw SolutionFailure(name + " cannot be written");
}

} // namespace billet
