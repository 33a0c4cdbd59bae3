// SPDX-License-Identifier: LGPL-2.1-or-later
// A friction law that the library does not know, registered here and named by a scene: a block that slides on
// a rigid tool and on another body, in statics and in explicit dynamics, against its closed form.

#include "../scenes/explicit_run.h"
#include "../scenes/scene_run.h"

#include <deal.II/base/mpi.h>

#include <fstream>

namespace added_friction_test {

using namespace billet;
using billet::testing::check;

namespace {

constexpr double coefficient = 0.3, reference_rate = 5.;

/// μ p/(1 + v/v_0): the force on a block that slides at one velocity does not depend on how pressure is
/// distributed.
class SlowingFriction final : public FrictionLaw {
public:
  SlowingFriction(const double mu, const double rate) : mu_(mu), rate_(rate) {}

  std::string description() const override { return "mu that falls with the slip rate"; }
  double coefficient() const override { return mu_; }
  FrictionLimit limit(const double pressure, const double slip_rate) const override {
    const double mu = mu_ / (1. + slip_rate / rate_);
    return {mu * pressure, mu, -mu * pressure / (rate_ + slip_rate)};
  }

private:
  double mu_, rate_;
};

FrictionLawType slowing_type() {
  using Kind = TypeParameter::Kind;
  return {"slowing",
          "mu p/(1 + v/v_0), v the slip rate",
          {friction_coefficient_parameter,
           {"Slowing rate", "0", Kind::number, "v_0 > 0, at which half of mu is left. [length/time]"}},
          [](const TypeInput &input) {
            const double mu = read_friction_coefficient(input);
            return std::make_shared<const SlowingFriction>(mu, input.positive("Slowing rate"));
          }};
}

constexpr double speed = 2.; // of the block in statics

/// A block on a plane at z = 0, which is a tool or the upper face of a body that does not move.
parameters::Scene read_scene(const bool is_on_body, const bool is_explicit, const std::string &pair_lines) {
  const std::string file = "sliding_block.prm";
  std::ofstream text(file);
  const std::string material = "    subsection Material\n"
                               "      set Law = elastic\n"
                               "      set Young modulus = 1000\n"
                               "      set Poisson ratio = 0.3\n"
                               "      set Density = 0.001\n"
                               "    end\n";
  text << "subsection Bodies\n"
          "  subsection block\n"
          "    subsection Mesh\n"
          "      set Primitive = subdivided_hyper_rectangle\n"
          "      set Arguments = 2, 2, 1 : 0, 0, 0 : 1, 1, 0.5 : true\n"
          "    end\n"
       << material;
  if (is_explicit)
    text << "    set Initial velocity = 10 ; 0 ; 0\n"
            "    subsection Loads\n"
            "      subsection weight\n"
            "        set Type = acceleration\n"
            "        set Acceleration = 0 ; 0 ; -200\n"
            "      end\n"
            "    end\n";
  else
    text << "    subsection Supports\n"
            "      subsection top\n"
            "        set Boundary ids = 5\n"
            "        set Displacement = "
         << speed << "*t ; 0 ; -0.01*min(10*t, 1)\n      end\n    end\n";
  text << "  end\n";
  if (is_on_body)
    text << "  subsection ground\n"
            "    subsection Mesh\n"
            "      set Primitive = subdivided_hyper_rectangle\n"
            "      set Arguments = 1, 1, 1 : -1, -1, -1 : 3, 2, 0 : true\n"
            "    end\n"
         << material
         << "    subsection Supports\n"
            "      subsection all\n"
            "        set Boundary ids = 0, 1, 2, 3, 4, 5\n"
            "      end\n"
            "    end\n"
            "  end\n";
  text << "end\n";
  if (!is_on_body)
    text << "subsection Tools\n  subsection ground\n    subsection Surfaces\n      subsection plane\n      "
            "end\n"
            "    end\n  end\nend\n";
  text << "subsection Contact pairs\n"
          "  subsection foot\n"
          "    set Body = block\n"
          "    set Boundary ids = 4\n"
       << (is_on_body ? "    set Second body = ground\n    set Second boundary ids = 5\n"
                      : "    set Tool = ground\n")
       << pair_lines
       << "  end\n"
          "end\n"
          "subsection Time stepping\n"
       << (is_explicit ? "  set Scheme = explicit\n  set End time = 0.08\n"
                       : "  set Step control = fixed\n  set Initial step = 0.01\n  set End time = 0.4\n")
       << "end\n"
       << (is_explicit ? "" : "subsection Solver\n  set Force tolerance = 1e-9\nend\n")
       << "subsection Output\n"
          "  set Format = none\n"
          "end\n";
  text.close();
  return parameters::Scene::read(file);
}

std::string law_lines() {
  return "    set Friction law = slowing\n    set Friction coefficient = " + std::to_string(coefficient) +
         "\n    set Slowing rate = " + std::to_string(reference_rate) + "\n";
}

void test_statics(const std::string &name, const bool is_on_body) {
  testing::SceneRun run(read_scene(is_on_body, false, law_lines()));
  run.finish();
  const auto &state = run.problem.state();
  const dealii::Tensor<1, 3> force = is_on_body ? state.body_pair_loads[0].force : state.tool_loads[0].force;
  const double expected = coefficient / (1. + speed / reference_rate);
  check(name + ", statics: friction of a block that slides", std::abs(-force[0] / force[2] / expected - 1.),
        1e-6);
}

void test_explicit(const std::string &name, const bool is_on_body) {
  testing::ExplicitRun run(read_scene(is_on_body, true, law_lines()));
  run.finish(0.08, [] {});
  constexpr double mass = 0.5e-3, gravity = 200., begin = 10.;
  // v′ = −μ g/(1 + v/v_0), so that v + v²/(2 v_0) falls by μ g t.
  const double rest =
      begin + begin * begin / (2. * reference_rate) - coefficient * gravity * run.state().time;
  const double expected = -reference_rate + std::sqrt(reference_rate * (reference_rate + 2. * rest));
  const double velocity = run.state().momentum[0] / mass;
  check(name + ", explicit: velocity of a block that slides",
        std::abs((begin - velocity) / (begin - expected) - 1.), 0.02);
  check(name + ", explicit: friction takes the energy",
        std::abs(run.state().energies.friction / (0.5 * mass * (begin * begin - expected * expected)) - 1.),
        0.05);
}

void check_message(const std::string &name, const std::string &pair_lines, const std::string &expected) {
  std::string message;
  try {
    read_scene(false, false, pair_lines);
  } catch (const InputError &error) {
    message = error.what();
  }
  check(name, message.find(expected) != std::string::npos);
}

} // namespace

BILLET_MPI_TEST(added_friction) {
  friction_law_types().add(slowing_type());
  test_statics("on a tool", false);
  test_statics("on a body", true);
  test_explicit("on a tool", false);
  test_explicit("on a body", true);
  check_message("a parameter of the law that another law does not use",
                "    set Friction coefficient = 0.1\n    set Slowing rate = 1\n",
                "'Coulomb' friction does not use it");
  check_message("a parameter of the law that is missing",
                "    set Friction law = slowing\n    set Friction coefficient = 0.1\n", "a number > 0");
}

} // namespace added_friction_test
