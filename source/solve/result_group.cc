// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/result_group.h"

namespace billet {

double size_of(const ResultGroup &forces) {
  double sum = 0.;
  for (const auto &force : forces)
    sum += force.norm();
  return sum;
}

double distance_of(const ResultGroup &a, const ResultGroup &b) {
  double sum = 0.;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += (a[i] - b[i]).norm();
  return sum;
}

void save(StateWriter &writer, const std::string &name, const ResultGroup &forces) {
  std::vector<double> numbers;
  for (const auto &force : forces)
    numbers.insert(numbers.end(), force.begin_raw(), force.end_raw());
  writer.write(name, numbers);
}

ResultGroup load_result_group(const StateReader &reader, const std::string &name) {
  const std::vector<double> numbers = reader.read(name);
  ResultGroup forces;
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
    forces.push_back(dealii::Tensor<1, 3>({numbers[i], numbers[i + 1], numbers[i + 2]}));
  return forces;
}

} // namespace billet
