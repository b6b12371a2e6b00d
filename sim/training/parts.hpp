// Parts: how the gradient of a batch comes from ranks and trainers. A batch has as many equal parts as there
// are trainers in all ranks. Each trainer, a thread with a module of its own that shares the weights,
// computes the gradient of its part, and normalizes it by the part's own statistics. The mean over the parts
// is the same, bit for bit, on all ranks, and for every way of dividing 2^k parts among ranks and their
// trainers.
#pragma once

#include <ATen/Parallel.h>
#include <torch/torch.h>

#include <functional>
#include <future>
#include <vector>

#include "sim/training/ranks.hpp"
#include "sim/training/rcnn_module.hpp"

namespace tumblesight::sim {

// The running statistics of a module, which are averaged over the parts as the gradient is.
inline std::vector<torch::Tensor> running_statistics(const Cnn& cnn) {
  std::vector<torch::Tensor> all(cnn->backbone->mean.begin(), cnn->backbone->mean.end());
  all.insert(all.end(), cnn->backbone->variance.begin(), cnn->backbone->variance.end());
  return all;
}
inline std::vector<torch::Tensor> running_statistics(const Recurrent&) {
  return {};
}

template <typename Module>
class Parts {
 public:
  // Computes the gradient of these rows of the rank's share of the batch in the module. Returns their mean
  // loss.
  using Backward = std::function<double(Module&, Share)>;

  // `new_module`: one of the same shape, of any weights. The referenced objects must outlive this one.
  Parts(Module& module, int trainers, Ranks& ranks, const std::function<Module()>& new_module)
      : module_(module), ranks_(ranks), modules_{module} {
    while (static_cast<int>(modules_.size()) < trainers) modules_.push_back(replica_of(module, new_module()));
    if (trainers == 1 && ranks.count() == 1) return;
    for (const Module& part : modules_) flats_.push_back(flat_of(part));
  }

  // Puts the mean gradient of the whole batch into the module. `rows`: of this rank. Returns the batch's mean
  // loss.
  double mean_gradient(std::int64_t rows, const Backward& backward) {
    if (flats_.empty()) return backward(module_, {0, rows});
    const std::vector<double> losses = run_all(rows, backward);
    torch::NoGradGuard guard;
    for (std::size_t i = 0; i < modules_.size(); ++i) append(modules_[i], losses[i], flats_[i]);
    std::vector<torch::Tensor> sums = flats_;
    add_up(sums);
    ranks_.sum({sums.front()});
    sums.front().div_(static_cast<double>(modules_.size()) * ranks_.count());
    return take_appended(sums.front());
  }

 private:
  static Module replica_of(const Module& module, Module replica) {
    replica->to(module->parameters().front().device());
    replica->train();
    std::vector<torch::Tensor> parameters = replica->parameters(), buffers = replica->buffers();
    for (std::size_t i = 0; i < parameters.size(); ++i)
      parameters[i].set_data(module->parameters()[i].data());
    for (std::size_t i = 0; i < buffers.size(); ++i) buffers[i].copy_(module->buffers()[i]);
    return replica;
  }

  std::vector<double> run_all(std::int64_t rows, const Backward& backward) {
    const int trainers = static_cast<int>(modules_.size());
    std::vector<std::future<double>> others;
    for (int i = 1; i < trainers; ++i) {
      others.push_back(std::async(std::launch::async, [&, i] {
        at::set_num_threads(1);  // of this thread
        return backward(modules_[static_cast<std::size_t>(i)], share_of(rows, i, trainers));
      }));
    }
    std::vector<double> losses{backward(module_, share_of(rows, 0, trainers))};
    for (std::future<double>& other : others) losses.push_back(other.get());
    return losses;
  }

  // Room for gradient, running statistics and loss of a part. From now on the module's gradients lie in it,
  // so that nothing is copied before they are added up and sent.
  static torch::Tensor flat_of(const Module& module) {
    std::int64_t size = 1;
    for (const torch::Tensor& parameter : module->parameters()) size += parameter.numel();
    for (const torch::Tensor& statistic : running_statistics(module)) size += statistic.numel();
    const torch::Tensor flat = torch::zeros({size}, module->parameters().front().detach().options());
    std::int64_t at = 0;
    for (torch::Tensor& parameter : module->parameters()) {
      parameter.mutable_grad() = flat.narrow(0, at, parameter.numel()).view(parameter.sizes());
      at += parameter.numel();
    }
    return flat;
  }

  // Statistics and loss of a part, at the end of `flat`.
  static void append(const Module& module, double loss, torch::Tensor& flat) {
    std::vector<torch::Tensor> pieces;
    for (const torch::Tensor& statistic : running_statistics(module)) pieces.push_back(statistic.reshape(-1));
    pieces.push_back(torch::full({1}, loss, flat.options()));
    const torch::Tensor appended = torch::cat(pieces);
    flat.narrow(0, flat.numel() - appended.numel(), appended.numel()).copy_(appended);
  }

  // Puts the mean statistics into the modules. Returns the loss.
  double take_appended(const torch::Tensor& flat) {
    std::int64_t at = flat.numel() - 1;
    const double loss = flat[at].template item<double>();
    const std::size_t count = running_statistics(module_).size();
    for (std::size_t k = count; k-- > 0;) {
      const torch::Tensor shape = running_statistics(module_)[k];
      at -= shape.numel();
      for (Module& module : modules_)
        running_statistics(module)[k].copy_(flat.narrow(0, at, shape.numel()).view(shape.sizes()));
    }
    return loss;
  }

  Module& module_;
  Ranks& ranks_;
  std::vector<Module> modules_;       // the module itself first; one per trainer
  std::vector<torch::Tensor> flats_;  // of each module; none if there is one part only
};

}  // namespace tumblesight::sim
