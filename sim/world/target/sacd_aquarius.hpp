// SAC-D/Aquarius: the parametric targets that ship with Tumblesight, as launched (stowed) and as flown.
//
// TRF: z along the bus from the launch adapter to the reflector's end, the solar panels on +-y, the feed
// horns looking towards -x, metres; origin as in the stowed display model. Stowed: box x and y +-1.26, z
// -1.32..2.95.
//
// Measured, off the stowed display model of "NASA 3D Resources": every part and, stowed, its place. Parts
// smaller than about 2 cm are left out. There is no display model of the flight configuration; these are our
// assumptions for it, led by that model's hinges:
// - Each panel has swung out by 90 deg about the hinge at the lower end of the bus (axis along x, y +-0.68,
//   z -1.08), so that it lies across z; its cut-outs then clear the launch adapter. Wings are not turned to
//   the Sun.
// - The boom has swung about the axis of its foot (along y, x -0.72, z 1.21) towards -x, and the reflector
//   about the axis at the boom's end until its rim stands along z, its hollow side towards the horns. The
//   boom's swing is the one for which the middle of the three horns' axes meets the reflector's centre, 1.7 m
//   from their mouths.
// - The launch struts on the feed structure have stayed where they were.
// The result agrees with the inertia that the paper gives for the spacecraft as flown: x-z is the plane of
// symmetry and the mass lies along the direction from +x, -z to -x, +z.
#pragma once

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

TriangleMesh make_sacd_aquarius();
TriangleMesh make_sacd_aquarius_stowed();

// Instruments, thrusters, wheels and radiators around the bus, the same in both configurations; a part of the
// above.
TriangleMesh make_sacd_aquarius_equipment();

}  // namespace tumblesight::sim
