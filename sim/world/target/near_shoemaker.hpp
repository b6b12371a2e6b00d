// NEAR Shoemaker: the parametric target that ships with Tumblesight.
//
// Cruise configuration, panels deployed. TRF: z along the antenna's boresight, the four panels on +-x and
// +-y, metres; the origin is the centre of the bounding box (+-2.65, +-2.65, +-1.43). The dimensions were
// read off the display model of "NASA 3D Resources"; parts smaller than about 5 cm are left out. Turned by 90
// deg about z the surface nearly falls onto itself: only the equipment on the decks, the antenna's tripod and
// the main thruster tell the four attitudes apart, so those parts are modelled most closely.
#pragma once

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

TriangleMesh make_near_shoemaker();

}  // namespace tumblesight::sim
