// SPDX-License-Identifier: LGPL-2.1-or-later
// Surfaces from CAD files that OpenCASCADE writes here: closed forms, trimmed faces, free-form faces, STEP
// and IGES.
#include "check_surface.h"

#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <GeomAPI_PointsToBSplineSurface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Writer.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Writer.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Ax2.hxx>

namespace cad_test {

using namespace billet;
using namespace billet::testing;
using dealii::Tensor;

namespace {

SharedSurface through_step(const TopoDS_Shape &shape, const std::string &lines = "") {
  STEPControl_Writer writer;
  writer.Transfer(shape, STEPControl_AsIs);
  writer.Write("shape.step");
  return make_surface("CAD", "set File = shape.step\n" + lines);
}

SharedSurface through_iges(const TopoDS_Shape &shape) {
  IGESControl_Controller::Init();
  IGESControl_Writer writer("MM", 0); // faces, no solids
  writer.AddShape(shape);
  writer.ComputeModel();
  writer.Write("shape.iges");
  return make_surface("CAD", "set File = shape.iges");
}

/// Two descriptions of one surface, outside of curvature centres and edges within: gap, normal and turning.
void check_same(const std::string &name, const SharedSurface &surface, const SharedSurface &truth,
                const double reach, const double tolerance) {
  Random random;
  WorstError gap, normal, turning;
  unsigned int n = 0;
  for (unsigned int i = 0; i < 2000; ++i) {
    const auto x = random.vector(i % 10 == 0 ? 30. * reach : reach);
    const auto a = surface->project(x), b = truth->project(x);
    if (!b.exists || b.turning.norm() > 100. / reach)
      continue;
    ++n;
    gap.add(a.exists ? std::abs(a.gap - b.gap) / reach : 1.);
    normal.add((a.normal - b.normal).norm());
    turning.add((a.turning - b.turning).norm() / (1. + b.turning.norm()));
  }
  check(name + ": there are points", n > 50);
  check(name + ": gap", gap.value(), tolerance);
  check(name + ": normal", normal.value(), 10. * tolerance);
  check(name + ": turning", turning.value(), 1000. * tolerance);
}

/// Next to the axis of a torus, where all of its ring is nearly as near, and facets do not tell the nearest.
void check_near_axis() {
  const auto torus = through_step(BRepBuilderAPI_NurbsConvert(BRepPrimAPI_MakeTorus(3., 1.).Shape()).Shape());
  Random random;
  WorstError error;
  for (unsigned int i = 0; i < 200; ++i) {
    const Tensor<1, 3> x({random(-1e-3, 1e-3), random(-1e-3, 1e-3), random(-2., 2.)});
    error.add(std::abs(torus->project(x).gap - (std::hypot(3. - std::hypot(x[0], x[1]), x[2]) - 1.)));
  }
  check("torus as a spline, next to its axis", error.value(), 1e-8);
}

/// Next to the poles of a sphere, where the derivatives of a spline go to zero, and in its centre.
void check_poles() {
  const auto spline = through_step(BRepBuilderAPI_NurbsConvert(BRepPrimAPI_MakeSphere(2.).Shape()).Shape());
  const auto sphere = make_surface("sphere", "set Radius = 2");
  Random random;
  WorstError gap, normal, turning;
  for (const double aside : {0., 1e-12, 1e-9, 1e-6, 1e-4, 1e-3, 0.01, 0.1})
    for (unsigned int i = 0; i < 100; ++i) {
      const Tensor<1, 3> x(
          {random(-aside, aside), random(-aside, aside), (i % 2 == 0 ? 1. : -1.) * random(1.5, 2.5)});
      const auto a = spline->project(x), b = sphere->project(x);
      gap.add(a.exists ? std::abs(a.gap - b.gap) : 1.);
      normal.add((a.normal - b.normal).norm());
      turning.add((a.turning - b.turning).norm());
    }
  check("poles of a sphere as a spline: gap", gap.value(), 1e-9);
  check("poles of a sphere as a spline: normal", normal.value(), 1e-7);
  check("poles of a sphere as a spline: turning", turning.value(), 1e-4);
  check("centre of a sphere as a spline", std::abs(spline->project({}).gap + 2.), 1e-9);
}

/// Distance from a box whose edges and corners are rounded: that from a smaller box.
double rounded_box_gap(const Tensor<1, 3> &x, const Tensor<1, 3> &half, const double radius) {
  double square = 0., inside = -1e9;
  for (unsigned int c = 0; c < 3; ++c) {
    const double past = std::abs(x[c] - half[c]) - half[c] + radius;
    square += std::pow(std::max(0., past), 2);
    inside = std::max(inside, past);
  }
  return (inside > 0. ? std::sqrt(square) : inside) - radius;
}

TopoDS_Shape rounded_box(const double radius) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(4., 5., 6.).Shape();
  BRepFilletAPI_MakeFillet fillet(box);
  for (TopExp_Explorer edges(box, TopAbs_EDGE); edges.More(); edges.Next())
    fillet.Add(radius, TopoDS::Edge(edges.Current()));
  return fillet.Shape();
}

void check_rounded_box(const std::string &name, const SharedSurface &box, const double tolerance) {
  check_surface(name, *box, Tensor<1, 3>({2., 2.5, 3.}), 5.);
  const Tensor<1, 3> half({2., 2.5, 3.});
  Random random;
  WorstError error;
  for (unsigned int i = 0; i < 2000; ++i) {
    const auto x = half + random.vector(i % 2 == 0 ? 4. : 50.);
    const auto p = box->project(x);
    error.add(p.exists ? std::abs(p.gap - rounded_box_gap(x, half, 0.7)) : 1.);
  }
  check(name + ": gap against the closed form", error.value(), tolerance);
}

Handle(Geom_BSplineSurface) wave() {
  TColgp_Array2OfPnt points(1, 9, 1, 9);
  for (int i = 1; i <= 9; ++i)
    for (int j = 1; j <= 9; ++j)
      points(i, j) = gp_Pnt(i - 5., j - 5., 0.5 * std::sin(0.7 * i) * std::cos(0.5 * j));
  return GeomAPI_PointsToBSplineSurface(points).Surface();
}

/// A line across it.
TopoDS_Shape wave_edge() {
  const Handle(Geom_BSplineSurface) spline = wave();
  double u_0 = 0., u_1 = 0., v_0 = 0., v_1 = 0.;
  spline->Bounds(u_0, u_1, v_0, v_1);
  return BRepBuilderAPI_MakeEdge(spline->VIso(0.3 * v_0 + 0.7 * v_1)).Shape();
}

/// A free-form face against samples of it: none is nearer, and the foot is on the surface.
void check_wave() {
  const Handle(Geom_BSplineSurface) spline = wave();
  const auto face = through_step(BRepBuilderAPI_MakeFace(spline, 1e-6).Shape());
  check_surface("free-form face", *face, {}, 4.);
  Random random;
  WorstError nearer, gap;
  double u_0 = 0., u_1 = 0., v_0 = 0., v_1 = 0.;
  spline->Bounds(u_0, u_1, v_0, v_1);
  for (unsigned int i = 0; i < 500; ++i) {
    const auto x = random.vector(i % 2 == 0 ? 40. : 4.);
    const double distance = std::abs(face->project(x).gap);
    constexpr unsigned int n = 60;
    for (unsigned int a = 0; a <= n; ++a)
      for (unsigned int b = 0; b <= n; ++b) {
        const gp_Pnt p = spline->Value(u_0 + (u_1 - u_0) * a / n, v_0 + (v_1 - v_0) * b / n);
        nearer.add(distance - p.Distance(gp_Pnt(x[0], x[1], x[2])));
      }
    // Above a point of the surface, along its normal.
    gp_Pnt p;
    gp_Vec d_u, d_v;
    spline->D1(random(u_0, u_1), random(v_0, v_1), p, d_u, d_v);
    const gp_Vec normal = d_u.Crossed(d_v).Normalized();
    const double above = random(-0.3, 0.3);
    p.Translate(above * normal);
    const double found = face->project(Tensor<1, 3>({p.X(), p.Y(), p.Z()})).gap;
    gap.add(std::abs(std::abs(found) - std::abs(above)));
  }
  check("free-form face: no sample is nearer", nearer.value(), 1e-9);
  check("free-form face: the gap above its points", gap.value(), 1e-9);
}

} // namespace

