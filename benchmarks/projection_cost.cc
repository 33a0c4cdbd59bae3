// SPDX-License-Identifier: LGPL-2.1-or-later
// Usage: projection_cost RING TUBE HEIGHT SCENE.prm TOOL
//
// Prints the mean time of one projection onto the tool's surface in nanoseconds, of points close to a quarter
// fillet about the z axis (tube angles 90 to 180 degrees, the ring's centre at HEIGHT), each after one close
// by, as nodes come; then the largest differences of gap and of normal from the fillet's own.
#include "billet/parameters/scene.h"

#include <chrono>
#include <cmath>
#include <iostream>
#include <random>

using dealii::Tensor;

int main(int argc, char *argv[]) {
  if (argc != 6)
    return 2;
  const double ring = std::stod(argv[1]), tube = std::stod(argv[2]), height = std::stod(argv[3]);
  const auto scene = billet::parameters::Scene::read(argv[4]);
  for (const auto &tool : scene.tools) {
    if (tool.name != argv[5])
      continue;
    std::mt19937 random(1);
    const auto uniform = [&](const double low, const double high) {
      return low + (high - low) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
    };
    constexpr unsigned int n_walks = 200, n_steps = 50;
    std::vector<Tensor<1, 3>> points;
    std::vector<double> gaps;
    std::vector<Tensor<1, 3>> normals;
    for (unsigned int walk = 0; walk < n_walks; ++walk) {
      double around = uniform(0.05, M_PI / 2. - 0.05), along = uniform(0.55 * M_PI, 0.95 * M_PI);
      for (unsigned int step = 0; step < n_steps; ++step) {
        around = std::min(std::max(around + uniform(-2e-3, 2e-3), 0.02), M_PI / 2. - 0.02);
        along = std::min(std::max(along + uniform(-2e-2, 2e-2), 0.52 * M_PI), 0.98 * M_PI);
        const double gap = uniform(-0.01, 0.05) * tube;
        const double radius = ring + (tube + gap) * std::cos(along);
        points.emplace_back(Tensor<1, 3>(
            {radius * std::cos(around), radius * std::sin(around), height + (tube + gap) * std::sin(along)}));
        gaps.push_back(gap);
        normals.emplace_back(Tensor<1, 3>(
            {std::cos(along) * std::cos(around), std::cos(along) * std::sin(around), std::sin(along)}));
      }
    }
    double gap_error = 0., normal_error = 0.;
    unsigned int patch = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto p = tool.surface->project(points[i], patch);
      patch = p.patch;
      gap_error = std::max(gap_error, std::abs(p.gap - gaps[i]));
      normal_error = std::max(normal_error, (p.normal - normals[i]).norm());
    }
    double sum = 0., best = 1e300;
    for (unsigned int repetition = 0; repetition < 50; ++repetition) {
      const auto start = std::chrono::steady_clock::now();
      for (const auto &point : points) {
        const auto p = tool.surface->project(point, patch);
        patch = p.patch;
        sum += p.gap;
      }
      const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
      best = std::min(best, time.count() / static_cast<double>(points.size()));
    }
    std::cout << best << " " << gap_error << " " << normal_error << (std::isfinite(sum) ? "" : " ")
              << std::endl;
    return 0;
  }
  return 2;
}
