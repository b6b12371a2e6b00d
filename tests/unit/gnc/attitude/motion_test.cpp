#include "gnc/attitude/motion.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>

#include "gnc/attitude/rotation.hpp"
#include "gnc/numerics/conversion.hpp"
#include "tests/support/angles.hpp"
#include "tests/support/trials.hpp"

namespace tumblesight::gnc {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Eigen::Matrix3f tensor(float xx, float yy, float zz, float xy = 0.0F, float xz = 0.0F, float yz = 0.0F) {
  Eigen::Matrix3f j;
  j << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return j;
}

Eigen::Vector3d random_axis(std::mt19937& engine) {
  std::normal_distribution<double> normal;
  return Eigen::Vector3d(normal(engine), normal(engine), normal(engine)).normalized();
}

Eigen::Matrix3d exact_rotation(const Eigen::Vector3d& turn) {
  return Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
}

double angle_between(const Eigen::Matrix3f& a, const Eigen::Matrix3d& b) {
  return 2.0 * std::asin(std::min(1.0, (a.cast<double>() - b).norm() / std::sqrt(8.0)));
}

// Torque-free motion from the angular momentum, in steps short enough to be regarded as exact.
struct Exact {
  Eigen::Matrix3d r_lrf_trf;
  Eigen::Vector3d rate_lrf;
};
Exact exact_tumble(const Eigen::Matrix3d& start, const Eigen::Vector3d& rate,
                   const Eigen::Matrix3d& inertia) {
  constexpr int kSteps = 2000;
  const Eigen::Vector3d momentum = start * inertia * start.transpose() * rate;
  const Eigen::Matrix3d inverse = inertia.inverse();
  const auto rate_at = [&](const Eigen::Matrix3d& r) -> Eigen::Vector3d {
    return r * (inverse * (r.transpose() * momentum));
  };
  Eigen::Matrix3d r = start;
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::Matrix3d middle = exact_rotation(rate_at(r) * (0.5 / kSteps)) * r;
    r = exact_rotation(rate_at(middle) / kSteps) * r;
  }
  return {r, rate_at(r)};
}

TEST(RotationFromVector, IsTheExponentialAndLimitsTheAngle) {
  std::mt19937 engine(1);
  EXPECT_EQ(rotation_from_vector<float>(Eigen::Vector3f::Zero()),
            Eigen::Matrix3f(Eigen::Matrix3f::Identity()));
  for (const float angle : {1e-6F, 0.01F, 0.5F, 1.0F, 1.5F, 1.89F, 2.5F, 1e3F, 1e30F}) {
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector3d axis = random_axis(engine);
      const Eigen::Matrix3d exact = exact_rotation(std::min(angle, kLargestRate) * axis);
      const Eigen::Matrix3f r = rotation_from_vector<float>((angle * axis).cast<float>());
      // If the squared length overflows, the vector becomes zero.
      if (angle > 1e20F) {
        EXPECT_EQ(r, Eigen::Matrix3f(Eigen::Matrix3f::Identity()));
        continue;
      }
      EXPECT_LT((r.cast<double>() - exact).cwiseAbs().maxCoeff(), 1e-6) << angle;
    }
  }
}

TEST(SmallRotationVector, InvertsRotationFromVectorBelowSixtyDegreesAndIsZeroAbove) {
  std::mt19937 engine(2);
  for (const double angle_deg : {0.0, 1e-4, 1.0, 20.0, 45.0, 59.9, 60.1, 90.0, 179.9}) {
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector3d turn = angle_deg * kDegree * random_axis(engine);
      const Eigen::Vector3d found =
          small_rotation_vector<float>(exact_rotation(turn).cast<float>()).cast<double>();
      EXPECT_LT((found - (angle_deg < 60.0 ? turn : Eigen::Vector3d::Zero())).norm(), 1e-5) << angle_deg;
    }
  }
}

TEST(Propagate, SphereSpinsAtAConstantRateInTheLidarFrame) {
  const Eigen::Matrix3d start = exact_rotation({0.5, -1.0, 1.5});
  const Eigen::Vector3d rate(0.3, 0.6, -0.4);
  const Motion<float> later = propagate<float>({start.cast<float>(), rate.cast<float>()}, Inertia<float>{});
  EXPECT_LT(angle_between(later.r_lrf_trf, exact_rotation(rate) * start), 1e-6);
  EXPECT_LT((later.rate_lrf - rate.cast<float>()).norm(), 1e-6F);
}

