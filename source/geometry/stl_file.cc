// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/triangle_mesh.h"
#include "billet/printable.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace billet {

using dealii::Tensor;

namespace {

/// Collects facets and counts those whose written normal is against the order of their corners.
class FacetCollector {
public:
  void add(const Tensor<1, 3> &normal, const std::array<Tensor<1, 3>, 3> &corners) {
    const auto first = static_cast<unsigned int>(mesh_.points.size());
    mesh_.points.insert(mesh_.points.end(), corners.begin(), corners.end());
    mesh_.facets.push_back({first, first + 1, first + 2});
    const Tensor<1, 3> walked = dealii::cross_product_3d(Tensor<1, 3>(corners[1] - corners[0]),
                                                         Tensor<1, 3>(corners[2] - corners[0]));
    // Many programs write zeros.
    if (normal * walked < -0.5 * normal.norm() * walked.norm())
      ++n_against_;
  }

  TriangleMesh finish() {
    if (mesh_.facets.empty())
      throw std::invalid_argument("it holds no facet");
    if (2 * n_against_ > mesh_.facets.size())
      throw std::invalid_argument(
          "its normals are opposite to the order of the corners (right-handed about the normal) in " +
          std::to_string(n_against_) + " of " + std::to_string(mesh_.facets.size()) + " facets");
    return std::move(mesh_);
  }

private:
  TriangleMesh mesh_;
  std::size_t n_against_ = 0;
};

/// Words of an ASCII STL file.
class AsciiReader {
public:
  explicit AsciiReader(const std::string &text) : next_(text.c_str()), end_(text.c_str() + text.size()) {}

  TriangleMesh read() {
    FacetCollector facets;
    expect("solid");
    skip_line(); // name of the solid
    while (true) {
      if (accept("facet")) {
        expect("normal");
        const Tensor<1, 3> normal = vector();
        expect("outer");
        expect("loop");
        std::array<Tensor<1, 3>, 3> corners;
        for (auto &corner : corners) {
          expect("vertex");
          corner = vector();
        }
        expect("endloop");
        expect("endfacet");
        facets.add(normal, corners);
      } else {
        expect("endsolid");
        skip_line();
        if (!accept("solid"))
          break;
        skip_line();
      }
    }
    if (!word().empty())
      fail("'solid' or the end of the file");
    return facets.finish();
  }

private:
  /// Returns the next word, in lower case; empty at the end of the file.
  std::string word() {
    for (; next_ != end_ && std::isspace(static_cast<unsigned char>(*next_)) != 0; ++next_)
      line_ += *next_ == '\n' ? 1 : 0;
    word_.clear();
    for (; next_ != end_ && std::isspace(static_cast<unsigned char>(*next_)) == 0; ++next_)
      word_ += static_cast<char>(std::tolower(static_cast<unsigned char>(*next_)));
    return word_;
  }
  bool accept(const std::string &expected) {
    const char *const before = next_;
    const unsigned int line_before = line_;
    if (word() == expected)
      return true;
    next_ = before;
    line_ = line_before;
    return false;
  }
  void expect(const std::string &expected) {
    if (word() != expected)
      fail("'" + expected + "'");
  }
  void skip_line() {
    while (next_ != end_ && *next_ != '\n')
      ++next_;
  }
  Tensor<1, 3> vector() {
    Tensor<1, 3> result;
    for (unsigned int i = 0; i < 3; ++i) {
      char *rest = nullptr;
      result[i] = word().empty() ? std::nan("") : std::strtod(word_.c_str(), &rest);
      if (!std::isfinite(result[i]) || *rest != '\0')
        fail("a finite number");
    }
    return result;
  }
  [[noreturn]] void fail(const std::string &expected) const {
    constexpr std::size_t max_length = 40;
    throw std::invalid_argument(
        "line " + std::to_string(line_) + " of it has " +
        (word_.empty() ? "the end of the file" : "'" + printable(word_, max_length) + "'") + " where " +
        expected + " should be");
  }

  const char *next_, *end_;
  unsigned int line_ = 1;
  std::string word_;
};

constexpr std::size_t header_size = 84, facet_size = 50; // sizes in a binary file [bytes]

std::uint32_t read_integer(const char *bytes) {
  std::uint32_t value = 0;
  for (unsigned int i = 4; i-- > 0;)
    value = (value << 8U) | static_cast<unsigned char>(bytes[i]);
  return value;
}

Tensor<1, 3> read_vector(const char *bytes) {
  Tensor<1, 3> result;
  for (unsigned int i = 0; i < 3; ++i, bytes += 4) {
    const std::uint32_t bits = read_integer(bytes);
    float value = 0.F;
    std::memcpy(&value, &bits, sizeof value);
    result[i] = value;
  }
  return result;
}

TriangleMesh read_binary(const std::string &bytes) {
  FacetCollector facets;
  const std::size_t n = read_integer(bytes.data() + header_size - 4);
  for (std::size_t i = 0; i < n; ++i) {
    const char *const facet = bytes.data() + header_size + i * facet_size;
    std::array<Tensor<1, 3>, 3> corners;
    for (unsigned int c = 0; c < 3; ++c) {
      corners[c] = read_vector(facet + std::size_t{12} * (c + 1));
      if (!std::isfinite(corners[c].norm_square()))
        throw std::invalid_argument("facet " + std::to_string(i + 1) +
                                    " of it has a corner that is not finite");
    }
    const Tensor<1, 3> normal = read_vector(facet);
    facets.add(std::isfinite(normal.norm_square()) ? normal : Tensor<1, 3>(), corners);
  }
  return facets.finish();
}

} // namespace

TriangleMesh read_stl(const std::string &file_name) {
  std::ifstream stream(file_name, std::ios::binary);
  std::ostringstream buffer;
  buffer << stream.rdbuf();
  const std::string bytes = buffer.str();
  // Binary files may begin with "solid", too: the size identifies them.
  const std::size_t n = bytes.size() >= header_size ? read_integer(bytes.data() + header_size - 4) : 0;
  if (bytes.size() >= header_size && bytes.size() == header_size + n * facet_size)
    return read_binary(bytes);
  const auto begin = bytes.find_first_not_of(" \t\r\n");
  if (begin != std::string::npos && bytes.compare(begin, 5, "solid") == 0 &&
      bytes.find('\0') == std::string::npos)
    return AsciiReader(bytes).read();
  throw std::invalid_argument(
      "it neither begins with 'solid', as an ASCII file does, nor has the length of a binary file: " +
      (bytes.size() < header_size ? std::to_string(bytes.size()) + " bytes are less than a header"
                                  : std::to_string(bytes.size()) + " bytes, not the " +
                                        std::to_string(header_size + n * facet_size) + " of the " +
                                        std::to_string(n) + " facets in its header"));
}

} // namespace billet
