// SPDX-License-Identifier: LGPL-2.1-or-later
// Faces from CAD files, by the OpenCASCADE with which deal.II may have been built. Projections onto
// planes, cylinders, cones, spheres and tori are in closed form. Those onto other surfaces use
// Newton's method from the nearest facet of a triangulation.
#include "billet/errors.h"
#include "billet/geometry/cad_file.h"
#include "billet/geometry/surface_type.h"

#include <deal.II/base/config.h>

#ifdef DEAL_II_WITH_OPENCASCADE
#include "billet/geometry/frame.h"
#include "billet/geometry/trimmed_surface.h"
#include "billet/trial.h"

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <ElCLib.hxx>
#include <ElSLib.hxx>
#include <GCPnts_TangentialDeflection.hxx>
#include <Geom2dAdaptor_Curve.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <IGESControl_Reader.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#endif

namespace billet {

namespace {

using Kind = TypeParameter::Kind;

#ifdef DEAL_II_WITH_OPENCASCADE

using dealii::Tensor;

constexpr double chord_angle = 0.2;       // maximum angle in the triangulation [radians]
constexpr double chord_deviation = 1e-3;  // over the size of the shape
constexpr double sewing_tolerance = 1e-5; // of loose faces, over the size of the shape

template <class Triple> Tensor<1, 3> tensor(const Triple &t) { return Tensor<1, 3>({t.X(), t.Y(), t.Z()}); }
gp_Pnt point(const Tensor<1, 3> &x) { return {x[0], x[1], x[2]}; }

/// Returns parameters along a curve, in space or in a plane, between which its direction changes
/// little.
template <class Curve> std::vector<double> sample(const Curve &curve) {
  if (curve.GetType() == GeomAbs_Line)
    return {curve.FirstParameter(), curve.LastParameter()};
  constexpr int min_points = 8;
  const GCPnts_TangentialDeflection points(curve, 0.5 * chord_angle, 1e100, min_points);
  std::vector<double> result;
  for (int i = 1; i <= points.NbPoints(); ++i)
    result.push_back(points.Parameter(i));
  return result;
}

/// Returns a function for the parameter of the nearest point of a curve, in closed form for lines
/// and circles.
std::function<double(const Tensor<1, 3> &)> nearest_on(const GeomAdaptor_Curve &curve) {
  const double first = curve.FirstParameter(), last = curve.LastParameter();
  if (curve.GetType() == GeomAbs_Line)
    return [line = curve.Line(), first, last](const Tensor<1, 3> &x) {
      return std::clamp(ElCLib::Parameter(line, point(x)), first, last);
    };
  if (curve.GetType() == GeomAbs_Circle)
    return [circle = curve.Circle(), first, last](const Tensor<1, 3> &x) {
      const double turned = ElCLib::Parameter(circle, point(x)) - first;
      const double t = first + turned - 2. * M_PI * std::floor(turned / (2. * M_PI));
      // The nearer end is the one that is nearer along the circle.
      return t <= last ? t : t - last < first + 2. * M_PI - t ? last : first;
    };
  const SampledCurve sampled(
      [curve](const double t) {
        gp_Pnt p;
        gp_Vec d, dd;
        curve.D2(t, p, d, dd);
        return CurvePoint{tensor(p), tensor(d), tensor(dd)};
      },
      sample(curve));
  return [sampled](const Tensor<1, 3> &x) { return sampled.nearest(x); };
}

TrimmedSurface::Edge convert(const TopoDS_Edge &edge, const TopoDS_Face &face) {
  double first = 0., last = 0.;
  const Handle(Geom2d_Curve) on_surface = BRep_Tool::CurveOnSurface(edge, face, first, last);
  TrimmedSurface::Edge result;
  result.on_surface = [on_surface](const double t) {
    const gp_Pnt2d p = on_surface->Value(t);
    return TrimmingLoops::Point{p.X(), p.Y()};
  };
  result.samples = sample(Geom2dAdaptor_Curve(on_surface, first, last));
  result.is_seam = BRep_Tool::IsClosed(edge, face);
  const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, first, last);
  result.is_pole = curve.IsNull();
  if (!result.is_pole) {
    result.nearest = nearest_on(GeomAdaptor_Curve(curve, first, last));
    result.position = [curve](const double t) { return tensor(curve->Value(t)); };
  }
  return result;
}

/// Returns the triangulation of a face, and `parameters` of its points.
TriangleMesh facets_of(const TopoDS_Face &face, std::vector<std::array<double, 2>> &parameters) {
  TriangleMesh mesh;
  TopLoc_Location location;
  const Handle(Poly_Triangulation) facets = BRep_Tool::Triangulation(face, location);
  if (facets.IsNull())
    throw Standard_Failure("a face cannot be triangulated");
  for (int i = 1; i <= facets->NbNodes(); ++i) {
    mesh.points.push_back(tensor(facets->Node(i).Transformed(location.Transformation())));
    parameters.push_back({facets->UVNode(i).X(), facets->UVNode(i).Y()});
  }
  for (int i = 1; i <= facets->NbTriangles(); ++i) {
    std::array<int, 3> corners{};
    facets->Triangle(i).Get(corners[0], corners[1], corners[2]);
    mesh.facets.emplace_back();
    for (unsigned int c = 0; c < 3; ++c)
      mesh.facets.back()[c] = static_cast<unsigned int>(corners[c] - 1);
  }
  return mesh;
}

SampledSurface sample(const TopoDS_Face &face, const GeomAdaptor_Surface &surface) {
  std::vector<std::array<double, 2>> parameters;
  TriangleMesh mesh = facets_of(face, parameters);
  const std::array<ParameterRange, 2> ranges{{{surface.FirstUParameter(), surface.LastUParameter(),
                                               surface.IsUPeriodic() != 0, surface.IsUClosed() != 0},
                                              {surface.FirstVParameter(), surface.LastVParameter(),
                                               surface.IsVPeriodic() != 0, surface.IsVClosed() != 0}}};
  SampledSurface::Surface evaluate = [surface](const double u, const double v) {
    gp_Pnt p;
    gp_Vec u_1, v_1, u_2, v_2, uv;
    surface.D2(u, v, p, u_1, v_1, u_2, v_2, uv);
    return SurfacePoint{tensor(p), tensor(u_1), tensor(v_1), tensor(u_2), tensor(uv), tensor(v_2)};
  };
  if (surface.GetType() == GeomAbs_Sphere) // directions without the poles of the parameters
    evaluate = [sphere = surface.Sphere()](const double u, const double v) {
      const Tensor<1, 3> p = tensor(ElSLib::Value(u, v, sphere)), arm = p - tensor(sphere.Location());
      const double radius = sphere.Radius(), turned = sphere.Direct() ? 1. : -1.;
      const Frame frame = Frame::from_normal(arm / radius);
      return SurfacePoint{p, radius * frame.q, turned * radius * frame.r, -arm, Tensor<1, 3>(), -arm};
    };
  return {evaluate, ranges, std::move(mesh), std::move(parameters)};
}

/// Returns the parameters of the nearest point on that sheet of a cone which contains the middle of
/// the face. ElSLib may choose the other one.
TrimmedSurface::Parameters project(const gp_Cone &cone, const double sheet, const Tensor<1, 3> &x) {
  const gp_Ax3 &axes = cone.Position();
  const Tensor<1, 3> arm = x - tensor(axes.Location());
  const double a = sheet * (arm * tensor(axes.XDirection())), b = sheet * (arm * tensor(axes.YDirection()));
  const double sine = std::sin(cone.SemiAngle()), cosine = std::cos(cone.SemiAngle());
  return {std::atan2(b, a),
          (sheet * std::hypot(a, b) - cone.RefRadius()) * sine + arm * tensor(axes.Direction()) * cosine};
}

/// Returns the projection in closed form, or nothing if there is none. `v` is a parameter of the
/// face.
std::function<TrimmedSurface::Parameters(const Tensor<1, 3> &)>
closed_form_of(const GeomAdaptor_Surface &surface, const double v) {
  const auto with = [](const auto &elementary) {
    return [elementary](const Tensor<1, 3> &x) {
      TrimmedSurface::Parameters result{};
      ElSLib::Parameters(elementary, point(x), result[0], result[1]);
      return result;
    };
  };
  switch (surface.GetType()) {
  case GeomAbs_Plane:
    return with(surface.Plane());
  case GeomAbs_Cylinder:
    return with(surface.Cylinder());
  case GeomAbs_Sphere:
    return with(surface.Sphere());
  case GeomAbs_Torus:
    return with(surface.Torus());
  case GeomAbs_Cone: {
    const gp_Cone cone = surface.Cone();
    const double sheet = cone.RefRadius() + v * std::sin(cone.SemiAngle()) < 0. ? -1. : 1.;
    return [cone, sheet](const Tensor<1, 3> &x) { return project(cone, sheet, x); };
  }
  default:
    return {};
  }
}

std::unique_ptr<const SurfacePatch> convert(const TopoDS_Face &face, const double side,
                                            const double edge_accuracy) {
  const GeomAdaptor_Surface surface(BRep_Tool::Surface(face));
  std::array<double, 2> low{}, high{};
  BRepTools::UVBounds(face, low[0], high[0], low[1], high[1]);
  std::vector<TrimmedSurface::Edge> edges;
  for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next())
    edges.push_back(convert(TopoDS::Edge(edge.Current()), face));
  Bnd_Box box;
  BRepBndLib::Add(face, box, false);
  return std::make_unique<TrimmedSurface>(TrimmedSurface::Description{
      sample(face, surface),
      closed_form_of(surface, 0.5 * (low[1] + high[1])),
      {surface.IsUPeriodic() ? surface.UPeriod() : 0., surface.IsVPeriodic() ? surface.VPeriod() : 0.},
      low,
      high,
      std::move(edges),
      face.Orientation() == TopAbs_REVERSED ? -side : side,
      edge_accuracy,
      {tensor(box.CornerMin()), tensor(box.CornerMax())}});
}

