// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mesh/abaqus_sets.h"

#include "billet/mesh/mesh_cursor.h"

#include <algorithm>
#include <stdexcept>

namespace billet {

void AbaqusSets::open(const std::string &name) {
  if (sets_.emplace(lower_case(name), Set()).second)
    names_.push_back(name);
}

void AbaqusSets::add_range(const std::string &name, const long long first, const long long last,
                           const long long step) {
  if (step < 1 || last < first || first < 1)
    throw std::invalid_argument("set '" + name + "' of it has the range from " + std::to_string(first) +
                                " to " + std::to_string(last) + " in steps of " + std::to_string(step));
  sets_.at(lower_case(name)).ranges.push_back({first, last, step});
}

void AbaqusSets::add_set(const std::string &name, const std::string &other) {
  sets_.at(lower_case(name)).others.push_back(lower_case(other));
}

void AbaqusSets::leave_out(const std::string &name) { left_out_.insert(lower_case(name)); }

bool AbaqusSets::has(const std::string &name) const { return sets_.count(lower_case(name)) > 0; }

void AbaqusSets::check_total(const std::size_t n, const std::size_t max_members) {
  n_members_ += n;
  if (n_members_ > max_members)
    throw std::invalid_argument("its sets have more than " + std::to_string(max_members) + " " +
                                member_word_ + "s in all, too many for a file of this size");
}

const std::vector<long long> &AbaqusSets::members(const std::string &name,
                                                  const std::function<bool(long long)> &exists,
                                                  const std::size_t n_existing,
                                                  const std::size_t max_members) {
  static const std::vector<long long> none;
  constexpr unsigned int max_depth = 100;
  const auto found = sets_.find(lower_case(name));
  if (found == sets_.end()) {
    if (left_out_.count(lower_case(name)) > 0)
      return none;
    throw std::invalid_argument("it names a set '" + name + "' of " + member_word_ + "s, which is missing");
  }
  Set &set = found->second;
  if (set.is_known)
    return set.members;
  if (set.is_open || depth_ > max_depth)
    throw std::invalid_argument("its set '" + name + "' contains itself");
  set.is_open = true;
  ++depth_;
  for (const Range &range : set.ranges) {
    // All members have to exist, so that there are no more than existing ones.
    const auto n = static_cast<unsigned long long>((range.last - range.first) / range.step) + 1;
    if (n > n_existing)
      throw std::invalid_argument("its set '" + name + "' has " + std::to_string(n) + " " + member_word_ +
                                  "s in a range, but the file has only " + std::to_string(n_existing));
    check_total(n, max_members);
    for (unsigned long long i = 0; i < n; ++i) {
      const long long member = range.first + static_cast<long long>(i) * range.step;
      if (!exists(member))
        throw std::invalid_argument("its set '" + name + "' names " + member_word_ + " " +
                                    std::to_string(member) + ", which is missing");
      set.members.push_back(member);
    }
  }
  for (const std::string &other : set.others) {
    const std::vector<long long> &more = members(other, exists, n_existing, max_members);
    check_total(more.size(), max_members);
    set.members.insert(set.members.end(), more.begin(), more.end());
  }
  --depth_;
  std::sort(set.members.begin(), set.members.end());
  set.members.erase(std::unique(set.members.begin(), set.members.end()), set.members.end());
  set.is_known = true;
  return set.members;
}

} // namespace billet
