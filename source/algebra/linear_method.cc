// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/algebra/linear_method.h"

namespace billet {

const char *name_of(const DirectMethod method) {
  switch (method) {
  case DirectMethod::mumps_symmetric:
    return "MUMPS symmetric";
  case DirectMethod::mumps:
    return "MUMPS";
  case DirectMethod::klu:
    return "KLU";
  }
  return "";
}

const char *name_of(const IterativeMethod method) {
  switch (method) {
  case IterativeMethod::conjugate_gradients:
    return "CG";
  case IterativeMethod::gmres:
    return "GMRES";
  }
  return "";
}

bool requires_symmetry(const DirectMethod method) {
  switch (method) {
  case DirectMethod::mumps_symmetric:
    return true;
  case DirectMethod::mumps:
  case DirectMethod::klu:
    return false;
  }
  return false;
}

bool requires_symmetry(const IterativeMethod method) {
  switch (method) {
  case IterativeMethod::conjugate_gradients:
    return true;
  case IterativeMethod::gmres:
    return false;
  }
  return false;
}

bool requires_symmetry(const LinearMethod &method) {
  return std::visit([](const auto chosen) { return requires_symmetry(chosen); }, method);
}

} // namespace billet
