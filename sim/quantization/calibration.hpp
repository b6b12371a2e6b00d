// Calibration: rendered sequences, and the values of a network's layers for them.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "gnc/estimation/attitude_estimator.hpp"
#include "gnc/lidar/depth_image.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/sensor/flash_lidar.hpp"

namespace tumblesight::sim {

using ImageSequence = std::vector<gnc::DepthImage>;

// Calibration sequence `number`: ten frames; meshes and calibration_conditions() take turns. Neither training
// nor evaluation uses its seed. The sequence ends before a frame in which the sensor sees too little of the
// target. `lidars`: of the bodies that are observed (observed_bodies()). `seen`: its sensor, ranges, period
// and effects.
ImageSequence calibration_sequence(const std::vector<const FlashLidar*>& lidars,
                                   const gnc::DepthProjection& projection, std::uint64_t number,
                                   const ScenarioSettings& seen = {});

// For each layer, by name: its outputs over a whole sequence. Channel c of pixel p of frame f is at [(f *
// pixels + p) * channels + c]. Borders are left out.
using Observations = std::map<std::string, std::vector<double>>;

// Runs one sequence through the steps of the estimator. Values are in the numerics of the network: integers
// in fixed point.
template <class N>
Observations observe(const gnc::NetworkWeights<N>& weights,
                     const gnc::MotionModels<typename N::Real>& motion_models, const ImageSequence& sequence);

// The estimated attitudes (TRF to LRF), one per frame.
template <class N>
std::vector<gnc::Matrix3<typename N::Real>> attitudes_of(
    const gnc::NetworkWeights<N>& weights, const gnc::MotionModels<typename N::Real>& motion_models,
    const ImageSequence& sequence);

}  // namespace tumblesight::sim
