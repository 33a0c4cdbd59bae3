// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_STATE_H
#define BILLET_STATE_H

#include "billet/errors.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

namespace billet {

// Interfaces through which the parts of a run save and restore their state, independent of where it
// is stored. A class with state has a pair of functions save(StateWriter &) const and
// load(StateReader &). load() reads what save() wrote, on any number of ranks. Rows of numbers have
// keys that do not depend on the ranks: NodeKeys for nodes, element_key() for elements. All
// functions are collective.

/// Writes state. Names are words and unique within their group.
class StateWriter {
public:
  StateWriter() = default;
  StateWriter(const StateWriter &) = delete;
  StateWriter &operator=(const StateWriter &) = delete;
  virtual ~StateWriter() = default;

  /// Writes numbers of the whole run, which are the same on all ranks.
  virtual void write(const std::string &name, const std::vector<double> &values) = 0;
  virtual void write_text(const std::string &name, const std::string &text) = 0;
  /// Writes rows of `width` numbers; the row of keys[i] begins at values[i width]. Several ranks
  /// may write the same row.
  virtual void write_rows(const std::string &name, std::size_t width, const std::vector<std::uint64_t> &keys,
                          const std::vector<double> &values) = 0;

  /// Calls `write` inside the group `name`.
  template <class Write> void in(const std::string &name, const Write &write) {
    enter(name);
    write();
    leave();
  }

private:
  virtual void enter(const std::string &name) = 0;
  virtual void leave() = 0;
};

/// Returns a count from a number of a file. Throws InputError if it is not a whole number from 0 to
/// `max`.
template <class Count = unsigned int>
Count to_count(const double value, const Count max = std::numeric_limits<Count>::max()) {
  if (!(value >= 0. && value <= static_cast<double>(max)) || value != std::floor(value))
    throw InputError("its count " + std::to_string(value) + " is no whole number from 0 to " +
                     std::to_string(max));
  return static_cast<Count>(value);
}

/// Reads state. Throws InputError, on all ranks, if an entry is missing or has another size.
class StateReader {
public:
  StateReader() = default;
  StateReader(const StateReader &) = delete;
  StateReader &operator=(const StateReader &) = delete;
  virtual ~StateReader() = default;

  /// Whether the current group has an entry or a group of this name.
  virtual bool has(const std::string &name) const = 0;
  virtual std::vector<double> read(const std::string &name) const = 0;
  virtual std::string read_text(const std::string &name) const = 0;
  /// Returns the rows of these keys, in their order. Without `found`, every key must be present.
  /// With `found`, keys may be missing: it marks those present, and rows of missing keys are 0.
  virtual std::vector<double> read_rows(const std::string &name, std::size_t width,
                                        const std::vector<std::uint64_t> &keys,
                                        std::vector<bool> *found = nullptr) const = 0;
  /// Returns the number of rows of all ranks.
  virtual std::size_t n_rows(const std::string &name) const = 0;
  /// Returns the number of ranks of the run that wrote the state.
  virtual unsigned int n_ranks() const = 0;

  /// Returns `size` numbers.
  std::vector<double> read(const std::string &name, const std::size_t size) const {
    std::vector<double> values = read(name);
    if (values.size() != size)
      throw InputError("its '" + name + "' has " + std::to_string(values.size()) + " numbers, expected are " +
                       std::to_string(size));
    return values;
  }
  double number(const std::string &name) const { return read(name, 1)[0]; }
  unsigned int count(const std::string &name) const { return to_count(number(name)); }

  template <class Read> void in(const std::string &name, const Read &read) {
    enter(name);
    read();
    leave();
  }

protected:
  // For readers that pass on what another one reads:
  static void enter_group(StateReader &of, const std::string &name) { of.enter(name); }
  static void leave_group(StateReader &of) { of.leave(); }

private:
  virtual void enter(const std::string &name) = 0;
  virtual void leave() = 0;
};

/// Reads the numbers of a row, or of a list, one after the other. Throws InputError beyond its end.
class RowReader {
public:
  RowReader(const double *row, const std::size_t width) : next_(row), end_(row + width) {}
  explicit RowReader(const std::vector<double> &list) : RowReader(list.data(), list.size()) {}

  bool is_at_end() const { return next_ == end_; }
  double number() {
    if (is_at_end())
      throw InputError("it has a list that is too short");
    return *next_++;
  }
  bool flag() { return number() != 0.; }
  /// Reads a vector of any type with [] and three components.
  template <class Vector> void vector(Vector &v) {
    for (unsigned int i = 0; i < 3; ++i)
      v[i] = number();
  }

private:
  const double *next_, *end_;
};

/// Appends numbers to a list.
class RowWriter {
public:
  explicit RowWriter(std::vector<double> &values) : values_(values) {}

  RowWriter &number(const double value) {
    values_.push_back(value);
    return *this;
  }
  template <class Vector> RowWriter &vector(const Vector &v) {
    for (unsigned int i = 0; i < 3; ++i)
      values_.push_back(v[i]);
    return *this;
  }

private:
  std::vector<double> &values_;
};

/// Writes a list of any length for each rank, for numbers without keys.
inline void write_list(StateWriter &writer, const std::string &name, const unsigned int rank,
                       const std::vector<double> &numbers) {
  std::vector<std::uint64_t> keys(numbers.size());
  std::iota(keys.begin(), keys.end(), std::uint64_t{rank} << 40U);
  writer.write_rows(name + " size", 1, {rank}, {static_cast<double>(numbers.size())});
  writer.write_rows(name, 1, keys, numbers);
}

/// Returns the list of one rank of the run that wrote the state; each rank may read another one.
inline std::vector<double> read_list(const StateReader &reader, const std::string &name,
                                     const unsigned int rank) {
  const double size = reader.read_rows(name + " size", 1, {rank})[0];
  const std::size_t n_rows = reader.n_rows(name);
  const bool is_sound = size >= 0. && size <= static_cast<double>(n_rows);
  // read_rows() refuses a list with one row too many on all ranks.
  std::vector<std::uint64_t> keys(is_sound ? static_cast<std::size_t>(size) : n_rows + 1);
  std::iota(keys.begin(), keys.end(), std::uint64_t{rank} << 40U);
  return reader.read_rows(name, 1, keys);
}

} // namespace billet

#endif