// Verifies TS-EST-140.
TEST(Propagate, FollowsTorqueFreeRotation) {
  std::mt19937 engine(3);
  const Eigen::Matrix3f shapes[] = {tensor(3.0F, 5.0F, 6.0F, 0.4F, -0.2F, 0.1F), tensor(1.0F, 4.0F, 4.5F),
                                    tensor(5.0F, 5.0F, 8.0F)};
  for (const Eigen::Matrix3f& shape : shapes) {
    Inertia<float> inertia;
    ASSERT_TRUE(make_inertia<float>(shape, inertia));
    for (const double rate_deg : {5.0, 27.0, 54.0}) {
      for (int i = 0; i < trials(40); ++i) {
        const Eigen::Matrix3d start = exact_rotation(2.0 * random_axis(engine));
        const Eigen::Vector3d rate = rate_deg * kDegree * random_axis(engine);
        const Exact exact = exact_tumble(start, rate, shape.cast<double>());
        const Motion<float> later = propagate<float>({start.cast<float>(), rate.cast<float>()}, inertia);
        const double error_deg = angle_between(later.r_lrf_trf, exact.r_lrf_trf) / kDegree;
        EXPECT_LT((later.rate_lrf.cast<double>() - exact.rate_lrf).norm(), 0.03 * rate.norm()) << rate_deg;
        EXPECT_LT(error_deg, rate_deg > 30.0 ? 0.5 : 0.1) << rate_deg;
      }
    }
  }
}

TEST(Propagate, OnePeriodIsTheDefault) {
  Motion<Fixed> motion;
  motion.rate_lrf = {Fixed(0.3), Fixed(-0.5), Fixed(0.4)};
  const Motion<Fixed> a = propagate<Fixed>(motion, Inertia<Fixed>{});
  const Motion<Fixed> b = propagate<Fixed>(motion, Inertia<Fixed>{}, kNominalPeriod_ns);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(a.r_lrf_trf(i).raw(), b.r_lrf_trf(i).raw());
  for (int i = 0; i < 3; ++i) EXPECT_EQ(a.rate_lrf[i].raw(), b.rate_lrf[i].raw());
  EXPECT_EQ(in_periods(kNominalPeriod_ns).raw(), Fixed(1.0).raw());
}

TEST(Propagate, SpinTurnsInProportionToTheTime) {
  std::mt19937 engine(12);
  for (const double periods : {0.0, 0.037, 0.37, 1.0, 1.7, 2.0, 5.5, 8.0, 16.0, 40.0}) {
    const Eigen::Vector3d rate = 0.9 * random_axis(engine);
    Motion<Fixed> motion;
    for (int i = 0; i < 3; ++i) motion.rate_lrf[i] = Fixed(rate[i]);
    const auto elapsed_ns = static_cast<std::int64_t>(periods * kNominalPeriod_ns);
    const Motion<Fixed> later = propagate<Fixed>(motion, Inertia<Fixed>{}, elapsed_ns);
    const double counted = std::min(periods, 16.0);
    EXPECT_NEAR(std::ldexp(in_periods(elapsed_ns).raw(), -24), counted, 2e-6);
    const Eigen::Matrix3f r = converted<float>(later.r_lrf_trf);
    EXPECT_LT(angle_between(r, exact_rotation(rate * std::max(counted, 1e-9))), 2e-5 * (1.0 + counted))
        << periods;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::ldexp(later.rate_lrf[i].raw(), -24), rate[i], 1e-5);
  }
}

TEST(Propagate, TimeCanBeSplit) {
  std::mt19937 engine(13);
  Inertia<float> inertia;
  ASSERT_TRUE(make_inertia<float>(tensor(1.0F, 1.7F, 2.1F, 0.1F), inertia));
  for (const double first : {0.3, 1.0, 2.6}) {
    for (const double second : {0.2, 1.0, 3.3}) {
      Motion<float> motion;
      motion.rate_lrf = (0.6 * random_axis(engine)).cast<float>();
      const auto ns = [](double periods) { return static_cast<std::int64_t>(periods * kNominalPeriod_ns); };
      const Motion<float> whole = propagate<float>(motion, inertia, ns(first) + ns(second));
      const Motion<float> parts =
          propagate<float>(propagate<float>(motion, inertia, ns(first)), inertia, ns(second));
      EXPECT_LT(angle_between(whole.r_lrf_trf, parts.r_lrf_trf.cast<double>()), 0.02) << first << second;
      EXPECT_LT((whole.rate_lrf - parts.rate_lrf).norm(), 0.01);
    }
  }
}

