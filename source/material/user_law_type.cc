// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/law_type.h"
#include "billet/material/umat_law.h"
#include "billet/material/vumat_law.h"

#include <algorithm>
#include <cctype>
#include <dlfcn.h>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace billet {

RegisteredType<SharedLaw> umat_type();
RegisteredType<SharedLaw> vumat_type();

namespace {

constexpr const char *library_key = "Library", *constants_key = "Constants",
                     *n_variables_key = "State variables", *names_key = "State variable names",
                     *initial_key = "Initial state variables", *name_key = "Material name",
                     *symmetry_key = "Unsymmetric tangent", *length_key = "Element length",
                     *temperature_key = "Reads temperature";
constexpr std::size_t max_variables = 10000;
/// A library's own functions come before those of the program with the same name, such as BLAS.
/// Sanitizers do not allow this.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int own_symbols_first = 0;
#else
constexpr int own_symbols_first = RTLD_DEEPBIND;
#endif

std::vector<TypeParameter> user_law_parameters() {
  using Kind = TypeParameter::Kind;
  return {
      {library_key, "", Kind::text,
       "Shared library with the subroutine, such as ./libsteel.so, relative to the scene file."},
      {constants_key, "", Kind::text, "PROPS, separated by commas. NPROPS is their count. [any unit]"},
      {n_variables_key, "0", Kind::number, "NSTATV, NSTATEV >= 0. Number of the state variables at a point."},
      {names_key, "", Kind::text,
       "Names of all state variables, separated by commas, for 'State fields' and checkpoints. The one "
       "called 'equivalent plastic strain' is that of field output. Empty: 'state variables' has all."},
      {initial_key, "", Kind::text, "Initial values of all state variables. Empty: 0 for all."},
      {name_key, "UMAT", Kind::text,
       "CMNAME, at most 80 characters, by which a library tells several materials apart."},
      {symmetry_key, "false", Kind::flag,
       "Whether the tangent is unsymmetric. Otherwise its symmetric part counts."},
      {length_key, "1", Kind::number, "> 0. CELENT, charLength, the same for all elements. [length]"},
      {temperature_key, "false", Kind::flag,
       "Whether the temperatures are those of 'Temperature', which the scene must then give."}};
}

std::size_t read_count(const TypeInput &input) {
  const double count = input.not_negative(n_variables_key);
  if (count != static_cast<double>(static_cast<std::size_t>(std::min(count, 2. * max_variables))) ||
      count > max_variables)
    input.reject(n_variables_key, "a whole number from 0 to " + std::to_string(max_variables));
  return static_cast<std::size_t>(count);
}

void read_state(const TypeInput &input, UserLawSettings &settings) {
  const std::size_t n = read_count(input);
  settings.initial_state.assign(n, 0.);
  if (input.is_set(initial_key)) {
    settings.initial_state = input.numbers(initial_key);
    if (settings.initial_state.size() != n)
      input.reject(initial_key, "as many numbers as 'State variables' says, " + std::to_string(n));
  }
  if (!input.is_set(names_key))
    return;
  settings.state_names = input.parts(names_key, ',');
  std::set<std::string> taken = {"deformation gradient", "stress", "strain", "energies", "clock"};
  for (const std::string &name : settings.state_names)
    if (name.empty() || !taken.insert(name).second)
      input.reject(names_key, "a different name for each state variable, and none of the law's own: "
                              "deformation gradient, stress, strain, energies, clock");
  if (settings.state_names.size() != n)
    input.reject(names_key, "as many names as 'State variables' says, " + std::to_string(n));
}

/// Returns a subroutine of the library, which stays loaded. `name`: in Fortran, in lower case.
void *load_function(const TypeInput &input, const std::string &name, UserLawSettings &settings) {
  const std::string path = std::filesystem::canonical(input.file(library_key)).string();
  void *const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | own_symbols_first);
  if (library == nullptr) {
    const char *const reason = dlerror();
    input.reject(library_key,
                 "a shared library that the system can load, as by 'gfortran -shared -fPIC -O2 -o lib" +
                     name + ".so " + name + ".f' (it cannot: " + (reason != nullptr ? reason : "no reason") +
                     ")");
  }
  void *const symbol = dlsym(library, (name + "_").c_str());
  if (symbol == nullptr)
    input.reject(library_key, "a library with the symbol '" + name + "_', a Fortran subroutine " + name +
                                  " or a C function '" + name +
                                  "_' (extern \"C\" in C++); 'nm -D' lists the symbols of a library");
  for (const char *idle : {"sdvini", "uexternaldb", "vexternaldb"})
    if (dlsym(library, (std::string(idle) + "_").c_str()) != nullptr)
      settings.idle_subroutines += (settings.idle_subroutines.empty() ? "" : ", ") + std::string(idle);
  std::transform(settings.idle_subroutines.begin(), settings.idle_subroutines.end(),
                 settings.idle_subroutines.begin(),
                 [](const unsigned char letter) { return static_cast<char>(std::toupper(letter)); });
  return symbol;
}

UserLawSettings read_settings(const TypeInput &input) {
  UserLawSettings settings;
  if (!input.is_set(library_key))
    input.reject(library_key, "the name of a shared library, since 'Law' is a subroutine");
  settings.library = input.text(library_key);
  settings.name = input.text(name_key);
  if (settings.name.empty() || settings.name.size() > 80)
    input.reject(name_key, "a name of 1 to 80 characters");
  if (input.is_set(constants_key))
    settings.constants = input.numbers(constants_key);
  read_state(input, settings);
  settings.has_symmetric_tangent = !input.flag(symmetry_key);
  settings.element_length = input.positive(length_key);
  settings.reads_temperature = input.flag(temperature_key);
  return settings;
}

/// Makes a law, which calls its subroutine. Refuses the library if that fails.
template <class Law, class... Arguments>
SharedLaw make_user_law(const TypeInput &input, Arguments &&...arguments) {
  SharedLaw law;
  try {
    law = std::make_shared<const Law>(std::forward<Arguments>(arguments)...);
  } catch (const std::runtime_error &error) {
    input.reject(library_key, std::string("a library that works with these constants: ") + error.what());
  }
  return law;
}

SharedLaw make_umat(const TypeInput &input) {
  UserLawSettings settings = read_settings(input);
  auto *const function =
      reinterpret_cast<UmatFunction *>(load_function(input, "umat", settings)); // POSIX allows this
  return make_user_law<UmatLaw>(input, function, std::move(settings));
}

SharedLaw make_vumat(const TypeInput &input) {
  UserLawSettings settings = read_settings(input);
  const double density = input.positive("Density"); // its energies are those of a mass
  auto *const function = reinterpret_cast<VumatFunction *>(load_function(input, "vumat", settings));
  return make_user_law<VumatLaw>(input, function, std::move(settings), density);
}

} // namespace

RegisteredType<SharedLaw> umat_type() {
  return {UmatLaw::law_name, "subroutine UMAT of Abaqus/Standard, in a shared library", user_law_parameters(),
          &make_umat};
}
RegisteredType<SharedLaw> vumat_type() {
  return {VumatLaw::law_name, "subroutine VUMAT of Abaqus/Explicit, in a shared library",
          user_law_parameters(), &make_vumat};
}

} // namespace billet
