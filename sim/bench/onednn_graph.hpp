// OnednnGraph: layers of the network in oneDNN, one after the other, with the formats that oneDNN prefers.
// Made once, then executed per frame.
#pragma once

#include <oneapi/dnnl/dnnl.hpp>
#include <unordered_map>
#include <vector>

#include "sim/model/int8_layers.hpp"
#include "sim/model/network_layers.hpp"

namespace tumblesight::sim {

class OnednnGraph {
 public:
  // All primitives of this thread run on one thread.
  OnednnGraph();

  // Memory in [row][column][channel] (one image) or [value], to be written before run().
  dnnl::memory image(int side, int channels);
  dnnl::memory vector(int values);

  // Each appends a layer and returns its output, in a format of oneDNN's choice. int8 layers take and give
  // uint8, saturated, which is their ReLU; one without activation gives float32.
  dnnl::memory convolution(const Int8Layer& layer, const dnnl::memory& in);  // with its pooling
  dnnl::memory dense(const Int8Layer& layer, const dnnl::memory& before);
  dnnl::memory dense(const Float32Layer& layer, const dnnl::memory& in);
  // The sums of the gates, in the table's order.
  dnnl::memory gates(const Float32Layer& layer, const dnnl::memory& in, const dnnl::memory& hidden);

  // Appends a copy of `in` in the format of image() or vector(): what the caller may read.
  dnnl::memory readable(const dnnl::memory& in);

  void run();

 private:
  using Arguments = std::unordered_map<int, dnnl::memory>;
  void step(const dnnl::primitive& primitive, const Arguments& arguments) {
    steps_.push_back({primitive, arguments});
  }
  dnnl::memory in_format(const dnnl::memory& in, const dnnl::memory::desc& format);
  dnnl::memory weights_in_format(const void* data, const dnnl::memory::desc& ours,
                                 const dnnl::memory::desc& format);
  dnnl::memory pooled(const gnc::LayerRow& row, const dnnl::memory& in);
  dnnl::memory product(const TensorView& weight, const TensorView* bias, bool relu, const dnnl::memory& in,
                       const dnnl::memory* added_to);

  struct Step {
    dnnl::primitive primitive;
    Arguments arguments;
  };
  dnnl::engine engine_{dnnl::engine::kind::cpu, 0};
  dnnl::stream stream_{engine_};
  std::vector<Step> steps_;
  std::vector<dnnl::memory> kept_;  // whose numbers a step reads through another memory
};

}  // namespace tumblesight::sim
