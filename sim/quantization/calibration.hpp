// Calibration: rendered sequences, and what the layers of a network make of them.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "gnc/lidar/depth_image.hpp"
#include "gnc/rcnn/attitude_estimator.hpp"
#include "sim/world/sensor/flash_lidar.hpp"

namespace tumblesight::sim {

using ImageSequence = std::vector<gnc::DepthImage>;

// Sequence `number` of ten frames, meshes and conditions taking turns, of seeds that neither training nor
// evaluation draws from. It ends before a frame of which the sensor sees too little.
ImageSequence calibration_sequence(const std::vector<const FlashLidar*>& lidars,
                                   const gnc::DepthProjection& projection, std::uint64_t number);

// What one hidden layer gave, channel by channel, over a whole sequence: value of channel c of pixel p of
// frame f at
// [(f * pixels + p) * channels + c]. Borders are left out.
using Observations = std::map<std::string, std::vector<double>>;

// Runs one sequence through the estimator's own steps. Numbers are the layers' own: in fixed point integers.
template <class N>
Observations observe(const gnc::NetworkWeights<N>& weights, const gnc::MotionLaws<typename N::Real>& laws,
                     const ImageSequence& sequence);

// The attitudes that the estimator gives for the sequence, frame by frame.
template <class N>
std::vector<gnc::Matrix3<typename N::Real>> attitudes_of(const gnc::NetworkWeights<N>& weights,
                                                         const gnc::MotionLaws<typename N::Real>& laws,
                                                         const ImageSequence& sequence);

}  // namespace tumblesight::sim
