// How long the parts of a step take, on one thread, with every numerics and instruction set, and beside them
// the same network in other runtimes.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "sim/bench/peer.hpp"

namespace tumblesight::sim {

struct BenchRow {
  std::string name;  // step, depth image, network, convolutions; or a peer's
  std::string numerics;
  std::string isa;
  double median_us = 0.0;
  double min_us = 0.0;
  double macs = 0.0;  // 0: none are counted
  std::optional<double>
      share_of_peak;  // of the fastest run: multiply-accumulates a second over the core's peak
};

struct BenchSubject {
  std::vector<std::uint8_t> image;  // a model image of either numerics
  std::vector<gnc::RangeImage> frames;
  double row_s = 0.6;  // how long each row is measured
};

// `started` is told the name of every numerics and set before it is measured.
std::vector<BenchRow> bench_numerics(const BenchSubject& subject,
                                     const std::function<void(const std::string&)>& started);

// The network of `peer`: CNN and recurrent part, the state kept from frame to frame, the depth image left
// out. Throws std::runtime_error if its outputs are not ours (float32), before anything is timed.
BenchRow bench_peer(Peer& peer, const Float32Model& model, const std::vector<gnc::RangeImage>& frames);

}  // namespace tumblesight::sim
