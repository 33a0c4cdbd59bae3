// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/error_control.h"

namespace billet {

namespace {

constexpr std::size_t n_numbers = 26; // in checkpoints, each at its place; the last may be missing
constexpr std::size_t place_of_iterations = 9;

} // namespace

void ErrorControl::accept(const double h, const Forces &forces, const double residual,
                          const double penetration) {
  const double force = course_.size_of(forces);
  course_.accept(h, force);
  iterations_ += residual * force * h;
  steps_.accept(h, forces.size());
  penetrations_.accept(h, force, penetration);
}

ErrorControl::Estimate ErrorControl::estimate() const {
  const double work = course_.work();
  if (!(work > 0.))
    return {};
  return {steps_.integral() / work, penetrations_.integral() / work, iterations_ / work};
}

void ErrorControl::save(StateWriter &writer) const {
  std::vector<double> numbers(n_numbers);
  numbers[place_of_iterations] = iterations_;
  course_.save(numbers);
  steps_.save(numbers);
  penetrations_.save(numbers);
  writer.write("errors", numbers);
  steps_.save_forces(writer);
}

void ErrorControl::load(const StateReader &reader) {
  const std::vector<double> numbers = reader.read("errors", n_numbers);
  iterations_ = numbers[place_of_iterations];
  course_.load(numbers);
  steps_.load(numbers);
  penetrations_.load(numbers);
  steps_.load_forces(reader);
}

} // namespace billet