/// CAD file, of a surface in a scene or by itself.
class CadSource {
public:
  explicit CadSource(const TypeInput &input) : name_(input.file("File")), input_(&input) {}
  explicit CadSource(std::string name) : name_(std::move(name)) {}

  const std::string &name() const { return name_; }
  [[noreturn]] void reject(const std::string &allowed) const {
    if (input_ != nullptr)
      input_->reject("File", allowed);
    throw InputError("'" + name_ + "': allowed is " + allowed);
  }

private:
  std::string name_;
  const TypeInput *input_ = nullptr;
};

/// Whether the file is an IGES file, by the suffix of its name.
bool is_iges(const CadSource &source) {
  const std::string &name = source.name();
  const auto dot = name.rfind('.');
  std::string suffix = dot == std::string::npos ? "" : name.substr(dot + 1);
  for (char &letter : suffix)
    letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  if (suffix != "step" && suffix != "stp" && suffix != "iges" && suffix != "igs")
    source.reject("a file named *.step, *.stp, *.iges or *.igs");
  return suffix[0] == 'i';
}

double size_of(const TopoDS_Shape &shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, false);
  return box.IsVoid() ? 0. : std::sqrt(box.SquareExtent());
}

/// Refuses a shape whose edges miss their vertices or faces: OpenCASCADE then gives these large
/// tolerances.
void check_tolerances(const CadSource &source, const TopoDS_Shape &shape) {
  constexpr double allowed = 1e-3; // over the size of the shape; sound files have 1e-5
  double tolerance = 0.;
  for (const TopAbs_ShapeEnum kind : {TopAbs_VERTEX, TopAbs_EDGE})
    for (TopExp_Explorer part(shape, kind); part.More(); part.Next())
      tolerance =
          std::max(tolerance, kind == TopAbs_VERTEX ? BRep_Tool::Tolerance(TopoDS::Vertex(part.Current()))
                                                    : BRep_Tool::Tolerance(TopoDS::Edge(part.Current())));
  if (tolerance <= allowed * size_of(shape))
    return;
  std::ostringstream text;
  text.precision(2);
  text << "a file whose edges meet their vertices and faces; here they miss these by up to " << tolerance
       << " mm. It may be damaged. Write it again, or in the other format, STEP or IGES";
  source.reject(text.str());
}

