// SPDX-License-Identifier: MIT
/// @file
/// All public headers of Alpenglow.
///
/// Names of values end in their unit (_m, _deg, _nm, _lx). Angles are in degrees, other quantities
/// in SI units, wavelengths in nanometres.
#pragma once

#include <alpenglow/atmosphere.h>
#include <alpenglow/batch.h>
#include <alpenglow/clouds.h>
#include <alpenglow/errors.h>
#include <alpenglow/export.h>
#include <alpenglow/geometry.h>
#include <alpenglow/image.h>
#include <alpenglow/panorama.h>
#include <alpenglow/place_time.h>
#include <alpenglow/progress.h>
#include <alpenglow/scene.h>
#include <alpenglow/sky.h>
#include <alpenglow/spectrum.h>
#include <alpenglow/sun_and_moon.h>
#include <alpenglow/tables.h>
#include <alpenglow/version.h>
