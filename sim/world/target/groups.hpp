// Groups: sets that are joined step by step (union-find).
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace tumblesight::sim {

class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

  // The number of one element of the group that `i` belongs to.
  std::size_t of(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[of(b)] = of(a); }
  // A further element in a group of its own; returns its number.
  std::size_t add() {
    parent_.push_back(parent_.size());
    return parent_.size() - 1;
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace tumblesight::sim
