#include "sim/training/ranks.hpp"

#include <algorithm>

namespace tumblesight::sim {

Share share_of(std::int64_t rows, int index, int shares) {
  const std::int64_t first = rows * index / shares;
  return {first, rows * (index + 1) / shares - first};
}

void add_up(std::vector<torch::Tensor>& tensors) {
  for (std::size_t distance = 1; distance < tensors.size(); distance *= 2) {
    for (std::size_t i = 0; i + distance < tensors.size(); i += 2 * distance)
      tensors[i].add_(tensors[i + distance]);
  }
}

void Ranks::sum(const std::vector<torch::Tensor>& tensors) {
  if (count_ == 1) return;
  torch::NoGradGuard guard;
  if (tensors.size() == 1 && tensors.front().is_cpu() && tensors.front().is_contiguous()) {
    torch::Tensor in_place = tensors.front().detach().view(-1);
    return sum_flat(in_place);
  }
  std::vector<torch::Tensor> pieces;
  for (const torch::Tensor& tensor : tensors) pieces.push_back(tensor.detach().reshape(-1).cpu());
  torch::Tensor flat = torch::cat(pieces);
  sum_flat(flat);
  std::int64_t at = 0;
  for (const torch::Tensor& tensor : tensors) {
    tensor.detach().copy_(flat.narrow(0, at, tensor.numel()).view(tensor.sizes()));
    at += tensor.numel();
  }
}

void Ranks::copy_from_first(const std::vector<torch::Tensor>& tensors) {
  if (count_ == 1) return;
  torch::NoGradGuard guard;
  for (const torch::Tensor& tensor : tensors) {
    torch::Tensor copy = tensor.detach().cpu().contiguous();
    broadcast(copy);
    if (!leads()) tensor.detach().copy_(copy);
  }
}

std::vector<double> Ranks::gather(double value) {
  if (count_ == 1) return {value};
  const torch::Tensor rows = gather_rows(torch::tensor({value}, torch::kDouble));
  return {rows.data_ptr<double>(), rows.data_ptr<double>() + count_};
}

std::vector<std::int64_t> Ranks::gather(std::int64_t value) {
  if (count_ == 1) return {value};
  const torch::Tensor rows = gather_rows(torch::tensor({value}, torch::kLong));
  return {rows.data_ptr<std::int64_t>(), rows.data_ptr<std::int64_t>() + count_};
}

bool Ranks::any(bool value) {
  const std::vector<double> values = gather(value ? 1.0 : 0.0);
  return std::any_of(values.begin(), values.end(), [](double v) { return v != 0.0; });
}

double Ranks::of_first(double value) {
  if (count_ == 1) return value;
  torch::Tensor tensor = torch::tensor({value}, torch::kDouble);
  broadcast(tensor);
  return tensor.item<double>();
}

std::string Ranks::of_first(const std::string& bytes) {
  if (count_ == 1) return bytes;
  const auto size = static_cast<std::int64_t>(of_first(static_cast<double>(bytes.size())));
  if (size == 0) return {};
  torch::Tensor tensor = torch::empty({size}, torch::kUInt8);
  if (leads()) std::copy(bytes.begin(), bytes.end(), tensor.data_ptr<std::uint8_t>());
  broadcast(tensor);
  return {tensor.data_ptr<std::uint8_t>(), tensor.data_ptr<std::uint8_t>() + size};
}

void Ranks::sum_flat(torch::Tensor&) {}
void Ranks::broadcast(torch::Tensor&) {}
torch::Tensor Ranks::gather_rows(const torch::Tensor& row) {
  return row.unsqueeze(0);
}

}  // namespace tumblesight::sim
