// Ranks: the processes that train one network together. Each computes its share of every batch. What they
// exchange is summed in a fixed order, so that all ranks hold the same bits and a repeated run gives them
// again.
#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace tumblesight::sim {

// Contiguous rows of a batch or of another set.
struct Share {
  std::int64_t first = 0;
  std::int64_t count = 0;
};
// That of `index` among `shares` of rows 0 .. rows-1. The sizes of the shares differ by one at most.
Share share_of(std::int64_t rows, int index, int shares);

// Adds up tensors of one shape into the first one, as a balanced tree: neighbours first. The sum of 2^k
// tensors therefore has the same bits when some of them are added up beforehand, in groups of 2^j neighbours.
void add_up(std::vector<torch::Tensor>& tensors);

// Another rank has ended, or does not answer.
struct RankLost : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A rank that is alone. joined_ranks() (join_ranks.hpp) gives several. All ranks must make the same calls in
// the same order, with tensors of the same shapes. Each call throws RankLost if a rank is lost.
class Ranks {
 public:
  Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  virtual ~Ranks() = default;

  int rank() const { return rank_; }
  int count() const { return count_; }
  bool leads() const { return rank_ == 0; }  // writes log, checkpoints and images, and shows the progress
  int sharing_cores() const { return sharing_cores_; }  // ranks that run on the same cores as this one
  Share share(std::int64_t rows) const { return share_of(rows, rank_, count_); }

  // Replaces each float32 tensor by its sum over the ranks, in the order of add_up().
  void sum(const std::vector<torch::Tensor>& tensors);
  // Replaces each tensor by that of rank 0.
  void copy_from_first(const std::vector<torch::Tensor>& tensors);
  std::vector<double> gather(double value);  // of all ranks, by rank
  std::vector<std::int64_t> gather(std::int64_t value);
  bool any(bool value);           // on any rank
  double of_first(double value);  // that of rank 0
  std::string of_first(const std::string& bytes);

 protected:
  Ranks(int rank, int count, int sharing_cores) : rank_(rank), count_(count), sharing_cores_(sharing_cores) {}

 private:
  // Of a contiguous tensor on the CPU; called with several ranks only.
  virtual void sum_flat(torch::Tensor& flat);
  virtual void broadcast(torch::Tensor& tensor);
  virtual torch::Tensor gather_rows(const torch::Tensor& row);  // [count, ...]

  int rank_ = 0;
  int count_ = 1;
  int sharing_cores_ = 1;
};

}  // namespace tumblesight::sim