TEST(Turned, TurnsAttitudeAndRate) {
  std::mt19937 engine(14);
  const Eigen::Matrix3d turn = exact_rotation(0.8 * random_axis(engine));
  Motion<float> motion;
  motion.r_lrf_trf = exact_rotation(2.0 * random_axis(engine)).cast<float>();
  motion.rate_lrf = {0.1F, 0.2F, -0.3F};
  const Motion<float> after = turned<float>(motion, turn.cast<float>());
  EXPECT_LT(angle_between(after.r_lrf_trf, turn * motion.r_lrf_trf.cast<double>()), 1e-5);
  EXPECT_LT((after.rate_lrf.cast<double>() - turn * motion.rate_lrf.cast<double>()).norm(), 1e-6);
}

TEST(RotationVector, InvertsRotationsUpToItsLimit) {
  std::mt19937 engine(15);
  for (double degrees = 5.0; degrees < 150.0; degrees += 9.0) {
    const Eigen::Vector3d turn = degrees * kDegree * random_axis(engine);
    const Eigen::Matrix3f r = exact_rotation(turn).cast<float>();
    const Vector3<float> all = rotation_vector<float>(r, static_cast<float>(kVersineOf150Degrees));
    EXPECT_LT((all.cast<double>() - turn).norm(), 1e-3) << degrees;
    const Vector3<float> small = rotation_vector<float>(r, static_cast<float>(kVersineOf60Degrees));
    EXPECT_EQ(small, small_rotation_vector<float>(r)) << degrees;
    const Matrix3<Fixed> fixed = converted<Fixed>(Matrix3<float>(r));
    const Vector3<Fixed> same = rotation_vector<Fixed>(fixed, Fixed(kVersineOf150Degrees));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::ldexp(same[i].raw(), -24), turn[i], 1e-3) << degrees;
  }
  const Eigen::Matrix3f beyond = exact_rotation(155.0 * kDegree * random_axis(engine)).cast<float>();
  EXPECT_EQ(rotation_vector<float>(beyond, static_cast<float>(kVersineOf150Degrees)).norm(), 0.0F);
}

TEST(Propagate, RotationAboutAPrincipalAxisIsASpin) {
  const Eigen::Matrix3d start = exact_rotation({0.5, -1.0, 1.5});
  Inertia<float> inertia;
  ASSERT_TRUE(make_inertia<float>(tensor(2.0F, 3.0F, 4.0F), inertia));
  const Eigen::Vector3d rate = 0.8 * start.col(1);
  const Motion<float> later = propagate<float>({start.cast<float>(), rate.cast<float>()}, inertia);
  EXPECT_LT(angle_between(later.r_lrf_trf, exact_rotation(rate) * start), 2e-6);
  EXPECT_LT((later.rate_lrf - rate.cast<float>()).norm(), 2e-6F);
}

TEST(Propagate, DependsOnRatiosOfTheInertiaOnly) {
  const Eigen::Matrix3f shape = tensor(3.0F, 5.0F, 6.0F, 0.4F, -0.2F, 0.1F);
  const Motion<float> motion{exact_rotation({0.5, -1.0, 1.5}).cast<float>(), {0.3F, -0.2F, 0.7F}};
  Inertia<float> inertia, scaled;
  ASSERT_TRUE(make_inertia<float>(shape, inertia));
  for (const float scale : {1e-3F, 1e6F}) {
    ASSERT_TRUE(make_inertia<float>(scale * shape, scaled));
    EXPECT_LT(
        (propagate<float>(motion, scaled).r_lrf_trf - propagate<float>(motion, inertia).r_lrf_trf).norm(),
        1e-5F);
  }
}

