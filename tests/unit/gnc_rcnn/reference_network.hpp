// The RCNN once more, in double precision and as plainly as possible, from the tensors by name: what the
// flight network must come out as.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gnc/rcnn/network.hpp"

namespace tumblesight::gnc {

class ReferenceNetwork {
 public:
  using Numbers = std::vector<double>;
  explicit ReferenceNetwork(const NetworkWeights& weights);

  struct Result {
    Numbers dense2, lstm_input, single_frame, rcnn;
  };
  Result infer(const DepthImage& image);  // advances h and c

  Numbers h, c;

 private:
  Numbers conv(const std::string& name, const Numbers& in, int side) const;
  Numbers dense(const std::string& name, const Numbers& in) const;
  std::map<std::string, Numbers> tensors_;
};

}  // namespace tumblesight::gnc
