// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/algebra/linear_method.h"

namespace billet {

const std::vector<LinearMethod> &all_linear_methods() {
  static const std::vector<LinearMethod> methods = {DirectMethod::mumps_symmetric, DirectMethod::mumps,
                                                    DirectMethod::klu, IterativeMethod::conjugate_gradients,
                                                    IterativeMethod::gmres};
  return methods;
}

DirectMethod default_direct_method(const bool symmetric) {
  return symmetric ? DirectMethod::mumps_symmetric : DirectMethod::mumps;
}

IterativeMethod default_iterative_method(const bool symmetric) {
  return symmetric ? IterativeMethod::conjugate_gradients : IterativeMethod::gmres;
}

namespace {

std::string describe_method(const DirectMethod method) {
  switch (method) {
  case DirectMethod::mumps_symmetric:
    return "MUMPS, which factorises half";
  case DirectMethod::mumps:
  case DirectMethod::klu:
    break;
  }
  return name_of(method);
}
std::string describe_method(const IterativeMethod method) {
  return std::string(name_of(method)) + " with multigrid";
}

} // namespace

std::string describe(const LinearMethod &method) {
  return std::visit([](const auto chosen) { return describe_method(chosen); }, method);
}

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

const char *name_of(const LinearMethod &method) {
  return std::visit([](const auto chosen) { return name_of(chosen); }, method);
}

bool requires_symmetry(const LinearMethod &method) {
  return std::visit([](const auto chosen) { return requires_symmetry(chosen); }, method);
}

} // namespace billet
