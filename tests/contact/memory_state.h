// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_MEMORY_STATE_H
#define BILLET_TESTS_MEMORY_STATE_H

#include "billet/state.h"

#include <map>

namespace billet::testing {

/// A saved state in memory, of one rank and without groups.
struct MemoryState {
  std::map<std::string, std::vector<double>> values;
  std::map<std::string, std::map<std::uint64_t, std::vector<double>>> rows;
};

class MemoryWriter final : public StateWriter {
public:
  explicit MemoryWriter(MemoryState &state) : state_(state) {}

  void write(const std::string &name, const std::vector<double> &values) override {
    state_.values[name] = values;
  }
  void write_text(const std::string &, const std::string &) override {}
  void write_rows(const std::string &name, const std::size_t width, const std::vector<std::uint64_t> &keys,
                  const std::vector<double> &values) override {
    auto &rows = state_.rows[name];
    for (std::size_t i = 0; i < keys.size(); ++i)
      rows[keys[i]].assign(&values.at(width * i), &values.at(width * i) + width);
  }

private:
  void enter(const std::string &) override {}
  void leave() override {}

  MemoryState &state_;
};

class MemoryReader final : public StateReader {
public:
  explicit MemoryReader(const MemoryState &state) : state_(state) {}

  bool has(const std::string &name) const override {
    return state_.values.count(name) + state_.rows.count(name) > 0;
  }
  using StateReader::read;
  std::vector<double> read(const std::string &name) const override { return state_.values.at(name); }
  std::string read_text(const std::string &) const override { return ""; }
  std::vector<double> read_rows(const std::string &name, const std::size_t width,
                                const std::vector<std::uint64_t> &keys,
                                std::vector<bool> *found) const override {
    std::vector<double> result;
    const auto &rows = state_.rows.at(name);
    if (found)
      found->clear();
    for (const std::uint64_t key : keys) {
      const auto row = rows.find(key);
      if (found)
        found->push_back(row != rows.end());
      const std::vector<double> values =
          found && row == rows.end() ? std::vector<double>(width) : rows.at(key);
      result.insert(result.end(), values.begin(), values.end());
    }
    return result;
  }
  std::size_t n_rows(const std::string &name) const override { return state_.rows.at(name).size(); }
  unsigned int n_ranks() const override { return 1; }

private:
  void enter(const std::string &) override {}
  void leave() override {}

  const MemoryState &state_;
};

} // namespace billet::testing

#endif
