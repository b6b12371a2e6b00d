// The numerics of the flight application: fixed point flies, float32 is the reference for comparisons.
//
// The sources of fsw/app are compiled into the library fsw_app with FixedPoint and, where TUMBLESIGHT_FLOAT32
// is on, into fsw_app_float32 with TUMBLESIGHT_APP_FLOAT32=1 and Float32. A program links one of the two.
//
// Why a definition and not a template parameter: only comparisons need the second instance.
//   template    60 lines with `template` in fsw/app, a virtual interface between application and programs,
//               5.3 MB static memory of the desktop program, which contained both instances
//   definition  none of these lines, plain classes, 0.5 MB; but each source file is compiled twice (29 s of
//               CPU time without ccache, 9 s before), and float32 needs its own program (flight_float32)
// Both give the same code: flight_replay has the same size within 0.2 % and the same digests.
#pragma once

#include "gnc/nn/kernels/numerics.hpp"

namespace tumblesight::fsw {

#if TUMBLESIGHT_APP_FLOAT32
using Numerics = gnc::Float32;
#else
using Numerics = gnc::FixedPoint;
#endif

}  // namespace tumblesight::fsw
