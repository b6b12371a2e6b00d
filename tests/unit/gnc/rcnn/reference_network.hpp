// Reference implementation of the RCNN in double precision, as simple as possible. It uses the network's
// table and its tensors by name, but none of the flight code.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gnc/rcnn/network.hpp"

namespace tumblesight::gnc {

class ReferenceNetwork {
 public:
  using Numbers = std::vector<double>;
  explicit ReferenceNetwork(const NetworkWeights<Float32>& weights);

  struct Frame {
    Numbers features, output;
  };
  Frame infer_frame(const DepthImage& image) const;
  // Returns the output of the recurrent head. Advances h and c by one frame.
  Numbers infer_sequence(const Numbers& lstm_input);

  Numbers h, c;  // the LSTM's state

 private:
  Numbers conv(const std::string& name, const Numbers& in, int side) const;
  Numbers dense(const std::string& name, const Numbers& in) const;
  Numbers layer(const LayerRow& row, const Numbers& in) const;  // without state
  std::map<std::string, Numbers> tensors_;
};

}  // namespace tumblesight::gnc
