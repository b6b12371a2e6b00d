// Attitudes from the frames of a recording (docs/onnx.md): node step.mjs PREFIX frames.tslr
import { readFileSync } from 'node:fs';
import ort from 'onnxruntime-node';

// Time [s], field of view [rad], ranges [m], q_inertial_lrf of the chaser: docs/icd.md, 5. Recordings.
function* framesOf(data) {
  const rays = data.readUInt16LE(6);
  for (let at = 12, left = data.readUInt32LE(8); left > 0; --left) {
    const timeS = Number(data.readBigInt64LE(at)) / 1e9, fovRad = data.readUInt32LE(at + 12) / 1e6;
    const q = [0, 4, 8, 12].map((i) => data.readInt32LE(at + 25 + i) / 2 ** 30);
    const rangesM = new Float64Array(rays * rays);
    at += 41;
    for (let row = 0; row < rays; ++row, at += 2 + 2 * data[at + 1])
      for (let i = 0; i < data[at + 1]; ++i)
        rangesM[row * rays + data[at] + i] = data.readUInt16LE(at + 2 + 2 * i) / 128;
    yield { timeS, fovRad, rays, rangesM, q };
  }
}

// Points in the LiDAR's frame: +x right, +y boresight, +z up. A range of 0 is no return.
function pointsOf({ rays, rangesM, fovRad }) {
  const slope = (i) => Math.tan(fovRad / 2) * ((2 * i + 1) / rays - 1);
  return [...rangesM].flatMap((rangeM, i) => {
    const ray = [slope(i % rays), 1, -slope(Math.floor(i / rays))];
    return ray.map((part) => part * rangeM / Math.hypot(...ray));
  });
}

// q_now_last, the Hamilton product of conjugate(q_inertial_lrf now) and q_inertial_lrf last.
const turn = ([a, b, c, d], [w, x, y, z]) => [a * w + b * x + c * y + d * z, a * x - b * w - c * z + d * y,
  a * y + b * z - c * w - d * x, a * z - b * y + c * x - d * w];

const tensor = (values, shape) => new ort.Tensor('float32', Float32Array.from(values), shape);
const [imageModel, stepModel] = await Promise.all(
  ['image', 'step'].map((name) => ort.InferenceSession.create(`${process.argv[2]}.${name}.onnx`)));
let state = tensor(new Array(451).fill(0), [1, 451]), last;
for (const frame of framesOf(readFileSync(process.argv[3]))) {
  last ??= frame;
  const points = tensor(pointsOf(frame), [frame.rays ** 2, 3]);
  const { image, r_lrf_view } = await imageModel.run({ points_lrf_m: points });
  const out = await stepModel.run({ image, r_lrf_view, elapsed_s: tensor([frame.timeS - last.timeS], [1, 1]),
    q_now_last: tensor(turn(frame.q, last.q), [1, 4]), state });
  [state, last] = [out.next_state, frame];
  const attitude = [...out.q_lrf_trf.data].map((part) => part.toFixed(4)).join(' ');
  console.log(`${frame.timeS.toFixed(2)} s  q_lrf_trf ${attitude}`,
    ` error ${out.expected_error_rad.data[0].toFixed(4)} rad`);
}
