// SPDX-License-Identifier: LGPL-2.1-or-later
// The contact frame: orthonormal and right-handed through any chain of updates, carried by a tool's spin, and
// defined where the normal turns onto q.
#include "billet/geometry/frame.h"

#include "../testing.h"

namespace frame_test {

using namespace billet;
using billet::testing::check;
using billet::testing::WorstError;
using dealii::Tensor;

namespace {

double defect(const Frame &frame) {
  WorstError error;
  error.add(std::abs(frame.q.norm() - 1.));
  error.add(std::abs(frame.r.norm() - 1.));
  error.add(std::abs(frame.q * frame.r));
  error.add(std::abs(frame.q * frame.n));
  error.add(std::abs(frame.r * frame.n));
  error.add((dealii::cross_product_3d(frame.q, frame.r) - frame.n).norm());
  return error.value();
}

} // namespace

BILLET_TEST(frame) {
  billet::testing::Random random;
  const Tensor<2, 3> identity = dealii::unit_symmetric_tensor<3>();
  Tensor<1, 3> z;
  z[2] = 1.;

  WorstError fresh, chain, small_turn;
  Frame frame = Frame::from_normal(z);
  for (unsigned int i = 0; i < 10000; ++i) {
    const Tensor<1, 3> n = random.rotation() * z;
    fresh.add(defect(Frame::from_normal(n)));
    frame = frame.transported(random.rotation(), n);
    chain.add(defect(frame));
    // A small turn of the normal turns q by no more than that: no twist about n.
    const Tensor<1, 3> tilted = (n + 1e-4 * frame.q) / (n + 1e-4 * frame.q).norm();
    small_turn.add((frame.transported(identity, tilted).r - frame.r).norm());
  }
  check("any normal has a frame", fresh.value(), 1e-14);
  check("10000 updates leave the frame orthonormal", chain.value(), 1e-14);
  check("turning the normal in the plane of q and n leaves r alone", small_turn.value(), 1e-14);

  // Rigid rotation: frame and normal turn together, also about the normal itself.
  WorstError rigid;
  for (unsigned int i = 0; i < 1000; ++i) {
    const Tensor<2, 3> R = random.rotation();
    const Frame turned = frame.transported(R, R * frame.n);
    rigid.add((turned.q - R * frame.q).norm());
    rigid.add((turned.r - R * frame.r).norm());
  }
  check("a rigid rotation carries the frame along", rigid.value(), 1e-14);

  check("normal turned by 90 degrees onto q", defect(frame.transported(identity, frame.q)), 1e-14);
  check("normal turned by 90 degrees onto r", defect(frame.transported(identity, frame.r)), 1e-14);
  check("normal reversed", defect(frame.transported(identity, -frame.n)), 1e-14);
}

} // namespace frame_test
