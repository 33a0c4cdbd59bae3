// SPDX-License-Identifier: LGPL-2.1-or-later
// CAD files with damage: each is read or refused with a reason, and none ends the program or is read for
// ever. With an argument, the number of files of each kind, it prints how many are refused, and how many
// OpenCASCADE has read.
#include "../fuzz/fuzz.h"
#include "../testing.h"
#include "make_surface.h"

#include "billet/errors.h"
#include "billet/geometry/cad_file.h"

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Writer.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Writer.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shape.hxx>

namespace damaged_cad_test {

using namespace billet;
using namespace billet::testing;

namespace {

/// A plate with a hole and a rounded edge.
TopoDS_Shape plate(const bool as_splines) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(4., 3., 1.).Shape();
  BRepFilletAPI_MakeFillet rounded(box);
  rounded.Add(0.3, TopoDS::Edge(TopExp_Explorer(box, TopAbs_EDGE).Current()));
  const TopoDS_Shape shape =
      BRepAlgoAPI_Cut(
          rounded.Shape(),
          BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(2., 1.5, -1.), gp_Dir(0., 0., 1.)), 0.7, 3.).Shape())
          .Shape();
  return as_splines ? BRepBuilderAPI_NurbsConvert(shape).Shape() : shape;
}

class CadDamage {
public:
  std::string operator()(std::string text) {
    const unsigned int n = 1 + below(3);
    for (unsigned int i = 0; i < n; ++i)
      apply_once(text);
    return text;
  }

private:
  unsigned int below(const std::size_t n) {
    return std::min<unsigned int>(static_cast<unsigned int>(random_(0., static_cast<double>(n))),
                                  static_cast<unsigned int>(n) - 1);
  }
  /// Place of a digit, after the head of the file, which holds names and times.
  std::size_t digit(const std::string &text) {
    const std::size_t place = text.find_first_of("0123456789", text.size() / 5 + below(4 * text.size() / 5));
    return place == std::string::npos ? text.find_first_of("0123456789") : place;
  }
  void apply_once(std::string &text) {
    if (text.size() < 100)
      return;
    const std::size_t at = below(text.size());
    switch (below(7)) {
    case 0: // a line is missing
      text.erase(text.rfind('\n', at) + 1, text.find('\n', at) - text.rfind('\n', at));
      break;
    case 1: // cut short
      text.resize(at);
      break;
    case 2: // another digit: another entity, count or coordinate
      text[digit(text)] = static_cast<char>('0' + below(10));
      break;
    case 3: // a large number
      text.insert(digit(text), "99999999");
      break;
    case 4: // a byte of another file
      text[at] = static_cast<char>(below(256));
      break;
    case 5: // a part twice
      text.insert(at, text.substr(below(text.size()), 200));
      break;
    case 6: { // another reference
      const std::size_t from = text.find('#', below(text.size())), to = text.find('#', below(text.size()));
      if (from == std::string::npos || to == std::string::npos)
        break;
      const std::size_t end = text.find_first_not_of("0123456789", to + 1);
      const std::string reference = text.substr(to, end - to);
      text.replace(from, text.find_first_not_of("0123456789", from + 1) - from, reference);
      break;
    }
    }
  }

  Random random_;
};

/// Changes numbers, references and senses, so that the text of a file stays a sound one of its format. What
/// is wrong with the shape, the library alone can find.
class ShapeDamage {
public:
  std::string operator()(const std::string &sound) {
    std::string text = sound;
    for (std::size_t n = 1 + below(3); n > 0 || text == sound; n -= n > 0 ? 1 : 0)
      apply_once(text);
    return text;
  }

private:
  std::size_t below(const std::size_t n) {
    return std::min(static_cast<std::size_t>(random_(0., static_cast<double>(n))), n - 1);
  }
  static std::size_t end_of_number(const std::string &text, const std::size_t begin) {
    return std::min(text.find_first_not_of("0123456789.", begin), text.size());
  }
  /// Place of a number after the head of the file. Names of entities, '#12', are none.
  std::size_t number(const std::string &text) {
    for (;;) {
      const std::size_t place =
          text.find_first_of("0123456789", text.size() / 5 + below(4 * text.size() / 5));
      if (place == std::string::npos)
        continue;
      const std::size_t before = text.find_last_not_of("0123456789.", place);
      if (before != std::string::npos && text[before] != '#' && std::isalpha(text[before]) == 0)
        return before + 1;
    }
  }
  void apply_once(std::string &text) {
    switch (below(4)) {
    case 0: { // another digit
      const std::size_t place = number(text);
      const std::size_t digit =
          text.find_first_of("0123456789", place + below(end_of_number(text, place) - place));
      if (digit < text.size())
        text[digit] = static_cast<char>('0' + below(10));
      break;
    }
    case 1: { // another number, as long
      const std::size_t to = number(text), from = number(text);
      const std::size_t length = end_of_number(text, to) - to;
      if (end_of_number(text, from) - from == length)
        text.replace(to, length, text.substr(from, length));
      break;
    }
    case 2: { // another sense
      const std::size_t place = text.find(below(2) == 0 ? ".T." : ".F.", below(text.size()));
      if (place != std::string::npos)
        text[place + 1] = text[place + 1] == 'T' ? 'F' : 'T';
      break;
    }
    case 3: // another entity of the same type
      refer_elsewhere(text);
    }
  }
  void refer_elsewhere(std::string &text) {
    const std::size_t from = text.find('#', below(text.size()));
    if (from == std::string::npos)
      return;
    const std::size_t end = text.find_first_not_of("0123456789", from + 1);
    const std::string definition = "\n" + text.substr(from, end - from) + " = ";
    const std::size_t place = text.find(definition);
    if (place == std::string::npos || text.compare(end, 2, " =") == 0)
      return;
    const std::size_t type = place + definition.size();
    const std::string start = " = " + text.substr(type, text.find('(', type) + 1 - type);
    const std::size_t other = text.find(start, below(text.size()));
    const std::size_t name = other == std::string::npos ? other : text.rfind('#', other);
    if (name != std::string::npos)
      text.replace(from, end - from, text.substr(name, other - name));
  }

