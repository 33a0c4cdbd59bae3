// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PLUGIN_H
#define BILLET_PLUGIN_H

#include "billet/version.h"

/// Begins the function that registers the types of a shared library, which scenes load by
/// 'Libraries':
///   BILLET_PLUGIN { hardening_types().add(...); }
/// A library has one. It may throw: the message then names the library.
#define BILLET_PLUGIN                                                                                        \
  extern "C" const char *billet_plugin_version() { return billet::build_name; }                              \
  extern "C" void billet_plugin_register()

#endif
