// LayerGraph: adds layers of the float32 network to an ONNX graph.
#pragma once

#include <map>
#include <string>

#include "sim/model/network_layers.hpp"
#include "sim/onnx/graph_builder.hpp"

namespace tumblesight::sim {

class LayerGraph {
 public:
  explicit LayerGraph(GraphBuilder& graph) : graph_(graph) {}

  // The layers that read `name`, one of the names in the network's table, get the ONNX value `value`. The
  // LSTM reads its state from "h" and "c", each [1, kLstm].
  void set_input(const std::string& name, const std::string& value) { values_[name] = value; }

  // Declares the graph's input `image` [1, 1, kImageSide, kImageSide] and adds the layers that follow it.
  void add_cnn(const gnc::NetworkWeights<gnc::Float32>& weights);
  void add_recurrent(const gnc::NetworkWeights<gnc::Float32>& weights);

  // The ONNX value of a layer's output; the LSTM's is its next hidden state. Throws std::out_of_range if the
  // layer has not been added.
  const std::string& value(const std::string& name) const { return values_.at(name); }
  const std::string& features() const { return value(gnc::kLayers[gnc::kFeatureLayer].name); }
  const std::string& cnn_output() const { return value(gnc::kLayers[gnc::kCnnOutputLayer].name); }
  const std::string& head_output() const { return value(gnc::kLayers[gnc::kHeadOutputLayer].name); }
  const std::string& next_h() const { return value(gnc::kLayers[gnc::kLstmLayer].name); }
  const std::string& next_c() const { return value("c_next"); }

 private:
  void add(const Float32Layer& layer);
  void add_convolution(const Float32Layer& layer);
  void add_dense(const Float32Layer& layer);
  void add_lstm(const Float32Layer& layer);
  std::string dense_input(const gnc::LayerRow& row);

  GraphBuilder& graph_;
  std::map<std::string, std::string> values_;  // ONNX name by the table's name
};

}  // namespace tumblesight::sim