  Random random_;
};

/// Reads a CAD file of this suffix. What is read has a finite size and is somewhere.
Outcome judge_cad(const std::string &suffix, const std::string &bytes) {
  const std::string file = "damaged." + suffix;
  write_bytes(file, bytes);
  try {
    const auto surface = make_surface("CAD", "set File = " + file);
    const auto projection = surface->project(dealii::Tensor<1, 3>({1., 1., 2.}));
    constexpr double max_size = 1e10; // the sound part is 4 long
    bool is_finite = !projection.exists || std::isfinite(projection.gap);
    for (const CadFace &face : list_cad_faces(file))
      for (const auto &corner : face.box)
        is_finite = is_finite && corner.norm() < max_size;
    return is_finite ? Outcome::accepted : Outcome::unsound;
  } catch (const InputError &error) {
    return is_message(error.what()) ? Outcome::refused : Outcome::unsound;
  }
}

/// Texts that contradict themselves, and texts that only look so.
void check_texts() {
  const std::string head = "ISO-10303-21; DATA; ", end = " ENDSEC; END-ISO-10303-21;";
  const auto fault = [&](const std::string &data) { return check_step_file(head + data + end).fault; };
  check("sound", fault("#1=A('#7 it''s',$); /* #8 */ #2 = B(#1,1.E-05);").empty());
  check("an entity is missing", fault("#2=B(#1);") == "it names #1, which it does not define");
  check("an entity is there twice", fault("#1=A(); #1 =B();") == "it defines #1 twice");
  check("cut short", !check_step_file(head + "#1=A();").fault.empty());
  check("faces are counted", check_step_file("#1=ADVANCED_FACE(); #2=ADVANCED_FACE ()").n_faces == 2);

  // Entities by the grammar, and those of shapes by their parameters.
  check("typed values, lists and complex entities",
        fault("#1=A(.T.,LENGTH_MEASURE(-1.5E+3),((1,2),()),\"0F\",*);#2=(B()C(#1,'x')/* ( */D());").empty());
  check("no number", fault("#1=CARTESIAN_POINT('',(0.,NaN,1.));").find("#1 has 'NaN'") != std::string::npos);
  check("a bracket is missing", !fault("#1=A((1,2);").empty() && !fault("#1=A(1 2);").empty());
  check("parameters are missing",
        fault("#1=ORIENTED_EDGE();") == "its entity #1 has 0 parameters, where ORIENTED_EDGE has 5");
  check("a radius of 0", !fault("#1=CIRCLE('',$,0.);").empty() && fault("#1=CIRCLE('',$,1.);").empty());
  check("a number beyond all bounds", !fault("#1=CARTESIAN_POINT('',(1.E308,0.,0.));").empty());
  check("a direction of length 0", !fault("#1=DIRECTION('',(0.,0.));").empty());
  const std::string flat = "#1=CARTESIAN_POINT('',(0.,0.));";
  check("a point of a face in two dimensions",
        fault(flat +
              "#2=VERTEX_POINT('',#1);#3=VERTEX_LOOP('',#2);#4=FACE_BOUND('',#3,.T.);#5=ADVANCED_FACE('',"
              "(#4),#6,.T.);#6=PLANE('',#7);#7=AXIS2_PLACEMENT_3D('',#1,$,$);") ==
            "its entity #1, of a face, has 2 coordinates, where 3 should be");
  const std::string surface = "#5=PLANE('',#6);#6=AXIS2_PLACEMENT_3D('',#7,$,$);"
                              "#7=CARTESIAN_POINT('',(0.,0.,0.));";
  const std::string on_surface = "#2=PCURVE('',#5,#3);#3=DEFINITIONAL_REPRESENTATION('',(#1),$);" + surface;
  check("a point in the parameters of a face", fault(flat + on_surface).empty());
  check("a point in the parameters of a face in three dimensions",
        fault("#1=CARTESIAN_POINT('',(0.,0.,1.));" + on_surface) ==
            "its entity #1, in the parameters of a face, has 3 coordinates, where 2 should be");
  check("a loop that names other entities than edges",
        fault("#1=PRODUCT('');#2=EDGE_LOOP('',(#1,#1));") ==
            "its entity #2, of type EDGE_LOOP, names #1, of type PRODUCT, where an oriented edge should be");
  check(
      "a face on a rational spline, or on a surface of another name",
      fault("#1=(B_SPLINE_SURFACE()SURFACE());#2=OFFSET_SURFACE('',#5,1.,.F.);#3=ADVANCED_FACE('',(),#1,.T.);"
            "#4=ADVANCED_FACE('',(),#2,.T.);" +
            surface)
          .empty());

  const auto line = [](const std::string &text, const std::string &section) {
    return text + std::string(72 - text.size(), ' ') + section + "\n";
  };
  const std::string lines = line("", "S      1") + line("", "G      1") + line("     144", "D      1") +
                            line("     144", "D      2") + line("144;", "P      1");
  check("sound IGES",
        check_iges_file(lines + line("S      1G      1D      2P      1", "T      1")).fault.empty());
  check("a line is missing",
        check_iges_file(lines + line("S      1G      1D      2P      2", "T      1")).fault ==
            "its section P has 1 lines, but its last line tells another number");
  check("faces of IGES are counted", check_iges_file(lines).n_faces == 1);
}

