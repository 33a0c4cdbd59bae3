// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MESH_ABAQUS_SETS_H
#define BILLET_MESH_ABAQUS_SETS_H

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace billet {

/// Sets of nodes, or of elements, of an Abaqus deck. Names count in lower case. Members may be
/// ranges or other sets, which may follow later.
class AbaqusSets {
public:
  /// `member_word`: "node" or "element".
  explicit AbaqusSets(std::string member_word) : member_word_(std::move(member_word)) {}

  /// Opens a set; one with this name is continued.
  void open(const std::string &name);
  void add(const std::string &name, long long member) { add_range(name, member, member, 1); }
  void add_range(const std::string &name, long long first, long long last, long long step);
  void add_set(const std::string &name, const std::string &other);
  /// Remembers a set whose members are not read, such as reference points of an assembly.
  void leave_out(const std::string &name);

  bool has(const std::string &name) const;
  /// Returns the names as the file has them, in the order in which the sets were opened.
  const std::vector<std::string> &names() const { return names_; }

  /// Returns the members of a set, sorted, each once. Throws std::invalid_argument if the set or a
  /// member is missing, or if all sets have more than `max_members` in all.
  const std::vector<long long> &members(const std::string &name, const std::function<bool(long long)> &exists,
                                        std::size_t n_existing, std::size_t max_members);

private:
  struct Range {
    long long first, last, step;
  };
  struct Set {
    std::vector<Range> ranges;
    std::vector<std::string> others;
    std::vector<long long> members;
    bool is_open = false, is_known = false;
  };
  void check_total(std::size_t n, std::size_t max_members);

  std::string member_word_;
  std::map<std::string, Set> sets_;
  std::vector<std::string> names_;
  std::set<std::string> left_out_;
  std::size_t n_members_ = 0;
  unsigned int depth_ = 0;
};

} // namespace billet

#endif
