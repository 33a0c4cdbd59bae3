// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/support_rates.h"

#include <algorithm>

namespace billet {

SupportRates::SupportRates(const Scene &scene, const Discretization &discretization, const Supports &supports)
    : scene_(scene), discretization_(discretization), supports_(supports),
      change_(discretization.make_owned_vector()) {}

void SupportRates::start(const double t, const double step) {
  start_ = find(t, step);
  end_ = start_;
}

void SupportRates::start_step(const double t_n, const double t) {
  end_ = find(t, t - t_n);
  if (scene_.capabilities().moving_supports)
    change_ = change(t_n, t);
}

void SupportRates::prescribe(const Vector &held, Vector &rate) const {
  if (!scene_.capabilities().moving_supports)
    return;
  supports_.homogeneous().distribute(rate);
  rate += held;
}

Vector SupportRates::change(const double from, const double to) const {
  Vector change = discretization_.make_owned_vector();
  bool moves = false;
  supports_.change(from, to, moves).distribute(change);
  return change;
}

SupportRates::Rates SupportRates::find(const double t, const double step) const {
  Rates rates{discretization_.make_owned_vector(), discretization_.make_owned_vector()};
  if (!scene_.capabilities().moving_supports)
    return rates;
  // A parabola through three times within the run, centred at t if possible.
  const double end = scene_.parameters().time_stepping.end_time, h = std::min(step, 0.5 * end);
  const double middle = std::clamp(t, h, end - h);
  const Vector before = change(middle - h, middle);
  rates.velocity = change(middle, middle + h);
  rates.acceleration = rates.velocity;
  rates.acceleration -= before;
  rates.acceleration /= h * h;
  rates.velocity += before;
  rates.velocity /= 2. * h;
  rates.velocity.add(t - middle, rates.acceleration);
  return rates;
}

} // namespace billet
