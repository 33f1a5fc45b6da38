// SPDX-License-Identifier: MIT
/// @file
/// The visibility of the public names in shared libraries.
#pragma once

/// Makes the names of a namespace visible outside a shared library. All other names of the
/// libraries are hidden. Static libraries are compiled with an empty definition: a plug-in that
/// links one does not export its names.
#ifndef ALPENGLOW_EXPORT
#define ALPENGLOW_EXPORT [[gnu::visibility("default")]]
#endif
