// Frame, depth image and detail of the selected step. At most one step is under way and one waits: the newest
// wins, and an answer that is no longer wanted only goes into the cache. Only where the steps go by faster than
// they load is a late answer shown, so that the picture does not stand still.
import { getDepth, getFrame, getStep, orNull } from '/api.js';

const KEPT_STEPS = 64;
const LONGEST_STANDSTILL_MS = 200;

export class StepLoader {
  constructor(onStep, onFailure) {
    this.onStep = onStep;
    this.onFailure = onFailure;
    this.reset();
  }

  reset() {
    this.kept = new Map();  // in the order of their last use
    this.wanted = -1;
    this.shown = -1;
    this.shownMs = -Infinity;
    this.isBusy = false;
    this.generation = (this.generation || 0) + 1;
  }

  get isSettled() {
    return this.shown === this.wanted;
  }

  want(k) {
    this.wanted = k;
    const step = this.kept.get(k);
    if (step) {
      this.kept.delete(k);
      this.kept.set(k, step);
      this.show(step);
    } else if (!this.isBusy) {
      this.load(k);
    }
  }

  show(step) {
    this.shown = step.k;
    this.shownMs = performance.now();
    this.onStep(step);
  }

  async load(k) {
    const generation = this.generation;
    this.isBusy = true;
    let step = null;
    try {
      step = await readStep(k);
    } catch (error) {
      if (generation === this.generation) this.onFailure(error);
    }
    if (generation !== this.generation) return;
    this.isBusy = false;
    if (step) this.arrived(step);
    // After a failure the connection asks again; without this a lost server would be asked in a tight loop.
    if (step && this.wanted !== k) this.want(this.wanted);
  }

  arrived(step) {
    // What is missing may still come in a live run, so it is asked for again.
    if (step.detail && step.frame) this.keep(step);
    const stoodStill = performance.now() - this.shownMs > LONGEST_STANDSTILL_MS;
    if (step.k === this.wanted || stoodStill) this.show(step);
  }

  keep(step) {
    this.kept.set(step.k, step);
    if (this.kept.size > KEPT_STEPS) this.kept.delete(this.kept.keys().next().value);
  }
}

async function readStep(k) {
  const notes = {};
  const [detail, frame, depth] = await Promise.all(
    [orNull(getStep(k), notes, 'detail'), orNull(getFrame(k), notes, 'frame'), orNull(getDepth(k), notes, 'depth')]);
  return { k, detail, frame, depth, notes };
}
