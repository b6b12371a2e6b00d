#include "sim/onnx/track_graph.hpp"

#include <vector>

#include "gnc/rcnn/track_constants.hpp"

namespace tumblesight::sim {

namespace shape = gnc::shape;
namespace {

constexpr double kSecond_ns = 1e9;
constexpr double kPeriod_s = gnc::kNominalPeriod_ns / kSecond_ns;
constexpr double kShortest_s = gnc::kShortestInterval_ns / kSecond_ns;
constexpr double kLongest_s = gnc::kLongestInterval_ns / kSecond_ns;
constexpr double kLongestToFindRate_s = gnc::kLongestToFindRate_ns / kSecond_ns;
constexpr double kLostInnovation = static_cast<float>(gnc::kLostTargetInnovation);
constexpr double kFarBelowAllScores = -1e9;

OnnxTensor is_true(const OnnxTensor& number) {
  return number > 0.5;
}

OnnxTensor same_attitude(const OnnxTensor& trace) {
  return trace > gnc::kTraceOfSameAttitude<double>;
}

// The value by which the motion models are compared: log-likelihood minus required evidence.
OnnxTensor scores(const OnnxTensor& log_likelihood) {
  const std::vector<float> required(gnc::kRequiredEvidence.begin(), gnc::kRequiredEvidence.end());
  return log_likelihood - constant_tensor(log_likelihood.graph(), {gnc::kMotionModels, 1, 1}, required);
}

// Of the motion model that gives the result.
OnnxTensor motion_model_of(const OnnxTensor& log_likelihood) {
  return index_of_largest(scores(log_likelihood), 0);
}

MotionGraph picked(const MotionGraph& motion, const OnnxTensor& motion_model) {
  return {picked(motion.r_lrf_trf, motion_model, 0), picked(motion.rate_lrf, motion_model, 0)};
}

MotionGraph of_all_motion_models(const MotionGraph& motion) {
  return {expanded(motion.r_lrf_trf, {gnc::kMotionModels, 3, 3}),
          expanded(motion.rate_lrf, {gnc::kMotionModels, 3, 1})};
}

MotionGraph at_rest(const OnnxTensor& r_lrf_trf) {
  return {r_lrf_trf, constant_tensor<float>(r_lrf_trf.graph(), {1, 3, 1}, {0, 0, 0})};
}

// Sum over the hypotheses that are the attitude of each motion model: [K, 1, 1].
OnnxTensor probability_of(const HypothesesGraph& hypotheses, const OnnxTensor& r_lrf_trf) {
  const OnnxTensor elements = reshaped(hypotheses.r_lrf_trf, {1, shape::kHypotheses, 9});
  const OnnxTensor traces = product(elements, reshaped(r_lrf_trf, {-1, 9, 1}));  // [K, 8, 1]
  const OnnxTensor probabilities = reshaped(hypotheses.probabilities, {1, 1, shape::kHypotheses});
  return product(probabilities, as_number(same_attitude(traces)));
}

// AttitudeTrack::forget_rate()
TrackGraph without_rate(const TrackGraph& track, const OnnxTensor& forgets) {
  const OnnxTensor last = picked(track.motion, motion_model_of(track.log_likelihood)).r_lrf_trf;
  return {where(forgets, of_all_motion_models(at_rest(last)), track.motion),
          where(forgets, 0.0, track.log_likelihood), where(forgets, minimum(track.frames, 1.0), track.frames),
          track.has_found_rate};
}

// What an innovation means for the rate.
struct RateCorrectionGraph {
  OnnxTensor gain, periods, largest_versine;  // [1, 1, 1]
};

OnnxTensor corrected_rate(const MotionGraph& predicted_motion, const OnnxTensor& r_lrf_trf,
                          const RateCorrectionGraph& correction) {
  const OnnxTensor innovation =
      rotation_vector(product(r_lrf_trf, transposed(predicted_motion.r_lrf_trf)), correction.largest_versine);
  return predicted_motion.rate_lrf + correction.gain * innovation / correction.periods;
}

// As in attitude_track.cpp: 60 degrees after one period; while the rate is being found, from 10 degrees after
// none to 150 degrees after 2.5 periods.
OnnxTensor largest_versine(const OnnxTensor& periods, const OnnxTensor& finds_rate) {
  constexpr double kNominal = gnc::kVersineOf60Degrees, kMost = gnc::kVersineOf150Degrees;
  const OnnxTensor more = maximum(periods, 1.0) - 1.0;
  const OnnxTensor grown = minimum(kNominal + (kMost - kNominal) / 1.5 * more, kMost);
  const OnnxTensor angle = 0.17453293 + 0.87266463 * periods;
  const OnnxTensor half_square = 0.5 * angle * angle;
  const OnnxTensor reduced = half_square - 1.0 / 6.0 * half_square * half_square;
  return where(periods < 1.0, reduced, where(finds_rate, grown, kNominal));
}

// The row of the table for a frame after `frames` others: [1, 1, 1] each.
gnc::FilterGains<OnnxTensor> filter_gains(const OnnxTensor& frames) {
  const OnnxTensor row = as_integer(minimum(frames, gnc::kGains - 1));
  const auto column = [&](float gnc::FilterGains<float>::*member) {
    std::vector<float> values;
    for (const gnc::FilterGains<float>& gains : gnc::kFilterGains<float>) values.push_back(gains.*member);
    return picked(constant_tensor(frames.graph(), {gnc::kGains, 1, 1}, values), row, 0);
  };
  return {column(&gnc::FilterGains<float>::predicted_weight), column(&gnc::FilterGains<float>::rate_logit),
          column(&gnc::FilterGains<float>::evidence)};
}

// Weights of the candidates: [1, 9, 1].
OnnxTensor candidate_weights(const HypothesesGraph& hypotheses, const OnnxTensor& corrections,
                             const OnnxTensor& predicted_weight) {
  const OnnxTensor bounded = clamped(corrections, -gnc::kMaxCorrection, gnc::kMaxCorrection);
  const OnnxTensor prior = joined(
      {maximum(hypotheses.probabilities, gnc::kMinProbability), reshaped(predicted_weight, {1, 1})}, 1);
  return reshaped(operation("Exp", {bounded - largest(bounded, 1)}) * prior, {1, shape::kCandidates, 1});
}

// For each motion model the weighted mean of the candidates that are the same attitude as the candidate
// `anchor`, with its own prediction as the last candidate: [5, 3, 3].
OnnxTensor mean_attitudes(const HypothesesGraph& hypotheses, const OnnxTensor& predicted_r_lrf_trf,
                          const OnnxTensor& weights, const OnnxTensor& anchor) {
  const OnnxTensor of_frame = expanded(reshaped(hypotheses.r_lrf_trf, {1, shape::kHypotheses, 9}),
                                       {gnc::kMotionModels, shape::kHypotheses, 9});
  const OnnxTensor candidates =
      joined({of_frame, reshaped(predicted_r_lrf_trf, {gnc::kMotionModels, 1, 9})}, 1);
  const OnnxTensor traces = product(candidates, reshaped(picked(candidates, anchor, 1), {-1, 9, 1}));
  const OnnxTensor shares = where(same_attitude(traces), weights, 0.0);  // [5, 9, 1]
  const OnnxTensor mean =
      reshaped(sum(shares / largest(shares, 1) * candidates, {1}), {gnc::kMotionModels, 3, 3});
  return rotation_from_columns(slice(mean, 2, 0, 1), slice(mean, 2, 1, 2));
}

// [5, 1, 1]; kLostInnovation if the hypotheses show nothing near the prediction.
OnnxTensor squared_innovations(const HypothesesGraph& hypotheses, const OnnxTensor& predicted_r_lrf_trf,
                               const OnnxTensor& r_lrf_trf) {
  const OnnxTensor innovation = 3.0 - trace_of_transpose_product(predicted_r_lrf_trf, r_lrf_trf);
  const OnnxTensor unseen =
      probability_of(hypotheses, predicted_r_lrf_trf) < gnc::kMinProbabilityNearPrediction;
  return where(unseen, kLostInnovation, minimum(innovation, kLostInnovation));
}

// Lowers the log-likelihoods by the evidence; a motion model that has lost the target takes over the motion
// of the best motion model that has not.
TrackGraph weighed(const MotionGraph& motion, const OnnxTensor& log_likelihood_before,
                   const OnnxTensor& innovations, const OnnxTensor& evidence, const TrackGraph& before) {
  const OnnxTensor against = minimum(evidence * innovations, gnc::kMaxEvidence);
  const OnnxTensor lowered = gnc::kLikelihoodDecay * log_likelihood_before - against;
  const OnnxTensor log_likelihood = maximum(lowered - largest(lowered, 0), gnc::kMinLogLikelihood);
  const OnnxTensor follows = innovations < kLostInnovation;
  const OnnxTensor best = index_of_largest(where(follows, scores(log_likelihood), kFarBelowAllScores), 0);
  const OnnxTensor any_follows = largest(as_number(follows), 0) > 0.5;
  return {where(any_follows & !follows, of_all_motion_models(picked(motion, best)), motion), log_likelihood,
          1.0 + before.frames, before.has_found_rate};
}

}  // namespace

HypothesesGraph decoded_hypotheses(const OnnxTensor& cnn_output, const OnnxTensor& r_lrf_view) {
  const OnnxTensor columns =
      transposed(reshaped(slice(cnn_output, 1, 0, shape::kColumns), {shape::kHypotheses, 2, 3}));
  const OnnxTensor r_view_trf = rotation_from_columns(slice(columns, 2, 0, 1), slice(columns, 2, 1, 2));
  const OnnxTensor r_lrf_trf = product(r_lrf_view, r_view_trf);
  const OnnxTensor logits = slice(cnn_output, 1, shape::kColumns, shape::kColumns + shape::kHypotheses);
  return {r_lrf_trf, logits, softmax(logits, 1), picked(r_lrf_trf, index_of_largest(logits, 1), 0)};
}

PredictionGraph predicted(const TrackGraph& before, const gnc::MotionModels<float>& motion_models,
                          const HypothesesGraph& hypotheses, const IntervalGraph& interval) {
  const OnnxTensor has_track = is_true(before.frames);
  const OnnxTensor rate_is_unknown = has_track & !is_true(before.has_found_rate);
  const OnnxTensor is_late = interval.elapsed_s > kLongestToFindRate_s;
  const OnnxTensor finds_no_rate = rate_is_unknown & is_late;
  const TrackGraph track = without_rate(before, rate_is_unknown & !is_late);

  const OnnxTensor elapsed_s =
      where(has_track, clamped(interval.elapsed_s, kShortest_s, kLongest_s), kPeriod_s);
  const OnnxTensor periods = elapsed_s / kPeriod_s;
  const MotionGraph propagated_motion =
      turned(propagated(track.motion, motion_models, periods), interval.r_now_last);
  const MotionGraph motion =
      where(has_track, propagated_motion, of_all_motion_models(at_rest(hypotheses.likeliest)));
  const OnnxTensor motion_model = motion_model_of(track.log_likelihood);

  // gnc::keep_confirmed()
  const OnnxTensor confirmed =
      probability_of(hypotheses, picked(motion, motion_model).r_lrf_trf) > gnc::kMinProbabilityNearPrediction;
  const OnnxTensor starts_anew = finds_no_rate & !confirmed;
  const MotionGraph last = at_rest(picked(turned(track.motion, interval.r_now_last), motion_model).r_lrf_trf);
  GraphBuilder& graph = periods.graph();
  const OnnxTensor first_rate = corrected_rate(
      last, hypotheses.likeliest, {scalar(graph, 1.0), periods, scalar(graph, gnc::kVersineOf150Degrees)});
  const MotionGraph first = of_all_motion_models({hypotheses.likeliest, first_rate});

  const MotionGraph kept = where(starts_anew, first, motion);
  const OnnxTensor log_likelihood = where(starts_anew, 0.0, track.log_likelihood);
  return {
      {kept, log_likelihood, where(starts_anew, 0.0, track.frames), as_number(has_track & !finds_no_rate)},
      picked(kept, motion_model_of(log_likelihood)).r_lrf_trf,
      periods,
      starts_anew};
}

OnnxTensor lstm_input(const OnnxTensor& features, const HypothesesGraph& hypotheses,
                      const PredictionGraph& prediction) {
  const OnnxTensor relative = product(transposed(prediction.r_lrf_trf), hypotheses.r_lrf_trf);
  return joined(
      {features, two_columns(relative), hypotheses.probabilities, two_columns(prediction.r_lrf_trf)}, 1);
}

TrackedGraph advanced(const HypothesesGraph& hypotheses, const PredictionGraph& prediction,
                      const OnnxTensor& head_output) {
  constexpr int kCandidates = shape::kCandidates;
  const TrackGraph& before = prediction.track;
  const auto head_value = [&](int i) { return reshaped(slice(head_output, 1, i, i + 1), {1, 1, 1}); };
  const gnc::FilterGains<OnnxTensor> filter = filter_gains(before.frames);

  const OnnxTensor no_logit = constant_tensor<float>(head_output.graph(), {1, 1}, {0});  // of the prediction
  const OnnxTensor anchor =
      index_of_largest(joined({hypotheses.logits, no_logit}, 1) + slice(head_output, 1, 0, kCandidates), 1);
  const OnnxTensor weights = candidate_weights(
      hypotheses, slice(head_output, 1, kCandidates, 2 * kCandidates), filter.predicted_weight);
  const OnnxTensor learned_gain = operation("Sigmoid", {filter.rate_logit + head_value(2 * kCandidates)});
  const RateCorrectionGraph correction{
      where(is_true(before.frames), learned_gain, 0.0), prediction.periods,
      largest_versine(prediction.periods, before.frames < gnc::kGains - 0.5)};

  const MotionGraph& motion = before.motion;
  const OnnxTensor r_lrf_trf = mean_attitudes(hypotheses, motion.r_lrf_trf, weights, anchor);
  const OnnxTensor innovations = squared_innovations(hypotheses, motion.r_lrf_trf, r_lrf_trf);
  const OnnxTensor rate_lrf = corrected_rate(motion, r_lrf_trf, correction);
  const OnnxTensor error_rad = gnc::kPi * operation("Sigmoid", {head_value(2 * kCandidates + 1)});
  const OnnxTensor variance = maximum(error_rad * error_rad, gnc::kMinVariance_rad2);
  const TrackGraph after =
      weighed({r_lrf_trf, rate_lrf}, before.log_likelihood, innovations, filter.evidence / variance, before);
  return {after, picked(after.motion, motion_model_of(after.log_likelihood)), reshaped(error_rad, {1, 1})};
}

}  // namespace tumblesight::sim
