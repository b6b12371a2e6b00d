// Keeps the run's rows up to date: reads what is there, listens for new steps, and starts over when the
// connection is lost. What was read is kept until the server answers again.
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
    if (isOther) this.store.reset(run.fields);
    this.listener.run(run, isOther);
  }

  // One request at a time: messages that come meanwhile only raise the number that is read up to.
  async readRows() {
    if (this.isReading) return;
    this.isReading = true;
    try {
      while (this.store.steps < this.newest) {
        const answer = await getSteps(this.store.steps);
        if (answer.to <= this.store.steps) break;
        this.store.append(answer);
        this.listener.rows(answer);
      }
    } finally {
      this.isReading = false;
    }
  }

  listen() {
    const socket = openSocket(
      () => {
        this.waitMs = FIRST_WAIT_MS;
        this.listener.state(true, 'Connected');
      },
      (message) => this.takeMessage(message, socket),
      () => this.lost(null));
  }

  takeMessage(message, socket) {
    // Fewer steps than before: another run has begun, so its description is read as well.
    if (message.steps < this.store.steps) {
      socket.close();
      return;
    }
    if (Boolean(message.ended) !== Boolean(this.run.ended)) this.readEnd(message.ended);
    this.newest = message.steps;
    this.readRows().catch(() => socket.close());
  }

  // The end of a run also tells whether it is whole.
  readEnd(ended) {
    this.run.ended = ended;
    getRun().then((run) => {
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
