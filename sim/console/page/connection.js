// Keeps the run's rows up to date: reads what is there, listens for new steps, and starts over when another run
// begins or the connection is lost. What was read is kept until the server answers again.
import { getRun, getSteps, openSocket, Refusal } from '/api.js';

const FIRST_WAIT_MS = 500;
const LONGEST_WAIT_MS = 4000;

export class Connection {
  /** `listener`: run(run, isNew), rows(answer), state(isConnected, text). */
  constructor(store, listener) {
    this.store = store;
    this.listener = listener;
    this.run = null;
    this.waitMs = FIRST_WAIT_MS;
    this.newest = 0;
    this.isReading = false;
    this.resets = 0;  // of the store
    this.socket = null;
  }

  async start() {
    try {
      this.takeRun(await getRun());
      await this.readRows();
      this.listen();
    } catch (error) {
      this.lost(error);
    }
  }

  takeRun(run) {
    const isOther = this.run === null || run.title !== this.run.title || run.run !== this.run.run || run.steps < this.store.steps ||
                    run.fields.join() !== this.run.fields.join();
    this.run = run;
    this.newest = run.steps;
    if (isOther) this.emptyStore();
    this.listener.run(run, isOther);
  }

  emptyStore() {
    ++this.resets;
    this.store.reset(this.run.fields);
  }

  // One request at a time: messages that come meanwhile only raise the number that is read up to.
  async readRows() {
    if (this.isReading) return;
    this.isReading = true;
    try {
      while (this.store.steps < this.newest) {
        const { resets } = this;
        const answer = await getSteps(this.store.steps);
        if (resets !== this.resets) continue;  // of the run before
        if (answer.to <= this.store.steps) break;
        this.store.append(answer);
        this.listener.rows(answer);
      }
    } finally {
      this.isReading = false;
    }
  }

  listen() {
    this.socket = openSocket(
      () => {
        this.waitMs = FIRST_WAIT_MS;
        this.listener.state(true, 'Connected');
      },
      (message) => this.takeMessage(message),
      () => this.lost(null));
  }

  takeMessage(message) {
    if (message.run !== this.run.run || message.steps < this.store.steps) {
      this.startOver();
      return;
    }
    if (Boolean(message.ended) !== Boolean(this.run.ended)) this.readEnd(message.ended);
    this.newest = message.steps;
    this.readRows().catch(() => this.socket.close());
  }

  // Another run has begun, so its description is read as well. The connection is not lost.
  startOver() {
    this.socket.onmessage = null;
    this.socket.onclose = null;
    this.socket.close();
    this.start();
  }

  // The end of a run also tells whether it is whole.
  readEnd(ended) {
    this.run.ended = ended;
    getRun().then((run) => {
      if (run.run !== this.run.run) return;  // of another run, which a message tells
      this.run = run;
      this.listener.run(run, false);
    }, () => {});
    this.listener.run(this.run, false);
  }

  lost(error) {
    const seconds = Math.ceil(this.waitMs / 1000);
    const why = error instanceof Refusal ? `: ${error.message}` : '';
    this.listener.state(false, `Not connected${why}. Trying again in ${seconds} s`);
    setTimeout(() => this.start(), this.waitMs);
    this.waitMs = Math.min(2 * this.waitMs, LONGEST_WAIT_MS);
  }
}