BILLET_TEST(cad) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  const Tensor<1, 3> origin;
  const gp_Ax2 axes(gp_Pnt(1., -2., 0.5), gp_Dir(1., 2., 2.));
  const std::string at = "set Centre = 1, -2, 0.5\nset Axis = 1, 2, 2\n";

  const auto sphere = make_surface("sphere", at + "set Radius = 2");
  check_same("sphere", through_step(BRepPrimAPI_MakeSphere(axes, 2.).Shape()), sphere, 4., 1e-12);
  check_same("sphere from inside",
             through_step(BRepPrimAPI_MakeSphere(axes, 2.).Shape(), "set Side = inside"),
             make_surface("sphere", at + "set Radius = 2\nset Side = inside"), 4., 1e-12);
  check_same("sphere through IGES", through_iges(BRepPrimAPI_MakeSphere(axes, 2.).Shape()), sphere, 4., 1e-9);
  check_same("sphere as a spline",
             through_step(BRepBuilderAPI_NurbsConvert(BRepPrimAPI_MakeSphere(axes, 2.).Shape()).Shape()),
             sphere, 4., 1e-8);
  check_same("torus", through_step(BRepPrimAPI_MakeTorus(axes, 3., 1.).Shape()),
             make_surface("torus", at + "set Ring radius = 3\nset Tube radius = 1"), 5., 1e-11);
  check_same("torus as a spline",
             through_step(BRepBuilderAPI_NurbsConvert(BRepPrimAPI_MakeTorus(axes, 3., 1.).Shape()).Shape()),
             make_surface("torus", at + "set Ring radius = 3\nset Tube radius = 1"), 5., 1e-8);
  check_near_axis();
  check_poles();
  // A piece of a torus: its first face is the fillet, the others close it.
  check_same(
      "quarter fillet",
      through_step(BRepPrimAPI_MakeTorus(3., 1., 0.5 * M_PI, M_PI, 0.5 * M_PI).Shape(), "set Faces = 1"),
      make_surface("torus", "set Ring radius = 3\nset Tube radius = 1\nset From angle = 90\nset To angle = "
                            "180\nset Sector = 90"),
      4., 1e-12);
  const TopoDS_Shape can = BRepPrimAPI_MakeCylinder(2., 5.).Shape();
  const auto drawn_can =
      make_surface("revolved profile", "set Outside = right\nset Corners = 0, 0 ; 2, 0 ; 2, 5 ; 0, 5");
  check_same("can", through_step(can), drawn_can, 4., 1e-12);
  // Whose rims OpenCASCADE writes as splines, within 1e-5.
  check_same("can through IGES", through_iges(can), drawn_can, 4., 1e-6);
  check_same("can as splines", through_step(BRepBuilderAPI_NurbsConvert(can).Shape()), drawn_can, 4., 1e-8);
  check_same(
      "can, moved and twice as large", through_step(can, "set Scale = 2\nset Translation = 0, 0, -3\n"),
      make_surface("revolved profile",
                   "set Outside = right\nset Corners = 0, 0 ; 4, 0 ; 4, 10 ; 0, 10\nset Origin = 0, 0, -3"),
      8., 1e-12);
  check_same("cone", through_step(BRepPrimAPI_MakeCone(2., 0., 3.).Shape()),
             make_surface("revolved profile", "set Outside = right\nset Corners = 0, 0 ; 2, 0 ; 0, 3"), 4.,
             1e-10);

  check_rounded_box("box with fillets", through_step(rounded_box(0.7)), 1e-9);
  check_rounded_box("box with fillets, as splines",
                    through_step(BRepBuilderAPI_NurbsConvert(rounded_box(0.7)).Shape()), 1e-9);
  check_rounded_box("box with fillets, through IGES", through_iges(rounded_box(0.7)), 1e-9);

  // Trimmed by curves that are no lines of the parameters: a ball with a bore across, a plate with a hole.
  const TopoDS_Shape bore =
      BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0.3, 0., -5.), gp_Dir(0., 0., 1.)), 0.6, 10.).Shape();
  check_surface("ball with a bore",
                *through_step(BRepAlgoAPI_Cut(BRepPrimAPI_MakeSphere(2.).Shape(), bore).Shape()), origin, 3.,
                400, 1e-6);
  const TopoDS_Shape plate = BRepPrimAPI_MakeBox(gp_Pnt(-2., -2., 0.), gp_Pnt(2., 2., 1.)).Shape();
  check_surface("plate with a hole", *through_step(BRepAlgoAPI_Cut(plate, bore).Shape()), origin, 3.);
  check_surface("prism on a spline",
                *through_step(BRepPrimAPI_MakePrism(wave_edge(), gp_Vec(0., 0., 3.)).Shape()), origin, 4.);
  const TopoDS_Shape post =
      BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0.3, 0., -5.), gp_Dir(0., 0.2, 1.)), 2., 10.).Shape();
  check_surface(
      "free-form face within a cylinder",
      *through_step(BRepAlgoAPI_Common(BRepBuilderAPI_MakeFace(wave(), 1e-6).Shape(), post).Shape()), origin,
      3.);
  check_wave();
}

} // namespace cad_test
