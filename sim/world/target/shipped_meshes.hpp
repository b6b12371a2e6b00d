// The parametric meshes that ship with Tumblesight, one function per target and configuration.
#pragma once

#include <optional>
#include <string>

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// The mesh that ships for a target; empty if none does.
std::optional<TriangleMesh> shipped_mesh(const std::string& target);

// Magellan.
//
// Configuration: orbit, panels deployed, the casing of the injection motor still attached. TRF: z along the
// high-gain antenna's boresight, the panels on +-x, metres. Bounding box x +-4.45, y +-1.85, z -1.71..2.82.
// The dimensions were measured on the display model of "NASA 3D Resources"; parts smaller than about 2 cm are
// left out. After a rotation by 180 deg about z the dish, the bus and the struts coincide with themselves.
// The two attitudes differ in the altimeter's horn on -x, the medium-gain cone on +y, the star scanner on -y,
// the louvres of the forward box and the panels, which lie in a common plane at 45 deg between y and z.
TriangleMesh make_magellan();

// NEAR Shoemaker.
//
// Configuration: cruise, panels deployed. TRF: z along the antenna's boresight, the four panels on +-x and
// +-y, metres. The origin is the centre of the bounding box (+-2.65, +-2.65, +-1.43). The dimensions were
// measured on the display model of "NASA 3D Resources"; parts smaller than about 5 cm are left out. After a
// rotation by 90 deg about z the surface nearly coincides with itself. Only the equipment on the decks, the
// antenna's tripod and the main thruster distinguish the four attitudes, so these parts are modelled in the
// most detail.
TriangleMesh make_near_shoemaker();

// SAC-D/Aquarius: the flight configuration and the launch configuration (stowed).
//
// TRF: z along the bus from the launch adapter to the reflector's end, the solar panels on +-y, the feed
// horns facing -x, metres. The origin is that of the stowed display model. Bounding box stowed: x and y
// +-1.26, z -1.32..2.95.
//
// The parts and their stowed positions were measured on the stowed display model of "NASA 3D Resources".
// Parts smaller than about 2 cm are left out. There is no display model of the flight configuration. The
// mesh of that configuration is derived from the hinges of the stowed one with these assumptions:
// - Each panel is rotated outwards by 90 deg about the hinge at the lower end of the bus (axis along x,
//   y +-0.68, z -1.08), so that it is perpendicular to z. Its cut-outs then clear the launch adapter. The
//   panels do not track the Sun.
// - The boom is rotated towards -x about the axis of its foot (along y, x -0.72, z 1.21). The reflector is
//   rotated about the axis at the boom's end until its rim is parallel to z, with its concave side towards
//   the horns. The boom's angle is the one at which the axis of the middle horn meets the reflector's centre,
//   1.7 m from the horns' mouths.
// - The launch struts on the feed structure do not move.
// The result agrees with the inertia that the paper gives for the flight configuration: x-z is the plane of
// symmetry, and the mass extends from +x, -z to -x, +z.
TriangleMesh make_sacd_aquarius();
TriangleMesh make_sacd_aquarius_stowed();

// Instruments, thrusters, wheels and radiators around the bus, the same in both configurations. Part of both
// meshes.
TriangleMesh make_sacd_aquarius_equipment();

}  // namespace tumblesight::sim
