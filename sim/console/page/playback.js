// Which step is selected, and what moves it: the user, the clock while playing, or new steps while following.

export const speeds = [0.5, 1, 2, 5, 10, Infinity];

export class Playback {
  /** `isReady()`: the selected step is on display, so that the next may come. */
  constructor(onChange, isReady) {
    this.onChange = onChange;
    this.isReady = isReady;
    this.steps = 0;
    this.selected = -1;
    this.isFollowing = false;
    this.isPlaying = false;
    this.speed = 1;
    this.periodS = 1;
    this.isLive = false;  // a run on the bus that has not ended
    this.credit = 0;      // part of a step that the clock has earned
    this.lastMs = 0;
    this.tick = this.tick.bind(this);
  }

  begin(run) {
    this.steps = 0;
    this.selected = -1;
    this.isPlaying = false;
    this.isFollowing = run.source === 'bus';
    this.describe(run);
  }
  describe(run) {
    this.periodS = run.period_s > 0 ? run.period_s : 1;
    this.isLive = run.source === 'bus' && !run.ended;
    this.isBus = run.source === 'bus';
  }

  get stepsBehind() {
    return Math.max(0, this.steps - 1 - this.selected);
  }

  grow(steps) {
    this.steps = steps;
    if (this.isFollowing) this.move(steps - 1);
    else if (this.selected < 0) this.move(0);
    else this.onChange();
  }

  /** The user's choice: it ends following and playing. */
  select(k) {
    this.isFollowing = false;
    this.isPlaying = false;
    this.move(k);
  }

  move(k) {
    if (this.steps === 0) return;
    this.selected = Math.max(0, Math.min(this.steps - 1, k));
    this.onChange();
  }

  follow() {
    if (!this.isBus) return;
    this.isPlaying = false;
    this.isFollowing = true;
    this.move(this.steps - 1);
  }

  toggle() {
    if (this.isPlaying || this.isFollowing) this.pause();
    else if (this.isBus && this.stepsBehind === 0) this.follow();
    else this.play();
  }

  pause() {
    this.isPlaying = false;
    this.isFollowing = false;
    this.onChange();
  }

  play() {
    if (this.steps === 0) return;
    if (this.stepsBehind === 0) this.selected = 0;
    this.isPlaying = true;
    this.credit = 0;
    this.lastMs = performance.now();
    this.move(this.selected);
    requestAnimationFrame(this.tick);
  }

  setSpeed(speed) {
    this.speed = speed;
    this.onChange();
  }
  changeSpeed(by) {
    const index = Math.max(0, Math.min(speeds.length - 1, speeds.indexOf(this.speed) + by));
    this.setSpeed(speeds[index]);
  }

  tick(nowMs) {
    if (!this.isPlaying) return;
    this.earn(nowMs);
    if (this.credit >= 1 && this.isReady()) this.advance();
    if (this.isPlaying) requestAnimationFrame(this.tick);
  }

  earn(nowMs) {
    const elapsedS = Math.max(0, nowMs - this.lastMs) / 1000;
    this.lastMs = nowMs;
    this.credit = this.speed === Infinity ? 1 : this.credit + (elapsedS * this.speed) / this.periodS;
    // Time that passes while a step is still loading is not made up for by a jump.
    if (!this.isReady()) this.credit = Math.min(this.credit, 1);
  }

  advance() {
    const whole = Math.floor(this.credit);
    this.credit -= whole;
    if (this.selected + whole < this.steps - 1) {
      this.move(this.selected + whole);
    } else if (this.isLive) {
      this.follow();
    } else {
      this.isPlaying = false;
      this.move(this.steps - 1);
    }
  }
}