/// Numbers that the grammar allows, but for which edges miss their vertices.
void check_vertices(const std::string &original) {
  const std::string before = "VERTEX_POINT('',#";
  std::string text = original;
  const std::size_t place = text.find(before) + before.size();
  const std::string point =
      "#" + text.substr(place, text.find(')', place) - place) + " = CARTESIAN_POINT('',(";
  const std::size_t number = text.find(point) + point.size();
  text.replace(number, text.find(',', number) - number, "4.5");
  std::ofstream("moved.step") << text;
  std::string message;
  try {
    make_surface("CAD", "set File = moved.step");
  } catch (const InputError &error) {
    message = error.what();
  }
  check("a vertex beside its edges", message.find("they miss these by up to") != std::string::npos);
}

/// A radius that the grammar allows, but with which a face has no end.
void check_extents(const std::string &original) {
  std::string text = original;
  const std::size_t place = text.find("CYLINDRICAL_SURFACE(");
  const std::size_t number = text.rfind(',', text.find(')', place)) + 1;
  text.replace(number, text.find(')', place) - number, "1.E30");
  write_bytes("endless.step", text);
  std::string message;
  try {
    list_cad_faces("endless.step");
  } catch (const InputError &error) {
    message = error.what();
  }
  check("a face without an end", message.find(", has no end") != std::string::npos);
}

} // namespace

BILLET_TEST(damaged_cad) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  const auto &given = billet::testing::arguments();
  const unsigned int n_files = given.empty() ? 25 : static_cast<unsigned int>(std::stoul(given[0]));
  check_texts();
  STEPControl_Writer step;
  step.Transfer(plate(false), STEPControl_AsIs);
  step.Write("plate.step");
  STEPControl_Writer splines;
  splines.Transfer(plate(true), STEPControl_AsIs);
  splines.Write("splines.stp");
  IGESControl_Controller::Init();
  IGESControl_Writer iges("MM", 0);
  iges.AddShape(plate(false));
  iges.ComputeModel();
  iges.Write("plate.iges");
  check_vertices(bytes_of("plate.step"));
  check_extents(bytes_of("plate.step"));
  CadDamage damage;
  ShapeDamage of_shapes;
  for (const std::string name : {"plate.step", "splines.stp", "plate.iges"}) {
    const std::string suffix = name.substr(name.find('.') + 1), sound = bytes_of(name);
    unsigned int n_read = 0;
    const auto judge_one = [&](const std::string &bytes) {
      const auto report = suffix == "iges" ? check_iges_file(bytes) : check_step_file(bytes);
      n_read += report.fault.empty() && bytes != sound ? 1 : 0; // the library reads it
      return judge_cad(suffix, bytes);
    };
    fuzz(name, sound, n_files, damage, !given.empty(), judge_one);
    fuzz("shape_of_" + name, sound, n_files, of_shapes, !given.empty(), judge_one);
    if (!given.empty())
      std::cout << name << ": " << n_read << " read by OpenCASCADE" << std::endl;
  }
}

} // namespace damaged_cad_test
