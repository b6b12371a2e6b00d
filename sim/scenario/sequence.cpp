#include "sim/scenario/sequence.hpp"

#include <stdexcept>

#include "sim/dynamics/spin.hpp"
#include "sim/scenario/random.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kMinRange_m = 20.0;
constexpr double kMaxRange_m = 100.0;
constexpr double kMaxRate_rad_s = 20.0 * 0.017453292519943295;

Eigen::Quaterniond uniform_attitude(Random& random) {
  // One a statement: the order in which a compiler evaluates arguments is its own.
  const double z = random.normal();
  const double y = random.normal();
  const double x = random.normal();
  const double w = random.normal();
  return Eigen::Quaterniond(w, x, y, z).normalized();
}

// Components uniform; drawn again until the norm is within the limit.
Eigen::Vector3d uniform_rate(Random& random) {
  Eigen::Vector3d rate;
  do {
    for (int i = 0; i < 3; ++i) rate[i] = random.uniform(-kMaxRate_rad_s, kMaxRate_rad_s);
  } while (rate.norm() > kMaxRate_rad_s);
  return rate;
}

}  // namespace

std::string to_string(Condition condition) {
  return condition == Condition::kDegraded ? "degraded" : "nominal";
}

Condition condition_from(const std::string& name) {
  if (name == "nominal") return Condition::kNominal;
  if (name == "degraded") return Condition::kDegraded;
  throw std::invalid_argument("condition '" + name + "' is unknown; there are: nominal, degraded");
}

Sequence make_sequence(Condition condition, std::uint64_t seed, std::uint64_t index, int frames) {
  Random random(mix(seed, index));
  const Eigen::Quaterniond q0 = uniform_attitude(random);
  const Eigen::Vector3d rate = uniform_rate(random);
  const double range_m = random.uniform(kMinRange_m, kMaxRange_m);

  Sequence sequence;
  sequence.condition = condition;
  sequence.noise_seed = random.next();
  sequence.frames.reserve(static_cast<std::size_t>(frames));
  for (int k = 0; k < frames; ++k) {
    sequence.frames.push_back({spin(q0, rate, kFramePeriod_s * k), rate, range_m});
  }
  return sequence;
}

}  // namespace tumblesight::sim
