// The RCNN's layers once more, in double precision and as plainly as possible, from the tensors by name: what
// the flight network must come out as.
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
    Numbers dense2, output;
  };
  Frame infer_frame(const DepthImage& image) const;
  Numbers infer_sequence(const Numbers& lstm_input);  // the head's output; advances h and c

  Numbers h, c;

 private:
  Numbers conv(const std::string& name, const Numbers& in, int side) const;
  Numbers dense(const std::string& name, const Numbers& in) const;
  std::map<std::string, Numbers> tensors_;
};

}  // namespace tumblesight::gnc
