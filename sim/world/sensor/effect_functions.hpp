// The functions of the effects, each with its model, its assumptions and its limits at its definition.
#pragma once

#include "sim/world/sensor/effects.hpp"
#include "sim/world/target/panels.hpp"

namespace tumblesight::sim {

// Throws std::invalid_argument that says what to do if the mesh has none.
std::vector<Panel> panels_for_effect(const char* effect, const TriangleMesh& mesh);

// body_effects.cpp
std::vector<TriangleMesh> with_moved_joints(const std::function<double()>& strength, Random& random,
                                            const std::string& target, const TriangleMesh& mesh);
std::vector<TriangleMesh> without_parts(const std::function<double()>& strength, Random& random,
                                        const std::string& target, const TriangleMesh& mesh);
std::vector<TriangleMesh> with_turned_panels(const std::function<double()>& strength, Random& random,
                                             const std::string& target, const TriangleMesh& mesh);
std::vector<TriangleMesh> other_targets(const std::function<double()>& strength, Random& random,
                                        const std::string& target, const TriangleMesh& mesh);
std::vector<TriangleMesh> a_sphere(const std::function<double()>& strength, Random& random,
                                   const std::string& target, const TriangleMesh& mesh);

// scene_effects.cpp
void add_background(double strength, const Flash& flash, EffectRandom& random, RangeGrid& grid);
void add_debris(double strength, const Flash& flash, EffectRandom& random, RangeGrid& grid);
void add_plume(double strength, const Flash& flash, EffectRandom& random, RangeGrid& grid);

// surface_effects.cpp
void limit_panel_lobe(double strength, const Flash& flash, EffectRandom& random, RangeGrid& grid);
void limit_lobe(double strength, const Flash& flash, EffectRandom& random, RangeGrid& grid);
void thin_by_cosine(double strength, const Flash& flash, EffectRandom& random, RangeGrid& grid);
void detect_photons(double strength, const Flash& flash, EffectRandom& random, RangeGrid& grid);
void add_retroreflectors(double strength, const Flash& flash, EffectRandom& random, RangeGrid& grid);

// receiver_effects.cpp
void add_range_bias(double strength, const Flash& flash, EffectRandom& random, RangeGrid& grid);
void scale_ranges(double strength, const Flash& flash, EffectRandom& random, RangeGrid& grid);
void add_range_walk(double strength, const Flash& flash, EffectRandom& random, RangeGrid& grid);
void add_fixed_pattern(double strength, const Flash& flash, EffectRandom& random, RangeGrid& grid);
void add_false_returns(double strength, const SensorSettings& settings, EffectRandom& random,
                       std::vector<double>& range_m);
void add_hot_pixels(double strength, const SensorSettings& settings, EffectRandom& random,
                    std::vector<double>& range_m);
void add_dead_pixels(double strength, const SensorSettings& settings, EffectRandom& random,
                     std::vector<double>& range_m);
void add_dead_lines(double strength, const SensorSettings& settings, EffectRandom& random,
                    std::vector<double>& range_m);

}  // namespace tumblesight::sim
