// SPDX-License-Identifier: LGPL-2.1-or-later
// As tangent_of_scene, on faces of CAD files: one of each kind that has a closed form, and splines.
#include "tangent_check.h"

#include <deal.II/base/mpi.h>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <GeomAPI_PointsToBSplineSurface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Writer.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Ax2.hxx>
#include <gp_Pln.hxx>

namespace tangent_on_cad_test {

using namespace billet;

namespace {

/// A free-form dome that touches the block.
TopoDS_Shape dome() {
  TColgp_Array2OfPnt points(1, 9, 1, 9);
  for (int i = 1; i <= 9; ++i)
    for (int j = 1; j <= 9; ++j) {
      const double x = -1. + 0.37 * (i - 1), y = -1. + 0.38 * (j - 1);
      points(i, j) = gp_Pnt(x, y, -0.3 + 0.3 * std::cos(0.6 * (x - 0.45)) * std::cos(0.4 * (y - 0.55)));
    }
  return BRepBuilderAPI_MakeFace(GeomAPI_PointsToBSplineSurface(points).Surface(), 1e-6).Shape();
}

void check(const std::string &name, const TopoDS_Shape &shape) {
  STEPControl_Writer writer;
  writer.Transfer(shape, STEPControl_AsIs);
  writer.Write("shape.step");
  testing::check_curved(name, {"CAD", "set File = shape.step"});
}

} // namespace

BILLET_MPI_TEST(tangent_on_cad) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));

  check("plane",
        BRepBuilderAPI_MakeFace(gp_Pln(gp_Pnt(0.45, 0.55, 0.), gp_Dir(0.02, -0.03, 1.)), -5., 5., -5., 5.)
            .Shape());
  check("sphere", BRepPrimAPI_MakeSphere(gp_Pnt(0.45, 0.55, -5.), 5.).Shape());
  const gp_Ax2 lying(gp_Pnt(-5., -1.6, -3.), gp_Dir(1., 0.4, 0.)); // below the block's middle
  check("cylinder", BRepPrimAPI_MakeCylinder(lying, 3., 12.).Shape());
  const gp_Ax2 from_side(gp_Pnt(-4., 0.6, -1.46), gp_Dir(1., 0., -0.25)); // its uppermost line lies flat
  check("cone", BRepPrimAPI_MakeCone(from_side, 1.5, 4.5, 12.).Shape());
  const gp_Ax2 ring(gp_Pnt(0.45, 0.55, -8.), gp_Dir(0., 1., 0.));
  const TopoDS_Shape torus = BRepPrimAPI_MakeTorus(ring, 5., 3.).Shape();
  check("torus", torus);
  check("torus as a spline", BRepBuilderAPI_NurbsConvert(torus).Shape());
  check("free-form face", dome());
}

} // namespace tangent_on_cad_test