// Verifies TS-EST-140.
TEST(MotionModels, AreASpinTheInertiaAndEachOfItsMomentsHalved) {
  const Eigen::Matrix3f shape = tensor(3.0F, 5.0F, 6.0F, 0.4F, -0.2F, 0.1F);
  Inertia<float> inertia;
  ASSERT_TRUE(make_inertia<float>(shape, inertia));
  const MotionModels<float> motion_models = gnc::motion_models<float>(inertia);
  EXPECT_EQ(motion_models[kSpinModel].tensor_trf, Eigen::Matrix3f(Eigen::Matrix3f::Identity()));
  const Eigen::Matrix3f own = shape * (3.0F / shape.trace());
  EXPECT_LT((motion_models[kTumbleModel].tensor_trf - own).norm(), 1e-6F);
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Matrix3f scale_half = Eigen::Matrix3f::Identity();
    scale_half(axis, axis) = std::sqrt(0.5F);
    const Inertia<float>& halved = motion_models[2 + axis];
    const Eigen::Matrix3f expected = scale_half * shape * scale_half;
    EXPECT_LT((halved.tensor_trf - expected * (3.0F / expected.trace())).norm(), 1e-6F) << axis;
    EXPECT_LT((halved.inverse_trf * halved.tensor_trf - Eigen::Matrix3f::Identity()).norm(), 1e-5F) << axis;
  }
}

TEST(MotionModels, KeepAnInertiaThatCannotBeHalved) {
  Inertia<float> thinnest;
  for (float thin = 1.0F; make_inertia<float>(tensor(1.0F, 1.0F, thin), thinnest); thin *= 0.5F) {
  }
  const Inertia<float> halved = motion_models<float>(thinnest)[4];
  EXPECT_EQ(halved.tensor_trf, thinnest.tensor_trf);
  EXPECT_EQ(halved.inverse_trf, thinnest.inverse_trf);
}

// Verifies TS-IFC-040.
TEST(MakeInertia, AcceptsPositiveDefiniteTensorsOnly) {
  Inertia<float> inertia;
  const Eigen::Matrix3f good = tensor(3.0F, 5.0F, 6.0F, 0.4F, -0.2F, 0.1F);
  ASSERT_TRUE(make_inertia<float>(good, inertia));
  const Eigen::Matrix3f accepted = inertia.tensor_trf;
  EXPECT_LT((accepted - good * (3.0F / good.trace())).norm(), 1e-6F);
  EXPECT_LT((inertia.inverse_trf * accepted - Eigen::Matrix3f::Identity()).cwiseAbs().maxCoeff(), 2e-6F);

  Eigen::Matrix3f asymmetric = good;
  asymmetric(0, 1) += 0.1F;
  for (const Eigen::Matrix3f& bad :
       {Eigen::Matrix3f(Eigen::Matrix3f::Zero()), tensor(-1.0F, 2.0F, 2.0F), tensor(-1.0F, -2.0F, 9.0F),
        tensor(1.0F, 2.0F, -0.1F), tensor(1.0F, 1.0F, 1.0F, 2.0F), tensor(1.0F, 1.0F, 1e-5F),
        tensor(kNan, 1.0F, 1.0F), tensor(1.0F, 1.0F, 1.0F, 0.0F, kNan), tensor(kInfinity, 1.0F, 1.0F),
        tensor(1.0F, 1.0F, 1.0F, 0.0F, 0.0F, kInfinity), tensor(1.0F, 1.0F, 0.005F), asymmetric}) {
    EXPECT_FALSE(make_inertia<float>(bad, inertia)) << bad;
  }
  EXPECT_EQ(inertia.tensor_trf, accepted);
}

TEST(Product, AgreesWithEigenForMatricesAndVectors) {
  const Eigen::Matrix3f a = tensor(0.3F, -0.5F, 0.7F, 0.2F, 0.9F, -0.8F) + Eigen::Matrix3f::Identity();
  Eigen::Matrix3f b;
  b << 1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F, 7.0F, 8.0F, 10.0F;
  const Eigen::Vector3f v(1.0F, -2.0F, 0.5F);
  EXPECT_TRUE(product<float>(b, a).isApprox(b * a, 1e-6F));
  EXPECT_TRUE(transpose_product<float>(b, a).isApprox(b.transpose() * a, 1e-6F));
  EXPECT_TRUE(product<float>(b, v).isApprox(b * v, 1e-6F));
  EXPECT_TRUE(transpose_product<float>(b, v).isApprox(b.transpose() * v, 1e-6F));
  EXPECT_NEAR(trace_of_transpose_product<float>(b, a), (b.transpose() * a).trace(), 1e-5F);
}

}  // namespace
}  // namespace tumblesight::gnc
