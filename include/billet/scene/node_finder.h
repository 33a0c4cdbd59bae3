// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_NODE_FINDER_H
#define BILLET_SCENE_NODE_FINDER_H

#include "billet/parameters/body.h"
#include "billet/scene/node_places.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace billet {

/// Finds the nodes that supports and loads of one body select. Builds its mesh once, for the first
/// of them.
class NodeFinder {
public:
  explicit NodeFinder(const parameters::Body &body) : body_(body) {}

  /// Returns the places of these nodes; null if none are selected. Throws InputError.
  std::shared_ptr<const NodePlaces> find(const NodeSelection &selection);

private:
  void build();
  dealii::Point<3> find_at(const dealii::Point<3> &position, const std::string &origin) const;
  void add_line(const std::array<dealii::Tensor<1, 3>, 2> &ends, const std::string &origin,
                std::vector<dealii::Point<3>> &found) const;
  const std::vector<dealii::Point<3>> &find_set(const std::string &name, const std::string &origin) const;

  const parameters::Body &body_;
  bool is_built_ = false;
  std::vector<dealii::Point<3>> positions_;
  std::vector<double> sizes_; ///< shortest edge at each of these nodes
  std::map<std::string, std::vector<dealii::Point<3>>> sets_;
};

} // namespace billet

#endif
