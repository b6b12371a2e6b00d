// NEAR Shoemaker: a parametric mesh that ships with Tumblesight.
//
// Configuration: cruise, panels deployed. TRF: z along the antenna's boresight, the four panels on +-x and
// +-y, metres. The origin is the centre of the bounding box (+-2.65, +-2.65, +-1.43). The dimensions were
// measured on the display model of "NASA 3D Resources"; parts smaller than about 5 cm are left out. After a
// rotation by 90 deg about z the surface nearly coincides with itself. Only the equipment on the decks, the
// antenna's tripod and the main thruster distinguish the four attitudes, so these parts are modelled in the
// most detail.
#pragma once

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

TriangleMesh make_near_shoemaker();

}  // namespace tumblesight::sim
