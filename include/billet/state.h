// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_STATE_H
#define BILLET_STATE_H

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

namespace billet {

// How the parts of a run hand over their state, and take it back, without knowing where it is kept. A class
// with state has a pair save(StateWriter &) const, load(StateReader &): what load() gets is what save() gave,
// on any number of ranks. Rows of numbers stand under keys that do not depend on the ranks: of nodes
// NodeKeys, of elements element_key(). All functions are collective.

/// Takes state. Names are words; those within one group differ.
class StateWriter {
public:
  StateWriter() = default;
  StateWriter(const StateWriter &) = delete;
  StateWriter &operator=(const StateWriter &) = delete;
  virtual ~StateWriter() = default;

  /// Numbers of the whole run, the same on all ranks.
  virtual void write(const std::string &name, const std::vector<double> &values) = 0;
  virtual void write_text(const std::string &name, const std::string &text) = 0;
  /// Numbers in rows of `width`, the row of keys[i] at i width. A row that several ranks have may come from
  /// each of them.
  virtual void write_rows(const std::string &name, std::size_t width, const std::vector<std::uint64_t> &keys,
                          const std::vector<double> &values) = 0;

  /// What `write` writes goes into a group of this name.
  template <class Write> void in(const std::string &name, const Write &write) {
    enter(name);
    write();
    leave();
  }

private:
  virtual void enter(const std::string &name) = 0;
  virtual void leave() = 0;
};

/// Gives state back. Throws InputError, on all ranks, where something is not there or has another size.
class StateReader {
public:
  StateReader() = default;
  StateReader(const StateReader &) = delete;
  StateReader &operator=(const StateReader &) = delete;
  virtual ~StateReader() = default;

  /// Whether the group at hand has something, or a group, of this name.
  virtual bool has(const std::string &name) const = 0;
  virtual std::vector<double> read(const std::string &name) const = 0;
  virtual std::string read_text(const std::string &name) const = 0;
  /// Those of these keys, in their order. Where `found` is given, keys may be missing: it says which are
  /// there, and the others' numbers are 0.
  virtual std::vector<double> read_rows(const std::string &name, std::size_t width,
                                        const std::vector<std::uint64_t> &keys,
                                        std::vector<bool> *found = nullptr) const = 0;
  /// Of the run that wrote.
  virtual unsigned int n_ranks() const = 0;

  /// A single number.
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

/// Takes numbers from a row, one after the other.
class RowReader {
public:
  explicit RowReader(const double *row) : next_(row) {}

  double number() { return *next_++; }
  bool flag() { return number() != 0.; }
  /// Of any type with [] and three components.
  template <class Vector> void vector(Vector &v) {
    for (unsigned int i = 0; i < 3; ++i)
      v[i] = number();
  }

private:
  const double *next_;
};

/// Puts numbers after each other.
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

/// Numbers of each rank that stand under no keys, as many as it likes.
inline void write_list(StateWriter &writer, const std::string &name, const unsigned int rank,
                       const std::vector<double> &numbers) {
  std::vector<std::uint64_t> keys(numbers.size());
  std::iota(keys.begin(), keys.end(), std::uint64_t{rank} << 40U);
  writer.write_rows(name + " size", 1, {rank}, {static_cast<double>(numbers.size())});
  writer.write_rows(name, 1, keys, numbers);
}

/// Those of one rank of the run that wrote, which may be another one on each.
inline std::vector<double> read_list(const StateReader &reader, const std::string &name,
                                     const unsigned int rank) {
  std::vector<std::uint64_t> keys(
      static_cast<std::size_t>(reader.read_rows(name + " size", 1, {rank}).at(0)));
  std::iota(keys.begin(), keys.end(), std::uint64_t{rank} << 40U);
  return reader.read_rows(name, 1, keys);
}

} // namespace billet

#endif