std::string describe_kind(const TopoDS_Face &face) {
  const GeomAdaptor_Surface surface(BRep_Tool::Surface(face));
  std::ostringstream text;
  switch (surface.GetType()) { // of OpenCASCADE, with kinds that have no name here
  case GeomAbs_Plane:
    return "plane";
  case GeomAbs_Cylinder:
    text << "cylinder of radius " << surface.Cylinder().Radius();
    return text.str();
  case GeomAbs_Cone:
    return "cone";
  case GeomAbs_Sphere:
    text << "sphere of radius " << surface.Sphere().Radius();
    return text.str();
  case GeomAbs_Torus:
    text << "torus of radii " << surface.Torus().MajorRadius() << " and " << surface.Torus().MinorRadius();
    return text.str();
  default:
    return "free-form surface";
  }
}

/// Refuses faces without an end, which a damaged file has if a face lacks its edges.
void check_extents(const CadSource &source, const TopoDS_Shape &shape) {
  constexpr double max_extent = 1e12; // [mm]
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(shape, TopAbs_FACE, faces);
  for (int i = 1; i <= faces.Extent(); ++i) {
    Bnd_Box box;
    BRepBndLib::Add(faces(i), box, false);
    if (!box.IsVoid() && !box.IsOpen() && box.SquareExtent() <= max_extent * max_extent)
      continue;
    source.reject("a file whose faces have edges on all sides; face " + std::to_string(i) + ", a " +
                  describe_kind(TopoDS::Face(faces(i))) +
                  ", has no end. The file may be damaged. Write it again, or in the other format, STEP or "
                  "IGES");
  }
}

