// Magellan: the parametric target that ships with Tumblesight.
//
// Orbit configuration, panels deployed, the casing of the injection motor's stage still attached. TRF: z
// along the high-gain antenna's boresight, the panels on +-x, metres; box x +-4.45, y +-1.85, z -1.71..2.82.
// The dimensions were read off the display model of "NASA 3D Resources"; parts smaller than about 2 cm are
// left out. Turned by 180 deg about z the dish, the bus and the struts fall onto themselves. What tells the
// two attitudes apart: the altimeter's horn on -x, the medium-gain cone on +y, the star scanner on -y, the
// louvres of the forward box and the panels, which stand in one common plane at 45 deg between y and z.
#pragma once

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

TriangleMesh make_magellan();

}  // namespace tumblesight::sim
