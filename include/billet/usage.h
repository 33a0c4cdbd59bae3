// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_USAGE_H
#define BILLET_USAGE_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace billet {

/// Capabilities that cost time and memory only in scenes that use them. Scene::describe() reports
/// which of them a scene uses.
enum class Capability {
  plasticity,
  stabilisation, ///< of one-point elements
  contact,
  friction,
  body_contact, ///< search and exchange of facets
  self_contact,
  edges,
  augmentation,
  moving_supports,
  driven_tools,
  loads,
  inertia,
  error_control,
  matrix,
  unsymmetric_matrix,
  iterative_solver,
  checkpoints,
  n
};

/// Returns the capability's name; Scene::describe() uses the same.
const char *name_of(Capability capability);

/// Counters of each capability in this process: calls of its loops, items in them (elements, nodes,
/// pairs, tools, entries), and the peak of its memory. Loops are counted as a whole, never inside.
/// Capabilities that a scene does not use stay at 0.
class Usage {
public:
  struct Entry {
    std::uint64_t calls = 0, items = 0;
    std::uint64_t bytes = 0, peak = 0; ///< allocated now, and the maximum [bytes]
  };

  static void count(const Capability capability, const std::size_t n_items) {
    Entry &entry = at(capability);
    ++entry.calls;
    entry.items += n_items;
  }
  /// Counts a call if the capability is used.
  static void count_if(const bool is_used, const Capability capability, const std::size_t n_items) {
    if (is_used)
      count(capability, n_items);
  }
  static const Entry &of(const Capability capability) { return at(capability); }

private:
  friend class HeldMemory;
  static Entry &at(const Capability capability) { return entries[static_cast<std::size_t>(capability)]; }
  static std::array<Entry, static_cast<std::size_t>(Capability::n)> entries;
};

/// Loops over all elements of this process: those for forces alone, and those for the tangent.
struct ElementLoops {
  static std::uint64_t of_forces, of_tangents;
};

/// Records the memory that an object allocates for a capability, for the lifetime of the object.
class HeldMemory {
public:
  explicit HeldMemory(const Capability capability) : capability_(capability) {}
  HeldMemory(HeldMemory &&other) noexcept
      : capability_(other.capability_), bytes_(std::exchange(other.bytes_, 0)) {}
  HeldMemory(const HeldMemory &) = delete;
  HeldMemory &operator=(const HeldMemory &) = delete;
  HeldMemory &operator=(HeldMemory &&) = delete;
  ~HeldMemory() { set(0); }

  void set(const std::size_t bytes) {
    Usage::Entry &entry = Usage::at(capability_);
    entry.bytes += bytes - bytes_;
    entry.peak = entry.bytes > entry.peak ? entry.bytes : entry.peak;
    bytes_ = bytes;
  }

private:
  Capability capability_;
  std::size_t bytes_ = 0;
};

} // namespace billet

#endif