/// Reads a file. OpenCASCADE gives lengths in millimetres, whatever the file's unit.
TopoDS_Shape read_shape(const CadSource &source) {
  Message::DefaultMessenger()->RemovePrinters(
      STANDARD_TYPE(Message_Printer)); // otherwise they print on the console
  TopoDS_Shape shape;
  try {
    STEPControl_Reader step;
    IGESControl_Reader iges;
    XSControl_Reader &reader = is_iges(source) ? static_cast<XSControl_Reader &>(iges) : step;
    if (reader.ReadFile(source.name().c_str()) == IFSelect_RetDone && reader.TransferRoots() > 0)
      shape = reader.OneShape();
  } catch (const Standard_Failure &) { // leaves the shape empty
  }
  if (shape.IsNull())
    source.reject(is_iges(source) ? "an IGES file with a shape" : "a STEP file with a shape");
  check_extents(source, shape);
  check_tolerances(source, shape);
  return shape;
}

TopTools_IndexedMapOfShape faces_of(const TopoDS_Shape &shape) {
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(shape, TopAbs_FACE, faces);
  return faces;
}

/// Returns the faces that the user selected, as one shape.
TopoDS_Shape choose_faces(const TypeInput &input, const TopoDS_Shape &shape) {
  const TopTools_IndexedMapOfShape faces = faces_of(shape);
  if (faces.IsEmpty())
    input.reject("File", "a file with faces");
  const auto numbers = input.numbers("Faces");
  if (numbers.empty())
    return shape;
  TopoDS_Compound chosen;
  BRep_Builder builder;
  builder.MakeCompound(chosen);
  for (const double number : numbers) {
    if (number != std::floor(number) || number < 1. || number > faces.Extent())
      input.reject("Faces",
                   "whole numbers from 1 to " + std::to_string(faces.Extent()) + ", separated by commas");
    builder.Add(chosen, faces(static_cast<int>(number)));
  }
  return chosen;
}

