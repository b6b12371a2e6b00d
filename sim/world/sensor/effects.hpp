// Effects: what a real sensor and a real scene add to the sensor of the paper. The table in effects.cpp is
// the only place that lists them: command line, evaluation, recordings and reports follow it. Each can be
// used alone or with others, under every condition.
//
// To add an effect: its strength below, its row in effects.cpp, its function in the file of its subject (what
// is observed: body_effects.cpp; what else is in view: scene_effects.cpp; how a surface returns light:
// surface_effects.cpp; what the receiver makes of it: receiver_effects.cpp), and its test against a closed
// form. An effect draws from a stream of its own: without it, or with another one beside it, all other random
// numbers stay what they are.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "sim/world/math/random.hpp"
#include "sim/world/sensor/range_grid.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

struct FrameTruth;
struct SensorSettings;

// The strengths, in the units of the table; 0: off.
struct Effects {
  double joints = 0.0;
  double part_missing = 0.0;
  double panel_turn = 0.0;
  double wrong_object = 0.0;
  double sphere = 0.0;
  double rays = 0.0;
  double fixed_fov = 0.0;
  double footprint = 0.0;
  double scan_time = 0.0;
  double background = 0.0;
  double debris = 0.0;
  double plume = 0.0;
  double panel_lobe = 0.0;
  double lobe = 0.0;
  double cosine = 0.0;
  double link_budget = 0.0;
  double retroreflectors = 0.0;
  double range_bias = 0.0;
  double range_scale = 0.0;
  double range_walk = 0.0;
  double fixed_pattern = 0.0;
  double noise = 0.0;
  double dropout = 0.0;
  double outliers = 0.0;
  double false_returns = 0.0;
  double hot_pixels = 0.0;
  double dead_pixels = 0.0;
  double dead_lines = 0.0;
};

// The strengths between which those of a frame or sequence are drawn. Where both ends are equal, nothing is
// drawn. Effects stand for themselves: fixed strengths.
struct EffectRanges {
  EffectRanges() = default;
  EffectRanges(const Effects& fixed) : low(fixed), high(fixed) {}
  Effects low{};
  Effects high{};
};

// One flash, as the effects see it.
struct Flash {
  const FrameTruth& truth;
  double swath_m;
  // The target's corners that lie farthest along +-x, +-y and +-z of the TRF.
  const std::array<Eigen::Vector3f, 6>& corners_trf_m;
};

// Random numbers of one effect: those that are new in every frame, and those that stay for a sequence.
struct EffectRandom {
  Random frame;
  Random sequence;
};

// The points at which an effect can act, in their order.
// Changes the body that is observed. `strength`: each call draws one, without a range always the same.
// `target`: its key. More than one body: each sequence shows one of them.
using BodyEffect = std::vector<TriangleMesh> (*)(const std::function<double()>& strength, Random& random,
                                                 const std::string& target, const TriangleMesh& mesh);
// Changes a parameter of the sensor.
using SensorEffect = void (*)(double strength, SensorSettings& settings);
// Changes the light that comes back, before the receiver measures it: exact ranges, infinity without a
// return.
using ReturnEffect = void (*)(double strength, const Flash& flash, EffectRandom& random, RangeGrid& grid);
// Changes what the receiver reports, after noise and losses: metres, kNoReturn_m without a return.
using ReadingEffect = void (*)(double strength, const SensorSettings& settings, EffectRandom& random,
                               std::vector<double>& range_m);

struct EffectRow {
  const char* name;
  double Effects::*strength;
  const char* unit;  // of the strength
  double lowest;     // limits of a strength that is given
  double highest;
  const char* explanation;  // one line
  const char* source;       // of the model
  std::variant<BodyEffect, SensorEffect, ReturnEffect, ReadingEffect> apply;
};

// In the order in which they act.
const std::vector<EffectRow>& effect_table();
// Throws std::invalid_argument that lists the names if there is none of this name.
const EffectRow& effect_named(const std::string& name);
bool must_be_whole(const EffectRow& row);  // its strength
// Whether the effect vanishes as its strength goes to 0, so that a range of strengths may reach 0.
bool vanishes_at_0(const EffectRow& row);

// "false_returns=0.01,noise=5": strengths by name. Throws std::invalid_argument that lists the names, or
// gives the limits of the strength, if one is wrong or is given twice.
Effects effects_from(const std::vector<std::string>& texts);
// The same, where "noise=1:5" is a range from the lower to the higher strength.
EffectRanges effect_ranges_from(const std::vector<std::string>& texts);
// In the same form, in the order of the table; empty without an effect.
std::string to_string(const EffectRanges& effects);
// Whether the frames show the target. Not so with the effects that put another body in its place.
bool show_the_target(const EffectRanges& effects);
// Uniform within the ranges, each from a stream of its own: a range more does not change the others'
// strengths.
Effects drawn(const EffectRanges& ranges, std::uint64_t seed);
// Name, range, unit, explanation and source of each, for the terminal.
std::string effect_explanations();

// So many bodies stand for all that could be drawn: a body takes too long to make for one to be new in every
// frame.
inline constexpr std::uint64_t kDrawnBodies = 16;

// The bodies that are observed in place of `mesh`, which is that of `target` (key): `mesh` alone without an
// effect on it, kDrawnBodies where strengths or angles of joints are drawn. The parts that are panels are
// marked if an effect needs them. Throws std::invalid_argument if the mesh lacks what an effect acts on.
std::vector<TriangleMesh> observed_bodies(const EffectRanges& effects, const std::string& target,
                                          const TriangleMesh& mesh);
// Marks the parts that are panels, if the mesh has any, so that the effect panel_lobe can act on it later.
void mark_panels(TriangleMesh& mesh);
// The settings with the parameters that the effects change.
SensorSettings with_effects(SensorSettings settings, const Effects& effects);
// Whether a return depends on the direction or the kind of the surface, so that the grid has to know them.
bool need_surfaces(const Effects& effects);
void apply_to_returns(const Effects& effects, const Flash& flash, std::uint64_t noise_seed, RangeGrid& grid);
void apply_to_readings(const SensorSettings& settings, const FrameTruth& truth, std::uint64_t noise_seed,
                       std::vector<double>& range_m);

}  // namespace tumblesight::sim
