// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_CONTACTS_H
#define BILLET_CONTACT_CONTACTS_H

#include "billet/contact/body_contact.h"
#include "billet/contact/rigid_contact.h"

#include <boost/iterator/indirect_iterator.hpp>

#include <deque>
#include <memory>
#include <type_traits>
#include <vector>

namespace billet {

/// All contact pairs of a scene: first those with tools, then those between bodies, each in the
/// scene's order.
class Contacts {
public:
  /// Constructs the pairs for schemes with a matrix.
  Contacts(const Scene &scene, const Discretization &discretization, ContactTangent tangent);
  /// Constructs the pairs for schemes without a matrix. `nodes` must outlive this object.
  Contacts(const Scene &scene, const LocalNodes &nodes);
  ~Contacts();
  Contacts(const Contacts &) = delete;
  Contacts &operator=(const Contacts &) = delete;

  bool empty() const { return all_.empty(); }
  std::size_t size() const { return all_.size(); }
  ContactInterface &operator[](const std::size_t i) { return *all_[i]; }
  const ContactInterface &operator[](const std::size_t i) const { return *all_[i]; }
  auto begin() { return boost::make_indirect_iterator(all_.begin()); }
  auto end() { return boost::make_indirect_iterator(all_.end()); }
  auto begin() const { return ConstIterator(all_.begin()); }
  auto end() const { return ConstIterator(all_.end()); }

  /// Returns the pairs with tools.
  std::deque<RigidContact> &of_tools() { return of_tools_; }
  const std::deque<RigidContact> &of_tools() const { return of_tools_; }
  /// Returns the pairs of two bodies and the self-contacts.
  std::deque<BodyContact> &of_bodies() { return of_bodies_; }
  const std::deque<BodyContact> &of_bodies() const { return of_bodies_; }

  /// Returns get(contact) for each pair.
  template <class Get> auto collect(const Get &get) const {
    std::vector<std::decay_t<decltype(get(std::declval<const ContactInterface &>()))>> values;
    values.reserve(size());
    for (const ContactInterface &contact : *this)
      values.push_back(get(contact));
    return values;
  }

  /// Loads for each tool and for each pair of bodies.
  struct Loads {
    std::vector<ContactLoad> of_tools, of_body_pairs;
  };
  /// Computes the loads of all pairs. Collective.
  Loads compute_loads() const;
  /// Returns the number of doubles of history on this rank.
  std::size_t history_size() const;
  std::vector<std::vector<ContactNodeReport>> report() const;
  /// Returns the diagnostics before the first step. Collective.
  DiagnosticList check_start() const;

private:
  using ConstIterator =
      boost::indirect_iterator<std::vector<ContactInterface *>::const_iterator, const ContactInterface>;
  /// Collects pointers to all pairs, once their addresses are final.
  void list_all();

  std::size_t n_tools_;
  std::unique_ptr<LocalNodes> own_nodes_; ///< with a matrix, for contact of bodies
  std::deque<RigidContact> of_tools_;
  std::deque<BodyContact> of_bodies_;
  std::vector<ContactInterface *> all_;
};

} // namespace billet

#endif