/// Returns the maximum distance of coincident edges. An edge with only one face may duplicate an
/// edge of another face, within its tolerance.
double edge_accuracy(const TopoDS_Shape &shape) {
  TopTools_IndexedDataMapOfShapeListOfShape faces_of_edges;
  TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces_of_edges);
  double accuracy = 0.;
  for (int i = 1; i <= faces_of_edges.Extent(); ++i)
    if (faces_of_edges(i).Extent() == 1)
      accuracy = std::max(accuracy, BRep_Tool::Tolerance(TopoDS::Edge(faces_of_edges.FindKey(i))));
  return accuracy;
}

/// Reads the file of a surface, which defines a number of faces.
SurfacePatches convert_file(const TypeInput &input, const CadSource &source, const std::size_t n_defined) {
  const double scale = input.positive("Scale");
  const auto translation = input.vector("Translation");
  const TopoDS_Shape all = read_shape(source);
  if (const auto n_read = static_cast<std::size_t>(faces_of(all).Extent()); n_read < n_defined)
    source.reject("a file of which OpenCASCADE reads all " + std::to_string(n_defined) + " faces; it reads " +
                  std::to_string(n_read) +
                  ". The others may be damaged. Write it again, or in the other format, STEP or IGES");
  TopoDS_Shape shape = choose_faces(input, all);
  SurfacePatches patches;
  try {
    gp_Trsf placement;
    placement.SetScale(gp_Pnt(), scale);
    placement.SetTranslationPart(gp_Vec(translation[0], translation[1], translation[2]));
    shape = BRepBuilderAPI_Transform(shape, placement, true).Shape();
    if (is_iges(source)) { // in which each face has edges of its own
      BRepBuilderAPI_Sewing sewing(sewing_tolerance * size_of(shape));
      sewing.Add(shape);
      sewing.Perform();
      shape = sewing.SewedShape();
    }
    const BRepMesh_IncrementalMesh facets(shape, chord_deviation * size_of(shape), false, chord_angle);
    const double accuracy = edge_accuracy(shape);
    const TopTools_IndexedMapOfShape faces = faces_of(shape);
    for (int i = 1; i <= faces.Extent(); ++i)
      patches.push_back(convert(TopoDS::Face(faces(i)), side_sign(input), accuracy));
  } catch (const Standard_Failure &error) {
    source.reject(std::string("a file with sound faces; OpenCASCADE says: ") + error.GetMessageString());
  }
  return patches;
}

/// Refuses a file that is cut short or damaged as its text shows, and returns how many faces it
/// defines.
std::size_t check_text(const CadSource &source, const std::string &text) {
  const CadFileReport report = is_iges(source) ? check_iges_file(text) : check_step_file(text);
  if (!report.fault.empty())
    source.reject(std::string("a sound ") + (is_iges(source) ? "IGES" : "STEP") + " file; " + report.fault +
                  ". Write it again");
  return report.n_faces;
}

/// Returns what OpenCASCADE may need for a file of this size.
TrialLimits limits_for(const std::size_t n_bytes) {
  const std::size_t n_megabytes = n_bytes >> 20U;
  return {8 + 20 * static_cast<unsigned int>(n_megabytes), 2000 + 500 * n_megabytes};
}

