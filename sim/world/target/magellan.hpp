// Magellan: a parametric mesh that ships with Tumblesight.
//
// Configuration: orbit, panels deployed, the casing of the injection motor still attached. TRF: z along the
// high-gain antenna's boresight, the panels on +-x, metres. Bounding box x +-4.45, y +-1.85, z -1.71..2.82.
// The dimensions were measured on the display model of "NASA 3D Resources"; parts smaller than about 2 cm are
// left out. After a rotation by 180 deg about z the dish, the bus and the struts coincide with themselves.
// The two attitudes differ in the altimeter's horn on -x, the medium-gain cone on +y, the star scanner on -y,
// the louvres of the forward box and the panels, which lie in a common plane at 45 deg between y and z.
#pragma once

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

TriangleMesh make_magellan();

}  // namespace tumblesight::sim
