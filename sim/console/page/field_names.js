// Plain names and units of the fields of a row. A field that is not listed shows under its own name.
const fields = {
  t_s: ['Time', 's', 1], sequence: ['Sequence', '', 0], frame: ['Frame in its sequence', '', 0],
  valid: ['Attitude valid', '', 0], verified: ['Pose verified', '', 0],
  network_error_deg: ['Network error', '°', 2], network_expected_deg: ['Network, expected', '°', 2],
  pose_error_deg: ['Pose error', '°', 3], pose_expected_deg: ['Pose, expected', '°', 3],
  second_odds: ['Odds of the second', '', 3], true_range_m: ['True range', 'm', 3], pose_range_m: ['Pose range', 'm', 3],
  true_rate_deg_s: ['True rate', '°/s', 3], network_rate_deg_s: ['Network rate', '°/s', 3],
  pose_rate_deg_s: ['Pose rate', '°/s', 3], pose_right_m: ['Right', 'm', 4], pose_up_m: ['Up', 'm', 4],
  cycle_ms: ['Cycle before', 'ms', 2], inference_ms: ['Inference', 'ms', 2], frames_used: ['Frames used', '', 0],
  frames_refused: ['Frames refused', '', 0], frames_missing: ['Frames missing', '', 0],
  frames_repeated: ['Frames repeated', '', 0], commands_accepted: ['Commands accepted', '', 0],
  commands_refused: ['Commands refused', '', 0], events: ['Events', '', 0], mode: ['Mode', '', 0],
  faults: ['Faults, as bits', '', 0], bank: ['Bank in use', '', 0],
};

export function fieldName(field) {
  return field in fields ? fields[field][0] : field.replace(/_/g, ' ');
}
export function fieldUnit(field) {
  return field in fields ? fields[field][1] : '';
}
export function fieldDigits(field) {
  return field in fields ? fields[field][2] : 3;
}
