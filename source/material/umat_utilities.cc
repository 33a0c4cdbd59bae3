// SPDX-License-Identifier: LGPL-2.1-or-later
// Subroutines of Abaqus that a UMAT may call, under their names in Fortran: the program exports
// them for the libraries that it loads. Tensors are 11, 22, 33, 12, 13, 23; with LSTR = 2 they are
// strains with engineering shears.

#include "billet/material/guarded_call.h"
#include "billet/material/subroutine_messages.h"

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <sstream>
#include <string>

namespace {

using dealii::SymmetricTensor;
using dealii::Tensor;

SymmetricTensor<2, 3> read_tensor(const double *s, const int strain, const int ndi, const int nshr) {
  const double shear = strain == 2 ? 0.5 : 1.;
  SymmetricTensor<2, 3> result;
  for (int i = 0; i < std::min(ndi, 3); ++i)
    result[i][i] = s[i];
  for (int i = 0; i < std::min(nshr, 3); ++i)
    result.access_raw_entry(static_cast<unsigned int>(3 + i)) = shear * s[ndi + i];
  return result;
}

/// Writes a text of Fortran, padded with blanks.
void write_text(const std::string &text, char *target, const std::size_t length) {
  std::fill_n(target, length, ' ');
  std::copy_n(text.begin(), std::min(text.size(), length), target);
}

std::string trim(const char *text, std::size_t length) {
  while (length > 0 && (text[length - 1] == ' ' || text[length - 1] == '\0'))
    --length;
  return {text, length};
}

/// Returns the text with %I, %R and %S replaced by the next integer, number and text.
std::string fill_in(const std::string &text, const int *integers, const double *numbers, const char *texts) {
  constexpr std::size_t text_length = 8;
  std::ostringstream result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char kind = text[i] == '%' && i + 1 < text.size() ? text[i + 1] : ' ';
    if (kind == 'I' || kind == 'i')
      result << *integers++;
    else if (kind == 'R' || kind == 'r')
      result << *numbers++;
    else if (kind == 'S' || kind == 's') {
      result << trim(texts, text_length);
      texts += text_length;
    } else {
      result << text[i];
      continue;
    }
    ++i;
  }
  return result.str();
}

// Apart from XIT, which leaves without destructors.
void keep_message(const int level, const std::string &format, const int *integers, const double *numbers,
                  const char *texts) {
  billet::keep_subroutine_message(level, format, fill_in(format, integers, numbers, texts));
}

} // namespace

extern "C" {

void xit_();
void sinv_(const double *s, double *mean, double *mises, const int *ndi, const int *nshr);
void sprinc_(const double *s, double *values, const int *lstr, const int *ndi, const int *nshr);
void sprind_(const double *s, double *values, double *directions, const int *lstr, const int *ndi,
             const int *nshr);
void rotsig_(const double *s, const double *rotation, double *turned, const int *lstr, const int *ndi,
             const int *nshr);
void stdb_abqerr_(const int *level, const char *text, const int *integers, const double *numbers,
                  const char *texts, std::size_t length, std::size_t texts_length);
void xplb_abqerr_(const int *level, const char *text, const int *integers, const double *numbers,
                  const char *texts, std::size_t length, std::size_t texts_length);
void xplb_exit_();
void getoutdir_(char *folder, int *length, std::size_t room);
void getjobname_(char *name, int *length, std::size_t room);

/// Ends the analysis: the run reports the UMAT.
void xit_() {
  billet::leave_guarded_call();
  std::exit(3);
}

/// Computes the mean of the normal components and von Mises' stress.
void sinv_(const double *s, double *mean, double *mises, const int *ndi, const int *nshr) {
  const SymmetricTensor<2, 3> tensor = read_tensor(s, 1, *ndi, *nshr);
  *mean = dealii::trace(tensor) / 3.;
  *mises = std::sqrt(1.5) * dealii::deviator(tensor).norm();
}

/// Computes the principal values, the largest first.
void sprinc_(const double *s, double *values, const int *lstr, const int *ndi, const int *nshr) {
  const auto found = dealii::eigenvalues(read_tensor(s, *lstr, *ndi, *nshr));
  std::copy(found.begin(), found.end(), values);
}

/// Computes principal values and directions: component i of direction k is directions(k, i).
void sprind_(const double *s, double *values, double *directions, const int *lstr, const int *ndi,
             const int *nshr) {
  const auto pairs = dealii::eigenvectors(read_tensor(s, *lstr, *ndi, *nshr),
                                          dealii::SymmetricTensorEigenvectorMethod::jacobi);
  for (unsigned int k = 0; k < 3; ++k) {
    values[k] = pairs[k].first;
    for (unsigned int i = 0; i < 3; ++i)
      directions[k + 3 * i] = pairs[k].second[i];
  }
}

/// Computes R S Rᵀ.
void rotsig_(const double *s, const double *rotation, double *turned, const int *lstr, const int *ndi,
             const int *nshr) {
  Tensor<2, 3> R;
  for (unsigned int i = 0; i < 9; ++i)
    R[i % 3][i / 3] = rotation[i];
  const Tensor<2, 3> S = read_tensor(s, *lstr, *ndi, *nshr), T = R * S * dealii::transpose(R);
  const SymmetricTensor<2, 3> result = dealii::symmetrize(T);
  for (int i = 0; i < *ndi; ++i)
    turned[i] = result[i][i];
  for (int i = 0; i < *nshr; ++i)
    turned[*ndi + i] = (*lstr == 2 ? 2. : 1.) * result.access_raw_entry(static_cast<unsigned int>(3 + i));
}

/// Keeps a message for the run. An error of level -3 ends the analysis.
void stdb_abqerr_(const int *level, const char *text, const int *integers, const double *numbers,
                  const char *texts, const std::size_t length, std::size_t) {
  keep_message(*level, trim(text, length), integers, numbers, texts);
  if (*level == -3)
    xit_();
}

/// The same for a VUMAT.
void xplb_abqerr_(const int *level, const char *text, const int *integers, const double *numbers,
                  const char *texts, const std::size_t length, const std::size_t texts_length) {
  stdb_abqerr_(level, text, integers, numbers, texts, length, texts_length);
}

/// Ends the analysis for a VUMAT.
void xplb_exit_() { xit_(); }

/// Returns the current folder: scenes name their own output folders.
void getoutdir_(char *folder, int *length, const std::size_t room) {
  write_text(".", folder, room);
  *length = 1;
}

void getjobname_(char *name, int *length, const std::size_t room) {
  write_text("billet", name, room);
  *length = 6;
}

} // extern "C"
