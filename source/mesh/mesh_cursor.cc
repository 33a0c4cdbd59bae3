// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mesh/mesh_cursor.h"

#include "billet/printable.h"

#include <charconv>
#include <cmath>
#include <stdexcept>

namespace billet {

namespace {

bool is_space(const char c) {
  return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

std::string quoted(const std::string_view text) {
  constexpr std::size_t max_length = 40;
  return "'" + printable(text, max_length) + "'";
}

} // namespace

std::string lower_case(const std::string_view text) {
  std::string result(text);
  for (char &c : result)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return result;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front()))
    text.remove_prefix(1);
  while (!text.empty() && is_space(text.back()))
    text.remove_suffix(1);
  return text;
}

bool is_integer(std::string_view text, long long &value) {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-')
    text.remove_prefix(1);
  const char *const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && rest == end;
}

bool is_real(std::string_view text, double &value) {
  constexpr double maximum = 1e60; // products of larger numbers exceed the range of the machine
  constexpr std::size_t max_length = 64;
  if (text.size() > 1 && text.front() == '+' && text[1] != '-')
    text.remove_prefix(1);
  std::string fortran;
  if (text.size() < max_length && text.find_first_of("dD") != std::string_view::npos) {
    fortran = text;
    for (char &c : fortran)
      c = c == 'd' || c == 'D' ? 'e' : c;
    text = fortran;
  }
  const char *const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc::result_out_of_range && rest == end) {
    value = 0.; // below the range of the machine; above it is refused as too large
    return text.find("e-") != std::string_view::npos || text.find("E-") != std::string_view::npos;
  }
  return error == std::errc() && rest == end && std::abs(value) <= maximum;
}

bool MeshCursor::at_end() {
  while (next_ < bytes_.size() && is_space(bytes_[next_]))
    ++next_;
  return next_ == bytes_.size();
}

std::string_view MeshCursor::word() {
  at_end();
  last_ = next_;
  while (next_ < bytes_.size() && !is_space(bytes_[next_]))
    ++next_;
  return bytes_.substr(last_, next_ - last_);
}

std::string_view MeshCursor::next_word() {
  const std::size_t next = next_, last = last_;
  const std::string_view result = word();
  next_ = next;
  last_ = last;
  return result;
}

std::string_view MeshCursor::line() {
  last_ = next_;
  const std::size_t end = std::min(bytes_.find('\n', next_), bytes_.size());
  const std::string_view result = bytes_.substr(next_, end - next_);
  next_ = std::min(end + 1, bytes_.size());
  return trimmed(result);
}

void MeshCursor::expect(const std::string_view expected) {
  if (word() != expected)
    fail("'" + std::string(expected) + "'");
}

long long MeshCursor::integer(const char *const what) {
  long long value = 0;
  if (!is_integer(word(), value))
    fail(what);
  return value;
}

double MeshCursor::real(const char *const what) {
  double value = 0.;
  if (!is_real(word(), value))
    fail(what);
  return value;
}

std::size_t MeshCursor::count(const char *const what, const std::size_t bytes_each) {
  const long long n = integer(what);
  if (n < 0)
    fail(what);
  return checked_count(what, static_cast<unsigned long long>(n), bytes_each);
}

std::size_t MeshCursor::checked_count(const char *const what, const unsigned long long n,
                                      const std::size_t bytes_each) const {
  if (n > remaining() / bytes_each)
    refuse(std::string(what) + " is " + std::to_string(n) + ", for which the " + std::to_string(remaining()) +
           " bytes that follow are too few: the file is damaged or cut short");
  return static_cast<std::size_t>(n);
}

void MeshCursor::need(const std::size_t n, const char *const what) const {
  if (n > remaining())
    refuse_byte(std::string(what) + " should follow: the file is cut short");
}

void MeshCursor::skip(const std::size_t n, const char *const what) {
  need(n, what);
  next_ += n;
}

void MeshCursor::skip_behind(const std::string &mark) {
  for (std::size_t found = bytes_.find(mark, next_); found != std::string_view::npos;
       found = bytes_.find(mark, found + 1)) {
    const std::size_t end = found + mark.size();
    if ((found == 0 || is_space(bytes_[found - 1])) && (end == bytes_.size() || is_space(bytes_[end]))) {
      next_ = end;
      return;
    }
  }
  refuse("no '" + mark + "' follows: the file is damaged or cut short");
}

std::string MeshCursor::line_number() const {
  return std::to_string(
      1 + std::count(bytes_.begin(),
                     bytes_.begin() + static_cast<std::ptrdiff_t>(std::min(last_, bytes_.size())), '\n'));
}

void MeshCursor::fail(const std::string &expected) const {
  throw std::invalid_argument(
      "line " + line_number() + " of it has " +
      (last_ >= bytes_.size() ? "the end of the file" : quoted(bytes_.substr(last_, next_ - last_))) +
      " where " + expected + " should be");
}

void MeshCursor::refuse(const std::string &fault) const {
  throw std::invalid_argument("in line " + line_number() + " of it, " + fault);
}

void MeshCursor::refuse_byte(const std::string &fault) const {
  throw std::invalid_argument("in byte " + std::to_string(next_ + 1) + " of it, " + fault);
}

} // namespace billet
