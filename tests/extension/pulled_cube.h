// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_EXTENSION_PULLED_CUBE_H
#define BILLET_TESTS_EXTENSION_PULLED_CUBE_H

#include "../scenes/explicit_run.h"
#include "../scenes/scene_run.h"

#include <fstream>
#include <functional>
#include <string>

/// A unit cube of eight bricks, pulled along z by its upper face; free sideways.
namespace billet::testing {

constexpr double cube_young = 200e3, cube_poisson = 0.3, cube_density = 7.8e-9;

/// `stretch`: 1 + the displacement of the upper face at time `duration`, along a smooth ramp.
inline parameters::Scene read_pulled_cube(const std::string &element, const std::string &material,
                                          const double stretch, const double duration, const bool is_explicit,
                                          const unsigned int n_steps) {
  const std::string file = is_explicit ? "explicit.prm" : "static.prm";
  std::ofstream text(file);
  text.precision(17);
  text << "subsection Bodies\n"
          "  subsection cube\n"
          "    set Symmetry planes = x = 0 ; y = 0 ; z = 0\n"
          "    set Element = "
       << element
       << "\n"
          "    subsection Mesh\n"
          "      set Primitive = subdivided_hyper_rectangle\n"
          "      set Arguments = 2, 2, 2 : 0, 0, 0 : 1, 1, 1 : true\n"
          "    end\n"
          "    subsection Material\n"
       << material << "\n      set Density = " << cube_density
       << "\n"
          "    end\n"
          "    subsection Supports\n"
          "      subsection top\n"
          "        set Boundary ids = 5\n"
          "        set Components = z\n"
          "        set Displacement = 0 ; 0 ; "
       << stretch - 1. << "*(1 - cos(pi*t/" << duration
       << "))/2\n"
          "      end\n"
          "    end\n"
          "  end\n"
          "end\n"
          "subsection Time stepping\n"
          "  set Scheme = "
       << (is_explicit ? "explicit" : "quasi-static") << "\n  set End time = " << duration << "\n";
  if (!is_explicit)
    text << "  set Step control = fixed\n  set Initial step = " << duration / n_steps << "\n";
  text << "end\n"
          "subsection Output\n"
          "  set Format = none\n"
          "end\n";
  if (!is_explicit)
    text << "subsection Solver\n"
            "  set Force tolerance = 1e-9\n"
            "  set Energy tolerance = 1e-14\n"
            "end\n";
  text.close();
  return parameters::Scene::read(file);
}

/// Energies of the cube at the end [energy]; its volume is 1.
struct CubeEnergies {
  double elastic = 0., plastic = 0.;
  unsigned int n_iterations = 0; ///< of Newton, in all
};

inline CubeEnergies pull(const std::string &element, const std::string &material, const double stretch,
                         const double duration, const unsigned int n_steps) {
  SceneRun run(read_pulled_cube(element, material, stretch, duration, false, n_steps));
  run.finish();
  return {run.problem.state().energies.elastic, run.problem.state().energies.plastic, run.n_iterations};
}

inline CubeEnergies pull_explicitly(const std::string &element, const std::string &material,
                                    const double stretch, const double duration) {
  ExplicitRun run(read_pulled_cube(element, material, stretch, duration, true, 0));
  run.finish(duration, [] {});
  return {run.state().energies.elastic, run.state().energies.plastic, 0};
}

/// Returns the stored energy of uniaxial tension along z; the lateral stretch by bisection of the lateral
/// stress.
template <class Law> double energy_of_tension(const Law &law, const double stretch) {
  double low = 0.3, high = 1.5;
  dealii::Tensor<2, 3> F;
  F[2][2] = stretch;
  typename Law::History none;
  dealii::SymmetricTensor<2, 3> tau;
  for (unsigned int i = 0; i < 100; ++i) {
    F[0][0] = F[1][1] = 0.5 * (low + high);
    law.update(F, none, none, tau, nullptr);
    (tau[0][0] > 0. ? high : low) = F[0][0];
  }
  return law.elastic_energy(F, none);
}

/// Returns the message of the InputError that a function throws; empty if it throws none.
inline std::string refusal(const std::function<void()> &function) {
  try {
    function();
  } catch (const InputError &error) {
    return error.what();
  }
  return "";
}
inline bool has(const std::string &text, const std::string &part) {
  return text.find(part) != std::string::npos;
}

inline const char *const all_element_names[] = {"assumed strain", "mean dilatation", "one point"};

} // namespace billet::testing

#endif