/// Returns what `read` makes of a file that defines this number of faces. Refuses a damaged file
/// before that.
template <class Read> auto read_soundly(const CadSource &source, const Read &read) {
  std::ostringstream text;
  text << std::ifstream(source.name(), std::ios::binary).rdbuf();
  const std::size_t n_defined = check_text(source, text.str());
  const TrialLimits limits = limits_for(text.str().size());
  // OpenCASCADE trusts a file: some damaged ones end the program, or it never ends reading them.
  const TrialEnd end = try_in_copy(limits, [&] { read(n_defined); });
  const std::string advice = " This one may be damaged. Write it again, or with fewer faces";
  if (end == TrialEnd::crashed)
    source.reject("a sound file. OpenCASCADE crashes on this one: it is damaged, or cut short. Write "
                  "it again, or in the other format, STEP or IGES");
  if (end == TrialEnd::out_of_time)
    source.reject("a file that OpenCASCADE reads within " + std::to_string(limits.seconds) + " s." + advice);
  if (end == TrialEnd::out_of_memory)
    source.reject("a file that OpenCASCADE reads with " + std::to_string(limits.megabytes) + " MB." + advice);
  return read(n_defined);
}

SurfacePatches make(const TypeInput &input) {
  const CadSource source(input);
  return read_soundly(source,
                      [&](const std::size_t n_defined) { return convert_file(input, source, n_defined); });
}

std::vector<CadFace> list_faces(const CadSource &source) {
  const TopoDS_Shape shape = read_shape(source);
  const TopTools_IndexedMapOfShape faces = faces_of(shape);
  std::vector<std::set<std::size_t>> neighbours(static_cast<std::size_t>(faces.Extent()));
  TopTools_IndexedDataMapOfShapeListOfShape faces_of_edges;
  TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces_of_edges);
  for (int edge = 1; edge <= faces_of_edges.Extent(); ++edge)
    for (const TopoDS_Shape &one : faces_of_edges(edge))
      for (const TopoDS_Shape &other : faces_of_edges(edge))
        if (!one.IsSame(other))
          neighbours[static_cast<std::size_t>(faces.FindIndex(one)) - 1].insert(
              static_cast<std::size_t>(faces.FindIndex(other)));
  std::vector<CadFace> result;
  for (int i = 1; i <= faces.Extent(); ++i) {
    const TopoDS_Face &face = TopoDS::Face(faces(i));
    const auto &beside = neighbours[static_cast<std::size_t>(i) - 1];
    Bnd_Box box;
    BRepBndLib::AddOptimal(face, box, false, false);
    result.push_back({describe_kind(face),
                      {tensor(box.CornerMin()), tensor(box.CornerMax())},
                      {beside.begin(), beside.end()}});
  }
  return result;
}

#else

SurfacePatches make(const TypeInput &input) {
  input.reject("Shape", "another shape, since the deal.II of this program has no OpenCASCADE");
  return {};
}

#endif

} // namespace

#ifdef DEAL_II_WITH_OPENCASCADE
std::vector<CadFace> list_cad_faces(const std::string &file_name) {
  if (!std::ifstream(file_name))
    throw InputError("'" + file_name + "' cannot be read; allowed is the name of a STEP or IGES file");
  const CadSource source(file_name);
  return read_soundly(source, [&](std::size_t /*n_defined*/) { return list_faces(source); });
}
#else
std::vector<CadFace> list_cad_faces(const std::string &file_name) {
  throw InputError("'" + file_name +
                   "' cannot be read, since the deal.II of this program has no OpenCASCADE");
}
#endif

SurfaceType cad_type() {
  return {
      "CAD",
      "Faces of a CAD file, STEP or IGES. Requires deal.II with OpenCASCADE.",
      {{"File", "", Kind::text,
        "Name of the file (*.step, *.stp, *.iges, *.igs), relative to the scene file."},
       {"Scale", "1", Kind::number,
        "> 0. Factor from the file's lengths, in millimetres, to lengths of the scene."},
       {"Translation", "0, 0, 0", Kind::text, "Position of the file's origin. [length]"},
       {"Faces", "", Kind::text,
        "Numbers of the faces to use, separated by commas; 'billet --list faces FILE' shows them. Without "
        "a fillet between two faces, these end at sharp edges. Empty: all."},
       {"Side", "outside", Kind::choice,
        "outside|inside: Side of the bodies. The normals of the faces, out of a solid, point to the "
        "outside."}},
      make};
}

} // namespace billet
