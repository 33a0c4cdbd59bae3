// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MESH_MESH_CURSOR_H
#define BILLET_MESH_MESH_CURSOR_H

#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>

namespace billet {

/// Returns the text in lower case (ASCII).
std::string lower_case(std::string_view text);

/// Returns the text without white space at its ends.
std::string_view trimmed(std::string_view text);

/// Whether the text is a whole number, which it then assigns.
bool is_integer(std::string_view text, long long &value);

/// Whether the text is a finite number of at most 1e60, which it then assigns. Exponents of Fortran
/// (1D-3) are numbers, too.
bool is_real(std::string_view text, double &value);

/// Position in the content of a mesh file. All functions throw std::invalid_argument with the line,
/// or in binary parts the byte, where the file has something else.
class MeshCursor {
public:
  explicit MeshCursor(std::string_view bytes) : bytes_(bytes) {}

  /// Number of bytes left.
  std::size_t remaining() const { return bytes_.size() - next_; }
  /// Skips white space. Whether nothing follows.
  bool at_end();
  /// Returns the next word, or nothing at the end of the file.
  std::string_view word();
  /// Returns the next word, but stays in front of it.
  std::string_view next_word();
  /// Returns the rest of the line, trimmed, and moves to the next line.
  std::string_view line();
  void expect(std::string_view expected);
  long long integer(const char *what);
  double real(const char *what);

  /// Returns a number of entries, of which each takes `bytes_each` bytes at least.
  std::size_t count(const char *what, std::size_t bytes_each);
  /// Refuses a number of entries for which the file is too short.
  std::size_t checked_count(const char *what, unsigned long long n, std::size_t bytes_each) const;

  /// Returns the next bytes as a number.
  template <class T> T raw(const char *what) {
    need(sizeof(T), what);
    char bytes[sizeof(T)];
    std::memcpy(bytes, bytes_.data() + next_, sizeof(T));
    if (is_swapped_)
      std::reverse(bytes, bytes + sizeof(T));
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    next_ += sizeof(T);
    return value;
  }
  /// Numbers in binary parts have the other order of bytes than those of the machine.
  void swap_bytes() { is_swapped_ = true; }
  /// Skips bytes.
  void skip(std::size_t n, const char *what);
  /// Skips all up to and including a line that begins with this word. Throws if there is none.
  void skip_behind(const std::string &mark);

  /// Throws "line 5 of it has 'word' where `expected` should be".
  [[noreturn]] void fail(const std::string &expected) const;
  /// Throws "in line 5 of it, `fault`".
  [[noreturn]] void refuse(const std::string &fault) const;
  /// Throws "in byte 17 of it, `fault`", for binary parts.
  [[noreturn]] void refuse_byte(const std::string &fault) const;

private:
  void need(std::size_t n, const char *what) const;
  std::string line_number() const;

  std::string_view bytes_;
  std::size_t next_ = 0, last_ = 0; ///< next byte; beginning of the last word
  bool is_swapped_ = false;
};

} // namespace billet

#endif
