// The numerics of the flight application: fixed point flies, float32 is the reference for comparisons.
//
// The sources of fsw/app are compiled into the library fsw_app with FixedPoint and, where TUMBLESIGHT_FLOAT32
// is on, into fsw_app_float32 with TUMBLESIGHT_APP_FLOAT32=1 and Float32. A program links one of the two.
//
// Why a definition and not a template parameter: only comparisons need the second instance, yet the template
// put `template <class N>` before each of the application's member functions, needed five blocks of explicit
// instantiations, a virtual interface between the application and its programs, and both applications in the
// memory of the desktop program. The price is a second library and a second program (flight_float32), built
// from the same sources: the same code is compiled as often as before.
#pragma once

#include "gnc/nn/numerics.hpp"

namespace tumblesight::fsw {

#if TUMBLESIGHT_APP_FLOAT32
using Numerics = gnc::Float32;
#else
using Numerics = gnc::FixedPoint;
#endif

}  // namespace tumblesight::fsw
