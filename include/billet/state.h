// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_STATE_H
#define BILLET_STATE_H

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

namespace billet {

// Interfaces through which the parts of a run save and restore their state, independent of where it is
// stored. A class with state has a pair of functions save(StateWriter &) const and load(StateReader &).
// load() reads what save() wrote, on any number of ranks. Rows of numbers have keys that do not depend on the
// ranks: NodeKeys for nodes, element_key() for elements. All functions are collective.

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
  /// Writes rows of `width` numbers; the row of keys[i] begins at values[i width]. Several ranks may write
  /// the same row.
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
  /// Returns the rows of these keys, in their order. Without `found`, every key must be present. With
  /// `found`, keys may be missing: it marks those present, and rows of missing keys are 0.
  virtual std::vector<double> read_rows(const std::string &name, std::size_t width,
                                        const std::vector<std::uint64_t> &keys,
                                        std::vector<bool> *found = nullptr) const = 0;
  /// Returns the number of ranks of the run that wrote the state.
  virtual unsigned int n_ranks() const = 0;

  /// Returns a single number.
  double number(const std::string &name) const { return read(name).at(0); }

  template <class Read> void in(const std::string &name, const Read &read) {
    enter(name);
    read();
    leave();
  }

private:
  virtual void enter(const std::string &name) = 0;
  virtual void leave() = 0;
};

/// Reads the numbers of a row one after the other.
class RowReader {
public:
  explicit RowReader(const double *row) : next_(row) {}

  double number() { return *next_++; }
  bool flag() { return number() != 0.; }
  /// Reads a vector of any type with [] and three components.
  template <class Vector> void vector(Vector &v) {
    for (unsigned int i = 0; i < 3; ++i)
      v[i] = number();
  }

private:
  const double *next_;
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
  std::vector<std::uint64_t> keys(
      static_cast<std::size_t>(reader.read_rows(name + " size", 1, {rank}).at(0)));
  std::iota(keys.begin(), keys.end(), std::uint64_t{rank} << 40U);
  return reader.read_rows(name, 1, keys);
}

} // namespace billet

#endif
